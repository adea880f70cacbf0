#pragma once
/// \file
/// A listening TCP port: accepts, reads in a fair round, cuts messages with the framing below it, delivers to its
/// consumer.

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "api/net.h"
#include "net-tcp/complaints.h"
#include "net-tcp/tcp_connection.h"
#include "spark/describe.h"
#include "spark/kernel.h"

namespace spark {

/// Below the network server. Lives and delivers in the simulation's thread.
class TcpPort : public Node {
  SPARK_CLASS(TcpPort, Node)
 public:
  static void describe(Description<TcpPort>& d);

  /// Opens the port. Throws Error: no framing or consumer, bad address, in use. Does nothing when it is open.
  void listen();
  bool listening() const { return acceptor_.has_value(); }
  /// One fair round in accept order: old connections are read, new ones are taken and read. True when something was
  /// delivered.
  bool poll();

  /// For connections: frames with the framing below, counts, writes rate-limited lines that name this port.
  void frame(std::string_view message, std::string& out) { framing_->frame(message, out); }
  void countDropped() { ++messagesDropped_; }
  void complain(Level level, std::string_view what);

  /// The real port once it listens.
  int port() const { return port_; }
  /// Throws Error when it listens already.
  void setPort(int port);

 protected:
  void onLink() override;
  void onUnlink() override;

 private:
  using Connection = std::shared_ptr<net::TcpConnection>;
  void followConsumer();
  void watchAccept();
  bool acceptAll();
  void take(net::tcp::socket socket);
  bool serve(net::TcpConnection& connection);
  bool cut(net::TcpConnection& connection);
  bool reap();
  bool full();
  net::TcpConnection* givesWay() const;
  void closeSilent();
  std::int64_t messagesDropped() const { return messagesDropped_; }
  std::int64_t connectionsSeen() const { return connectionsSeen_; }
  int connectionCount() const { return static_cast<int>(connections_.size()); }
  std::string consumer() const { return consumerPath_; }
  void setConsumer(std::string path);

  std::shared_ptr<boost::asio::io_context> io_;
  std::optional<net::tcp::acceptor> acceptor_;
  net::HandlerMemory acceptMemory_;
  std::shared_ptr<bool> acceptReady_ = std::make_shared<bool>(false);
  net::Clock::time_point acceptAgain_{}, timeoutsChecked_{};
  std::vector<Connection> connections_;  ///< in accept order
  std::vector<Connection> leaving_;
  std::string scratch_;
  net::Complaints complaints_;

  int port_ = 0;
  std::string address_ = "0.0.0.0", consumerPath_ = "/sys/server/gamecontrol";
  bool makeRoom_ = false;
  int maxMessage_ = 65536, maxConnections_ = 64, sendBuffer_ = 262144;
  double messageTimeout_ = 30, makeRoomAfter_ = 0;
  std::int64_t messagesDropped_ = 0, connectionsSeen_ = 0;

  Link<IFraming> framing_;
  Link<IConnectionConsumer> named_;    ///< by the property
  Ref<IConnectionConsumer> consumer_;  ///< whom all connections belong to
};

}  // namespace spark
