#pragma once
/// \file
/// A connection to a server of the RoboCup 3D simulation league (agent or monitor port): messages over TCP, each after
/// a 4-byte big-endian length. Needs only POSIX sockets and the standard library.

#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace spark::client {

/// The server closed the connection behind a whole message, as it does when it ends.
class Closed : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A connection. Owns its socket; movable, not copyable. Not thread safe. Functions throw std::runtime_error with one
/// sentence when the connection fails, Closed when the server has closed it.
class Connection {
 public:
  /// Longest accepted message [bytes]: a longer one means that the server speaks another protocol.
  static constexpr std::size_t kMostBytes = std::size_t{1} << 24;

  Connection() = default;
  /// Connects. `patience`: retries for this long while the server cannot be reached [s].
  Connection(const std::string& host, int port, double patience = 0) { connect(host, port, patience); }
  ~Connection() { close(); }
  Connection(Connection&& other) noexcept;
  Connection& operator=(Connection&& other) noexcept;

  /// Like the constructor; closes an open connection first.
  void connect(const std::string& host, int port, double patience = 0);
  bool isOpen() const { return socket_ >= 0; }
  void close();

  /// Sends a message. Blocks until the system has accepted it.
  void send(std::string_view message);
  /// Returns the next message. Waits at most `timeout` [s], without limit when it is negative; nullopt when none
  /// arrived in time. An incomplete message is kept for the next call.
  std::optional<std::string> receive(double timeout = -1);
  /// True when receive(0) would return a message.
  bool pending();

  /// The socket, for select() or poll(); -1 when closed. Call pending() first: a message may already have been read.
  int descriptor() const { return socket_; }

 private:
  void sendBytes(std::string_view bytes);
  bool fill(double timeout);
  std::size_t announced() const;
  bool whole() const;

  int socket_ = -1;
  std::string in_;  ///< received and not returned yet
};

}  // namespace spark::client
