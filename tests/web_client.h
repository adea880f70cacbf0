#pragma once
/// \file
/// A raw HTTP and WebSocket client of a web server. It sends any bytes, also invalid ones.

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

namespace spark::test {

/// One connection. Reads have no timeout: ctest ends a test that hangs. Functions throw boost::system::system_error
/// when the server has closed the connection, unless they say otherwise.
class WebClient {
 public:
  /// `receiveBuffer`: size of the socket's receive buffer in bytes; 0: the system's default.
  explicit WebClient(unsigned short port, int receiveBuffer = 0) : port_(port) {
    const boost::asio::ip::tcp::endpoint server(boost::asio::ip::address_v4::loopback(), port);
    socket_.open(server.protocol());
    if (receiveBuffer > 0) socket_.set_option(boost::asio::socket_base::receive_buffer_size(receiveBuffer));
    socket_.connect(server);
  }

  /// Sends bytes unchanged. It is no error if the server has closed the connection.
  void sendRaw(std::string_view bytes) {
    boost::system::error_code ignored;
    boost::asio::write(socket_, boost::asio::buffer(bytes.data(), bytes.size()), ignored);
  }
  /// A complete response.
  struct Answer {
    int status = 0;
    std::string head, body;
  };
  /// Sends a request and reads the response. `headers`: complete lines that replace Host.
  Answer get(const std::string& target, const std::string& headers = "", const std::string& method = "GET") {
    sendRaw(method + " " + target + " HTTP/1.1\r\n" + (headers.empty() ? host() : headers) + "\r\n");
    return answer(method != "HEAD");
  }
  /// Reads the next response.
  Answer answer(bool body = true) {
    Answer out;
    while (buffer_.find("\r\n\r\n") == buffer_.npos) fill();
    const std::size_t end = buffer_.find("\r\n\r\n") + 4;
    out.head = buffer_.substr(0, end);
    buffer_.erase(0, end);
    out.status = std::stoi(out.head.substr(9, 3));
    const std::size_t at = out.head.find("Content-Length: ");
    if (at != out.head.npos && body) out.body = take(std::stoul(out.head.substr(at + 16)));
    return out;
  }
  /// Waits until the simulation has answered, and returns the content of /status.json, which is empty until then.
  static std::string status(unsigned short port) {
    for (;;)
      if (std::string body = WebClient(port).get("/status.json").body; body != "{}") return body;
  }
  /// Header lines that request a WebSocket.
  static std::string upgrade(const std::string& host) {
    return host +
           "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Key: "
           "dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n";
  }
  std::string host() const { return "Host: 127.0.0.1:" + std::to_string(port_) + "\r\n"; }
  /// Connects as a viewer. Returns the status of the response: 101 on success.
  int watch() { return get("/stream", upgrade(host())).status; }

  /// A WebSocket frame as a client must send it.
  static std::string frame(std::string_view payload, int opcode = 1, bool masked = true, bool last = true) {
    std::string out(1, static_cast<char>((last ? 0x80 : 0) | opcode));
    const int mask = masked ? 0x80 : 0;
    const auto size = [&](int bytes) {
      for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8) out += static_cast<char>(payload.size() >> shift);
    };
    if (payload.size() < 126)
      out += static_cast<char>(mask | payload.size());
    else if (payload.size() < 65536)
      out += static_cast<char>(mask | 126), size(2);
    else
      out += static_cast<char>(mask | 127), size(8);
    if (!masked) return out += payload;
    const char key[4] = {0x11, 0x22, 0x33, 0x44};
    out.append(key, 4);
    for (std::size_t i = 0; i < payload.size(); ++i) out += static_cast<char>(payload[i] ^ key[i % 4]);
    return out;
  }
  void say(std::string_view text) { sendRaw(frame(text)); }

  /// The next message of a WebSocket.
  struct Message {
    int opcode = 0;  ///< 1 text, 2 binary, 8 close
    std::string payload;
  };
  Message next() {
    const std::string head = take(2);
    std::size_t size = head[1] & 0x7f;
    const auto longSize = [&](std::size_t bytes) {
      size = 0;
      for (const char c : take(bytes)) size = size << 8 | static_cast<unsigned char>(c);
    };
    if (size == 126)
      longSize(2);
    else if (size == 127)
      longSize(8);
    Message message{head[0] & 0x0f, take(size)};
    if (message.opcode == 9)
      sendRaw(frame(message.payload, 10));  // the server disconnects clients that do not answer pings
    return message;
  }
  /// The next text message that contains `part`. Other messages are skipped.
  std::string textWith(std::string_view part) {
    for (;;) {
      Message message = next();
      if (message.opcode == 8)
        throw std::runtime_error("closed by the server: " +
                                 message.payload.substr(std::min<std::size_t>(2, message.payload.size())));
      if (message.opcode == 1 && message.payload.find(part) != std::string::npos) return message.payload;
    }
  }
  /// The next frame of the stream.
  std::string binary() {
    for (;;) {
      Message message = next();
      if (message.opcode == 2) return message.payload;
    }
  }
  /// True if there are unread bytes.
  bool pending() { return !buffer_.empty() || socket_.available() > 0; }
  /// Reads until the server closes the connection, and returns all bytes.
  std::string waitForClose() {
    boost::system::error_code ec;
    std::string all = std::move(buffer_);
    std::string bytes(65536, ' ');
    while (!ec) all.append(bytes.data(), socket_.read_some(boost::asio::buffer(bytes), ec));
    buffer_.clear();
    return all;
  }

 private:
  void fill() {
    char bytes[65536];
    buffer_.append(bytes, socket_.read_some(boost::asio::buffer(bytes)));
  }
  std::string take(std::size_t n) {
    while (buffer_.size() < n) fill();
    std::string out = buffer_.substr(0, n);
    buffer_.erase(0, n);
    return out;
  }

  unsigned short port_;
  boost::asio::io_context io_;
  boost::asio::ip::tcp::socket socket_{io_};
  std::string buffer_;
};

}  // namespace spark::test
