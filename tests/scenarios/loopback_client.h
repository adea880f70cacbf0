#pragma once
/// \file
/// A TCP client of a server in the same process and thread. It checks that sent bytes have arrived, so tests need no
/// timing.

#include <arpa/inet.h>
#include <linux/sockios.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "spark/error.h"

namespace spark::test {

/// One connection. After connecting, poll the server until accepted() returns true.
class LoopbackClient {
 public:
  explicit LoopbackClient(int port) : fd_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in to = address(static_cast<std::uint16_t>(port));
    if (::connect(fd_, reinterpret_cast<sockaddr*>(&to), sizeof to) != 0)
      throw Error(std::string("connect: ") + std::strerror(errno));
    const int on = 1;
    ::setsockopt(fd_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  }
  LoopbackClient(LoopbackClient&& other) noexcept
      : fd_(std::exchange(other.fd_, -1)), peer_(other.peer_), in_(std::move(other.in_)), ended_(other.ended_) {}
  ~LoopbackClient() {
    if (fd_ >= 0) ::close(fd_);
  }

  /// Finds the server's end among this process's sockets; false while the server has not accepted.
  bool accepted() {
    // Clients of two servers may have the same port, so both ends are compared.
    for (int fd = 3; fd < 1024 && peer_ < 0; ++fd)
      if (fd != fd_ && portOf(fd, ::getpeername) == portOf(fd_, ::getsockname) &&
          portOf(fd, ::getsockname) == portOf(fd_, ::getpeername))
        peer_ = fd;
    return peer_ >= 0;
  }
  /// Sends a message with its length prefix, and returns when the server's next read will find it.
  void send(std::string_view message) {
    const auto n = htonl(static_cast<std::uint32_t>(message.size()));
    const std::string bytes = std::string(reinterpret_cast<const char*>(&n), 4) + std::string(message);
    const int before = count(peer_, FIONREAD);
    if (::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(bytes.size()))
      throw Error("send: the server has closed");
    while (count(peer_, FIONREAD) < before + static_cast<int>(bytes.size())) {
    }
  }
  /// All messages that the server has sent since the last call. The server must have nothing left to write.
  std::vector<std::string> take() {
    do readAll();
    while (!ended_ && count(peer_, SIOCOUTQ) > 0);  // in transit: read again
    std::vector<std::string> out;
    for (std::uint32_t n = 0; in_.size() >= 4; out.push_back(in_.substr(4, n)), in_.erase(0, 4 + n)) {
      std::memcpy(&n, in_.data(), 4);
      n = ntohl(n);
      if (in_.size() < 4 + n) break;
    }
    return out;
  }
  /// True if the server has closed the connection (detected by take()).
  bool ended() const { return ended_; }

 private:
  static sockaddr_in address(std::uint16_t port) {
    sockaddr_in a{};
    a.sin_family = AF_INET;
    a.sin_port = htons(port);
    a.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return a;
  }
  /// The port of one end in network order, from getsockname or getpeername; -1 if it has none.
  template <class Name>
  static int portOf(int fd, Name name) {
    sockaddr_in a{};
    socklen_t n = sizeof a;
    return name(fd, reinterpret_cast<sockaddr*>(&a), &n) == 0 && a.sin_family == AF_INET ? a.sin_port : -1;
  }
  /// FIONREAD: bytes that this end may read; SIOCOUTQ: bytes that it has sent and the other end has not acknowledged.
  static int count(int fd, unsigned long what) {
    int n = 0;
    return ::ioctl(fd, what, &n) == 0 ? n : 0;
  }
  void readAll() {
    char buffer[65536];
    ssize_t n;
    while ((n = ::recv(fd_, buffer, sizeof buffer, MSG_DONTWAIT)) > 0) in_.append(buffer, static_cast<std::size_t>(n));
    ended_ |= n == 0 || (errno != EAGAIN && errno != EWOULDBLOCK);
    // Acknowledge the bytes at once instead of with the usual delay.
    const int on = 1;
    ::setsockopt(fd_, IPPROTO_TCP, TCP_QUICKACK, &on, sizeof on);
  }
  int fd_, peer_ = -1;
  std::string in_;
  bool ended_ = false;
};

}  // namespace spark::test
