#include "spark/client/connection.h"

#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <thread>
#include <utility>

namespace spark::client {

namespace {
using Clock = std::chrono::steady_clock;
constexpr std::size_t kPrefix = 4, kRoom = 65536;       // bytes
constexpr auto kPause = std::chrono::milliseconds(50);  // between two attempts to connect

[[noreturn]] void fail(const std::string& what) { throw std::runtime_error(what + ": " + std::strerror(errno)); }

/// A connected socket, or -1 with errno.
int connectTo(const addrinfo& address) {
  const int fd = ::socket(address.ai_family, address.ai_socktype | SOCK_CLOEXEC, address.ai_protocol);
  if (fd < 0) return -1;
  if (::connect(fd, address.ai_addr, address.ai_addrlen) == 0) {
    const int on = 1;
    ::setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    return fd;
  }
  const int why = errno;
  ::close(fd);
  errno = why;
  return -1;
}

std::unique_ptr<addrinfo, void (*)(addrinfo*)> resolve(const std::string& host, int port) {
  // The library would take a larger one modulo 65536.
  if (port < 1 || port > 65535)
    throw std::runtime_error("expected a port from 1 to 65535, found " + std::to_string(port));
  addrinfo wanted{}, *found = nullptr;
  wanted.ai_socktype = SOCK_STREAM;
  if (const int wrong = ::getaddrinfo(host.c_str(), std::to_string(port).c_str(), &wanted, &found); wrong != 0)
    throw std::runtime_error("there is no host '" + host + "': " + ::gai_strerror(wrong));
  return {found, ::freeaddrinfo};
}
}  // namespace

Connection::Connection(Connection&& other) noexcept
    : socket_(std::exchange(other.socket_, -1)), in_(std::move(other.in_)) {}

Connection& Connection::operator=(Connection&& other) noexcept {
  std::swap(socket_, other.socket_);
  std::swap(in_, other.in_);
  return *this;
}

void Connection::connect(const std::string& host, int port, double patience) {
  close();
  const auto addresses = resolve(host, port);
  const auto end = Clock::now() + std::chrono::duration<double>(patience);
  for (;;) {
    for (const addrinfo* a = addresses.get(); a && socket_ < 0; a = a->ai_next) socket_ = connectTo(*a);
    if (socket_ >= 0) return;
    if (Clock::now() >= end) fail("nobody can be reached at " + host + ":" + std::to_string(port));
    std::this_thread::sleep_for(kPause);
  }
}

void Connection::close() {
  if (socket_ >= 0) ::close(std::exchange(socket_, -1));
  in_.clear();
}

void Connection::send(std::string_view message) {
  const auto n = static_cast<std::uint32_t>(message.size());
  std::string bytes{static_cast<char>(n >> 24), static_cast<char>(n >> 16), static_cast<char>(n >> 8),
                    static_cast<char>(n)};
  bytes += message;
  sendBytes(bytes);
}

void Connection::sendBytes(std::string_view bytes) {
  while (!bytes.empty()) {
    const auto n = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (n > 0)
      bytes.remove_prefix(static_cast<std::size_t>(n));
    else if (errno != EINTR)
      fail("the server takes no message");
  }
}

std::size_t Connection::announced() const {
  std::size_t n = 0;
  for (std::size_t i = 0; i < kPrefix; ++i) n = n << 8 | static_cast<unsigned char>(in_[i]);
  if (n > kMostBytes)
    throw std::runtime_error("the server announced a message of " + std::to_string(n) +
                             " bytes: it speaks another protocol");
  return n;
}

bool Connection::whole() const { return in_.size() >= kPrefix && in_.size() - kPrefix >= announced(); }

/// Reads available bytes, waiting at most `timeout` [s]; negative: without limit. False when none arrived in time.
bool Connection::fill(double timeout) {
  pollfd wanted{socket_, POLLIN, 0};
  const int ready = ::poll(&wanted, 1, timeout < 0 ? -1 : static_cast<int>(std::min(std::ceil(timeout * 1000), 1e9)));
  if (ready < 0 && errno != EINTR) fail("the connection cannot be waited for");
  if (ready <= 0) return false;
  const std::size_t had = in_.size();
  in_.resize(had + kRoom);
  const auto n = ::recv(socket_, in_.data() + had, kRoom, 0);
  in_.resize(had + static_cast<std::size_t>(std::max<decltype(n)>(n, 0)));
  if (n == 0 && in_.empty()) throw Closed("the server closed the connection");
  if (n == 0) throw std::runtime_error("the server closed the connection in the middle of a message");
  if (n < 0 && errno != EINTR) fail("the connection broke");
  return n > 0;
}

std::optional<std::string> Connection::receive(double timeout) {
  const auto begin = Clock::now();
  while (!whole()) {
    const double left =
        timeout < 0 ? -1 : std::max(timeout - std::chrono::duration<double>(Clock::now() - begin).count(), 0.0);
    if (!fill(left) && left == 0) return std::nullopt;
  }
  const std::size_t n = announced();
  std::string message = in_.substr(kPrefix, n);
  in_.erase(0, kPrefix + n);
  return message;
}

bool Connection::pending() {
  while (!whole())
    if (!fill(0)) return false;
  return true;
}

}  // namespace spark::client
