#pragma once
/// \file
/// One agent's connection to a server, over TCP or a Unix socket.

#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/asio/io_context.hpp>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "language.h"
#include "spark/predicates.h"

namespace spark::agent {

/// How messages are separated in the stream; as the server's port does it.
enum class Framing {
  length,  ///< each after its length, a 4-byte big-endian integer
  line     ///< each ends with a line feed
};

/// One connection. Its handlers run in the thread that runs the io_context. Must outlive the io_context's run().
class AgentConnection {
 public:
  /// Called for each message; appends the predicates of the answer. An empty answer is not sent.
  using OnMessage = std::function<void(const Predicates& percepts, Predicates& actions)>;
  /// Called once when the connection has ended; `why` is one sentence.
  using OnEnd = std::function<void(const std::string& why)>;

  AgentConnection(boost::asio::io_context& io, Language& language, Framing framing = Framing::length)
      : socket_(io), language_(language), framing_(framing) {}
  /// Connects over TCP; retries for `patience` [s] while the server cannot be reached. Blocks. Throws spark::Error.
  void connect(const std::string& host, int port, double patience = 0);
  /// The same over the Unix socket `file`.
  void connectTo(const std::string& file, double patience = 0);
  /// False: messages are counted and answered, but not parsed; `percepts` stay empty.
  void setListens(bool on) { listens_ = on; }
  /// Sends `first` (when it is not empty) and answers messages from then on.
  void start(const Predicates& first, OnMessage onMessage, OnEnd onEnd);
  /// Closes the socket. OnEnd is not called.
  void close();
  /// Number of messages received so far.
  std::uint64_t received() const { return received_; }

 private:
  /// Calls `attempt`, which returns its error, until it succeeds.
  void connect(const std::string& where, double patience, const std::function<boost::system::error_code()>& attempt);
  void send(const Predicates& predicates);
  void receive();
  /// The next complete message in `all` from `at` on, which moves behind it. Ends the connection for a message that is
  /// too long.
  std::optional<std::string_view> next(std::string_view all, std::size_t& at);
  void answerAll();
  void answer(std::string_view message);
  void end(const std::string& why);

  boost::asio::generic::stream_protocol::socket socket_;
  Language& language_;
  const Framing framing_;
  OnMessage onMessage_;
  OnEnd onEnd_;
  Predicates percepts_, actions_;
  std::string in_, out_;
  std::size_t filled_ = 0;  ///< bytes of in_ that were received and not processed yet
  std::uint64_t received_ = 0;
  bool listens_ = true;
};

}  // namespace spark::agent
