#pragma once
/// \file
/// A raw TCP client of a running host. It sends and reads whatever a test needs, including invalid messages.

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <string>

namespace spark::test {

/// One connection. It waits without a timeout: ctest ends a test that stalls, and with it the host. Functions throw
/// boost::system::system_error when the host has closed the connection, unless stated otherwise.
class Client {
 public:
  explicit Client(unsigned short port) { socket_.connect({boost::asio::ip::address_v4::loopback(), port}); }

  /// Sends raw bytes. It is no error if the host has closed the connection in the meantime.
  void sendRaw(const std::string& bytes) {
    boost::system::error_code ignored;
    boost::asio::write(socket_, boost::asio::buffer(bytes), ignored);
  }
  /// Sends one message with its length prefix.
  void send(const std::string& message) { sendRaw(prefix(static_cast<std::uint32_t>(message.size())) + message); }
  /// The next message.
  std::string receive() {
    unsigned char p[4];
    boost::asio::read(socket_, boost::asio::buffer(p));
    std::string message(static_cast<std::size_t>(p[0]) << 24 | static_cast<std::size_t>(p[1]) << 16 |
                            static_cast<std::size_t>(p[2]) << 8 | p[3],
                        ' ');
    boost::asio::read(socket_, boost::asio::buffer(message));
    return message;
  }
  /// Number of bytes that have arrived and were not received yet.
  std::size_t waiting() { return socket_.available(); }
  /// True if there are any.
  bool pending() { return waiting() > 0; }
  /// Reads until the host closes the connection.
  void waitForClose() {
    std::string bytes(4096, ' ');
    boost::system::error_code ec;
    while (!ec) socket_.read_some(boost::asio::buffer(bytes), ec);
  }
  /// The length prefix: four bytes, big-endian.
  static std::string prefix(std::uint32_t n) {
    return {static_cast<char>(n >> 24), static_cast<char>(n >> 16), static_cast<char>(n >> 8), static_cast<char>(n)};
  }

 private:
  boost::asio::io_context io_;
  boost::asio::ip::tcp::socket socket_{io_};
};

}  // namespace spark::test
