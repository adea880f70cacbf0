#pragma once
/// \file
/// A connection to a server of the RoboCup 3D simulation league (agents' port or monitors' port): whole messages behind
/// a 4-byte big-endian length, over TCP. Needs POSIX sockets and the standard library, nothing else.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace spark::client {

/// One connection. Owns its socket; moves, does not copy. Not thread safe. Functions throw std::runtime_error with one
/// sentence when the connection cannot be used any more.
class Connection {
 public:
  /// Longest message that is taken from a server [bytes]: more means that it speaks another protocol.
  static constexpr std::size_t kMostBytes = std::size_t{1} << 24;

  Connection() = default;
  /// Connects. `patience`: tries again for so long [s] while nobody listens.
  Connection(const std::string& host, int port, double patience = 0) { connect(host, port, patience); }
  ~Connection() { close(); }
  Connection(Connection&& other) noexcept;
  Connection& operator=(Connection&& other) noexcept;

  /// As the constructor; closes what was open.
  void connect(const std::string& host, int port, double patience = 0);
  bool isOpen() const { return socket_ >= 0; }
  void close();

  /// Sends one message; waits until the system has taken it.
  void send(std::string_view message);
  /// Takes the next message. Waits for it at most `timeout` [s], for ever when it is negative; nothing when none came
  /// in time. What came of an unfinished message stays for the next call.
  std::optional<std::string> receive(double timeout = -1);
  /// True when receive(0) would give a message.
  bool pending();

  /// The socket, for select() or poll() with others; -1 when closed. pending() first: a message may have been read
  /// already.
  int descriptor() const { return socket_; }

 private:
  void sendBytes(std::string_view bytes);
  bool fill(double timeout);
  std::size_t announced() const;
  bool whole() const;

  int socket_ = -1;
  std::string in_;  ///< received and not taken yet
};

}  // namespace spark::client
