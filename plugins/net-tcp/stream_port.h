#pragma once
/// \file
/// A listening port of any transport: accepts clients, reads from them round robin, splits the bytes into messages with
/// the framing below it, delivers the messages to its consumer.

#include <boost/asio/basic_socket_acceptor.hpp>
#include <boost/asio/io_context.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "api/agents.h"
#include "api/inputs.h"
#include "api/net.h"
#include "net-tcp/rate_limited_log.h"
#include "net-tcp/stream_connection.h"
#include "spark/describe.h"
#include "spark/kernel.h"

namespace spark {

/// A node below the NetServer: the base of the ports of each transport. Simulation thread only.
class StreamPort : public Node {
  SPARK_CLASS(StreamPort, Node)
 public:
  static void describe(Description<StreamPort>& d);

  /// Opens the port; does nothing if it is open. Throws Error if it has no framing or consumer, or if its address is
  /// invalid or in use.
  void listen();
  bool listening() const { return acceptor_.has_value(); }
  /// Reads from all connections in the order in which they were accepted, then accepts new ones and reads from them. A
  /// connection delivers a bounded amount per call. True if something was delivered.
  bool poll();
  /// Acknowledges what was read from connections that have got no output since. Costs nothing for all others.
  void acknowledge();

  // For connections of this port.

  /// Appends the framed message; nothing once the framing was removed.
  void frame(std::string_view message, std::string& out) {
    if (framing_) framing_->frame(message, out);
  }
  /// Counts a message that was not sent.
  void countDropped() { ++messagesDropped_; }
  /// Writes a rate-limited log line that names this port.
  void logLimited(Level level, std::string_view what);

  /// Where it listens: "0.0.0.0:3100", "/run/user/1000/agents.sock".
  virtual std::string where() const = 0;

 protected:
  using Acceptor = boost::asio::basic_socket_acceptor<net::Stream>;
  using Accepted = net::StreamConnection::Accepted;
  /// Opens, binds and listens. Throws Error.
  virtual void open(Acceptor& acceptor) = 0;
  /// Sets the options of a client's socket and names the client.
  virtual Accepted accepted(net::Stream::socket socket) const = 0;
  /// Called when it no longer listens.
  virtual void closed() {}

  void onLink() override;
  void onUnlink() override;

 private:
  using Connection = std::shared_ptr<net::StreamConnection>;
  void updateConsumer();
  void watchAccept();
  bool acceptAll();
  void addConnection(net::Stream::socket socket);
  bool readFrom(net::StreamConnection& connection);
  bool deliverMessages(net::StreamConnection& connection);
  bool removeClosed();
  bool full();
  net::StreamConnection* connectionToEvict() const;
  void closeAll();
  void put(Input::Kind kind, const net::StreamConnection& connection, std::string_view text = {});
  std::int64_t messagesDropped() const { return messagesDropped_; }
  std::int64_t connectionsSeen() const { return connectionsSeen_; }
  int connectionCount() const { return static_cast<int>(connections_.size()); }
  std::string consumer() const { return consumerPath_; }
  void setConsumer(std::string path);

  std::shared_ptr<boost::asio::io_context> io_;
  std::optional<Acceptor> acceptor_;
  net::HandlerMemory acceptMemory_;
  std::shared_ptr<bool> acceptReady_ = std::make_shared<bool>(false);  ///< shared with the pending wait
  net::Clock::time_point acceptAgain_{}, timeoutsChecked_{};
  std::vector<Connection> connections_;  ///< in the order in which they were accepted
  std::vector<Connection> closed_;       ///< used by removeClosed()
  std::string scratch_;                  ///< buffer of one read
  net::RateLimitedLog log_;

  std::string consumerPath_ = IGameControl::kPath;
  bool makeRoom_ = false;
  int maxMessage_ = 65536, maxConnections_ = 64, sendBuffer_ = 262144;
  double messageTimeout_ = 30, makeRoomAfter_ = 0;
  std::int64_t messagesDropped_ = 0, connectionsSeen_ = 0;

  Link<IFraming> framing_;
  Link<IInputTape> tape_;
  Link<IConnectionConsumer> named_;    ///< at the path of the property
  Ref<IConnectionConsumer> consumer_;  ///< consumer of all current connections
};

}  // namespace spark
