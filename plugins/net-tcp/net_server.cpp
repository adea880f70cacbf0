#include "net-tcp/net_server.h"

#include <algorithm>
#include <chrono>

#include "net-tcp/length_prefix_framing.h"
#include "net-tcp/line_framing.h"
#include "net-tcp/tcp_port.h"
#include "net-tcp/unix_port.h"
#include "spark/plugin.h"

namespace spark {

namespace {
using Clock = std::chrono::steady_clock;
// Maximum time of one wait for input, so that a request to stop is seen.
constexpr auto kMaxWait = std::chrono::milliseconds(25);
// Without input for this time, what was received is acknowledged before the end of the cycle: in lockstep the client
// that holds back its next bytes may be the one that the cycle waits for.
constexpr auto kQuiet = std::chrono::milliseconds(10);
}  // namespace

NetServer::NetServer() = default;

void NetServer::describe(Description<NetServer>& d) {
  d.doc("Network server: ports below it bring input to the run loop.");
  d.implements<IInputSource>();
  d.link(&NetServer::ports_, Below<StreamPort>());
  d.link(&NetServer::tape_, At<IInputTape>());
  d.property("open", &NetServer::open_).doc("False: no port is opened.");
  d.on<&NetServer::endCycle>(phase::kPublish);
  d.method("listen", &NetServer::listen).doc("Opens all ports below; otherwise the first poll does.");
}

void NetServer::listen() {
  if (!isOpen()) return;
  for (const Found<StreamPort>& port : ports_) port->listen();
}

void NetServer::poll() { pollPorts(); }

bool NetServer::pollPorts() {
  if (!isOpen()) return false;
  const std::vector<Found<StreamPort>>& ports = ports_.all();
  if (!std::all_of(ports.begin(), ports.end(), [](const Found<StreamPort>& p) { return p->listening(); })) {
    try {
      listen();
    } catch (const Error& e) {
      kernel().log().error("The network cannot be opened, the host ends. {}", e.what());
      kernel().requestStop();
      return true;
    }
  }
  io_->restart();
  io_->poll();
  bool any = false;
  for (const Found<StreamPort>& port : ports_) any |= port->poll();
  if (any) heardAt_ = Clock::now();
  return any;
}

void NetServer::acknowledge() {
  for (const Found<StreamPort>& port : ports_) port->acknowledge();
}

bool NetServer::wait(double seconds) {
  const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                      std::chrono::duration<double>(std::clamp(seconds, 0.0, 3600.0)));
  for (;;) {
    if (pollPorts() || kernel().stopRequested()) return true;
    const auto now = Clock::now();
    if (now >= end) return false;
    const bool quiet = now - heardAt_ >= kQuiet;
    if (quiet) acknowledge();
    // Sleep until a socket becomes ready or the timer expires.
    timer_.expires_at(std::min(end, quiet ? now + kMaxWait : heardAt_ + kQuiet));
    timer_.async_wait(net::MemoryHandler(timerMemory_, [](const boost::system::error_code&) {}));
    io_->restart();
    io_->run_one();
    timer_.cancel();
  }
}

}  // namespace spark

SPARK_PLUGIN("net-tcp", "1.0",
             "Network server with ports of TCP and Unix sockets on Boost.Asio; messages by length or by line.",
             spark::NetServer, spark::StreamPort, spark::TcpPort, spark::UnixPort, spark::LengthPrefixFraming,
             spark::LineFraming)
