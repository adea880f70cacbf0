#include "service.h"

#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/steady_timer.hpp>
#include <csignal>
#include <thread>

#include "connections.h"
#include "spark/error.h"
#include "spark/log.h"

namespace spark::web {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

namespace {
constexpr int kSpareDescriptors = 256;  // for agents, monitors, files
constexpr int kSendBuffer =
    131072;  // bytes that the system holds back for a viewer; the rest of what waits is ours to drop
constexpr auto kAcceptPause = std::chrono::milliseconds(200);

/// As many connections as the process has descriptors for; each may have a file open besides its socket.
int affordable(int wanted) {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return wanted;
  return std::min(wanted,
                  std::max(16, (static_cast<int>(std::min<rlim_t>(limit.rlim_cur, 1 << 20)) - kSpareDescriptors) / 2));
}

ServiceSettings afforded(ServiceSettings s) {
  s.maxConnections = affordable(s.maxConnections);
  s.maxViewers = std::min(s.maxViewers, s.maxConnections);
  return s;
}
}  // namespace

struct Service::Impl {
  Impl(ServiceSettings s, Exchange& e, Log& log)
      : exchange(e), hall{afforded(s), log, Site(s.site), Audience(e, log, s.audience), {}, 0, 0, [this] { pump(); }} {
    open(s);
    const int copy = dup(exchange.descriptor());
    if (copy < 0) throw Error("cannot open the web server: too many files are open");
    bell.assign(copy);
    listen();
    accept();
    pump();
    start();
  }

  ~Impl() {
    io.stop();
    thread.join();
    hall.audience.dismiss();  // what else is alive hangs in io, which goes before the hall
  }

  // ---- the port ----

  void open(const ServiceSettings& s) {
    error_code ec;
    const auto address = asio::ip::make_address(s.address, ec);
    if (ec)
      throw Error(fmt::format(
          "the web server's address: expected an IP address such as 127.0.0.1 or 0.0.0.0, found '{}'", s.address));
    const bool had = bind({address, s.port}, ec);
    const std::string why = ec.message();
    if (!had && (s.port == 0 || !bind({address, 0}, ec)))
      throw Error(fmt::format("the web server cannot listen on {}:{}: {}", s.address, s.port, why));
    port = acceptor.local_endpoint().port();
    if (!had) hall.log.info("Web: port {} cannot be had ({}), {} is taken instead.", s.port, why, port);
  }

  bool bind(const tcp::endpoint& end, error_code& ec) {
    acceptor.close(ec);
    acceptor.open(end.protocol(), ec);
    if (!ec) acceptor.set_option(tcp::acceptor::reuse_address(true), ec);
    if (!ec) acceptor.bind(end, ec);
    if (!ec) acceptor.listen(asio::socket_base::max_listen_connections, ec);
    return !ec;
  }

  void accept() {
    acceptor.async_accept([this](error_code ec, tcp::socket socket) {
      if (ec) return acceptLater(ec);
      take(std::move(socket));
      accept();
    });
  }

  /// Out of descriptors, most likely.
  void acceptLater(error_code ec) {
    if (ec == asio::error::operation_aborted) return;
    hall.log.debug("Web: cannot take a connection: {}.", ec.message());
    makeRoom();
    pause.expires_after(kAcceptPause);
    pause.async_wait([this](error_code stopped) {
      if (!stopped) accept();
    });
  }

  void take(tcp::socket socket) {
    error_code ignored;
    socket.set_option(tcp::no_delay(true), ignored);
    socket.set_option(tcp::socket::send_buffer_size(kSendBuffer), ignored);
    if (hall.visitors.size() + hall.viewers >= static_cast<std::size_t>(hall.settings.maxConnections) && !makeRoom())
      return;
    serveHttp(hall, beast::tcp_stream(std::move(socket)));
  }

  /// Ends the visitor who was quiet longest, else the one who came first; viewers stay.
  bool makeRoom() {
    const auto quiet =
        std::find_if(hall.visitors.begin(), hall.visitors.end(), [](const Connection* c) { return !c->answering; });
    const auto at = quiet == hall.visitors.end() ? hall.visitors.begin() : quiet;
    if (at == hall.visitors.end()) return false;
    (*at)->drop();
    return true;
  }

  // ---- the simulation's thread rings ----

  void listen() {
    bell.async_wait(asio::posix::stream_descriptor::wait_read, [this](error_code ec) {
      if (ec) return;
      std::uint64_t count = 0;
      [[maybe_unused]] const auto got = ::read(bell.native_handle(), &count, sizeof count);
      hall.audience.collect(Clock::now());
      pump();
      listen();
    });
  }

  void pump() {
    viewers.store(static_cast<int>(hall.audience.size()), std::memory_order_relaxed);
    connections.store(static_cast<int>(hall.visitors.size() + hall.viewers), std::memory_order_relaxed);
    const auto next = hall.audience.tick(Clock::now());
    if (next == planned) return;
    planned = next;
    timer.expires_at(next);
    timer.async_wait([this](error_code ec) {
      if (!ec) planned = {}, pump();
    });
  }

  /// Signals are for the simulation's thread, and so is a processor that only one of them can have: this one does not
  /// push it off.
  void start() {
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    thread = std::thread([this] {
      pthread_setname_np(pthread_self(), "web");
      const sched_param none{};
      pthread_setschedparam(pthread_self(), SCHED_BATCH, &none);
      io.run();
    });
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
  }

  Exchange& exchange;
  Hall hall;
  asio::io_context io{1};
  tcp::acceptor acceptor{io};
  unsigned short port = 0;
  asio::posix::stream_descriptor bell{io};
  asio::steady_timer timer{io}, pause{io};
  Clock::time_point planned{};
  std::atomic<int> viewers{0}, connections{0};
  std::thread thread;
};

Service::Service(ServiceSettings settings, Exchange& exchange, Log& log)
    : impl_(std::make_unique<Impl>(std::move(settings), exchange, log)) {}
Service::~Service() = default;
unsigned short Service::port() const { return impl_->port; }
int Service::viewers() const { return impl_->viewers.load(std::memory_order_relaxed); }
int Service::connections() const { return impl_->connections.load(std::memory_order_relaxed); }

}  // namespace spark::web
