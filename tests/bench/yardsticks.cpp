#include <arpa/inet.h>
#include <benchmark/benchmark.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>
#include <vector>

#include "micro.h"

// What every machine does, and what other times are compared with, so that targets hold on any of them.

namespace spark::bench {

namespace {
constexpr std::size_t kCopied = 64 << 10, kPercepts = 1300, kActions = 280;  // bytes

int checked(int result) {
  if (result < 0) throw std::system_error(errno, std::generic_category(), "a socket for the echo");
  return result;
}

/// A socket that is closed with it.
class Socket {
 public:
  explicit Socket(int handle) : handle_(checked(handle)) {}
  ~Socket() { close(handle_); }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  int handle() const { return handle_; }
  void sendAtOnce() const {
    const int on = 1;
    checked(setsockopt(handle_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on));
  }
  void send(const std::vector<char>& bytes) const {
    checked(static_cast<int>(::send(handle_, bytes.data(), bytes.size(), 0)));
  }
  void receive(std::vector<char>& bytes) const {
    checked(static_cast<int>(recv(handle_, bytes.data(), bytes.size(), MSG_WAITALL)));
  }

 private:
  int handle_;
};

/// Copies 64 kB.
void copy(benchmark::State& state) {
  std::vector<char> from(kCopied, 'x'), to(kCopied);
  for (auto _ : state) {
    std::memcpy(to.data(), from.data(), kCopied);
    benchmark::DoNotOptimize(to.data());
    benchmark::ClobberMemory();
  }
}

/// Sends as many bytes as a humanoid's percepts over TCP within this machine, and receives as many as its actions. One
/// thread does both sides.
void echo(benchmark::State& state) {
  const Socket listener(socket(AF_INET, SOCK_STREAM, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  auto* const at = reinterpret_cast<sockaddr*>(&address);
  socklen_t size = sizeof address;
  checked(bind(listener.handle(), at, size));
  checked(listen(listener.handle(), 1));
  checked(getsockname(listener.handle(), at, &size));
  const Socket client(socket(AF_INET, SOCK_STREAM, 0));
  checked(connect(client.handle(), at, size));
  const Socket server(accept(listener.handle(), nullptr, nullptr));
  client.sendAtOnce();
  server.sendAtOnce();
  std::vector<char> percepts(kPercepts, 'p'), actions(kActions, 'a');
  for (auto _ : state) {
    server.send(percepts);
    client.receive(percepts);
    client.send(actions);
    server.receive(actions);
  }
}
}  // namespace

void registerYardsticks() {
  benchmark::RegisterBenchmark("yardstick/copy", copy)->Unit(benchmark::kMicrosecond);
  benchmark::RegisterBenchmark("yardstick/echo", echo)->Unit(benchmark::kMicrosecond);
}

}  // namespace spark::bench
