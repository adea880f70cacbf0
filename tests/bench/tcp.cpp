#include "tcp.h"

#include <arpa/inet.h>
#include <netinet/tcp.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "brain.h"
#include "spark/error.h"

namespace spark::bench {

namespace {
/// A sparkhost with its standard output in our hands.
class HostProcess {
 public:
  explicit HostProcess(const std::vector<std::string>& arguments) {
    int ends[2];
    if (pipe(ends) != 0) throw Error("cannot make a pipe");
    pid_ = fork();
    if (pid_ == 0) {
      dup2(ends[1], STDOUT_FILENO);
      close(ends[0]);
      close(ends[1]);
      std::vector<char*> argv;
      for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
      argv.push_back(nullptr);
      execv(argv[0], argv.data());
      _exit(127);
    }
    close(ends[1]);
    out_ = fdopen(ends[0], "r");
  }
  ~HostProcess() {
    if (!ended_) kill(pid_, SIGTERM), finish();
    fclose(out_);
  }
  HostProcess(const HostProcess&) = delete;
  HostProcess& operator=(const HostProcess&) = delete;
  std::string line() {
    char buffer[4096];
    return fgets(buffer, sizeof buffer, out_) ? buffer : "";
  }
  /// Waits for its end and returns the CPU time it took [s].
  double finish() {
    int status = 0;
    rusage u{};
    wait4(pid_, &status, 0, &u);
    ended_ = true;
    return static_cast<double>(u.ru_utime.tv_sec + u.ru_stime.tv_sec) + 1e-6 * static_cast<double>(u.ru_utime.tv_usec + u.ru_stime.tv_usec);
  }

 private:
  pid_t pid_ = -1;
  FILE* out_ = nullptr;
  bool ended_ = false;
};

/// A sphere that drives, on a blocking socket. Ends when the host closes the connection.
class Client {
 public:
  Client(int port, std::size_t index) : socket_(::socket(AF_INET, SOCK_STREAM, 0)), index_(index) {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(port));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (connect(socket_, reinterpret_cast<sockaddr*>(&to), sizeof to) != 0) throw Error(fmt::format("cannot connect to port {}", port));
    const int on = 1;
    setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  }
  ~Client() { close(socket_); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;
  void run() {
    send("(scene rsg/agent/sphere.rsg)(syn)");
    send(fmt::format("(init (unum {})(teamname {}))(syn)", index_ % 11 + 1, index_ < 11 ? "Left" : "Right"));
    for (std::int64_t n = 0; receive(); ++n)
      if (!send(fmt::format("(drive {:.2f} {:.2f} 0)(syn)", drivePower(index_, n, 0), drivePower(index_, n, 1)))) return;
  }

 private:
  bool send(const std::string& text) {
    const std::uint32_t size = htonl(static_cast<std::uint32_t>(text.size()));
    std::string bytes(reinterpret_cast<const char*>(&size), 4);
    bytes += text;
    return ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(bytes.size());
  }
  bool receive() {
    std::uint32_t size = 0;
    if (recv(socket_, &size, 4, MSG_WAITALL) != 4) return false;
    buffer_.resize(ntohl(size));
    return recv(socket_, buffer_.data(), buffer_.size(), MSG_WAITALL) == static_cast<ssize_t>(buffer_.size());
  }
  int socket_;
  std::size_t index_;
  std::string buffer_;
};
}  // namespace

TcpResult measureTcp(int agents, int cycles) {
  const std::string program = (std::filesystem::canonical("/proc/self/exe").parent_path() / "sparkhost").string();
  const auto run = [&](int length, double& cpu, double& wall) {
    HostProcess host({program, "--config", "soccer-sphere.lua", "--sync", "--rate", "max", "--expect", std::to_string(agents), "--agent-port", "0", "--monitor-port", "0",
                      "--log-level", "error", "--duration", fmt::format("{}", length * 0.02)});
    const std::string first = host.line();
    const std::size_t at = first.find("\"agentPort\":");
    if (at == std::string::npos) throw Error("expected the ports of " + program + ", found '" + first + "'");
    const int port = std::atoi(first.c_str() + at + 12);
    const auto start = std::chrono::steady_clock::now();
    std::vector<std::thread> threads;
    for (int i = 0; i < agents; ++i) threads.emplace_back([port, i] { Client(port, static_cast<std::size_t>(i)).run(); });
    const std::string last = host.line();  // comes when the match is over
    wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    for (std::thread& t : threads) t.join();
    cpu = host.finish();
    if (last.find("\"cycles\"") == std::string::npos) throw Error("expected the result of " + program + ", found '" + last + "'");
  };
  // Start-up is taken off by a short run before.
  double cpuBefore = 0, wallBefore = 0, cpu = 0, wall = 0;
  run(50, cpuBefore, wallBefore);
  run(50 + cycles, cpu, wall);
  TcpResult r;
  r.agents = agents;
  r.cycles = cycles;
  r.cpu = 1e6 * (cpu - cpuBefore) / cycles;
  r.wall = 1e6 * (wall - wallBefore) / cycles;
  return r;
}

}  // namespace spark::bench
