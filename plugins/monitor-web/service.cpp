#include "service.h"

#include <fcntl.h>
#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <csignal>
#include <thread>

#include "api/descriptors.h"
#include "server_state.h"
#include "spark/error.h"
#include "spark/log.h"

namespace spark::web {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

namespace {
constexpr int kReservedDescriptors = 256;  // for agents, monitors, files

// Bytes; small, so that frames for a slow viewer wait in our queue, where they can be skipped.
constexpr int kSendBufferBytes = 131072;

constexpr auto kAcceptRetryDelay = std::chrono::milliseconds(200);

/// Limits the number of connections to what the process may open: each may need a file besides its socket.
int clampToDescriptorLimit(int wanted) {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return wanted;
  return std::min(
      wanted, std::max(16, (static_cast<int>(std::min<rlim_t>(limit.rlim_cur, 1 << 20)) - kReservedDescriptors) / 2));
}

ServiceSettings withDescriptorLimit(ServiceSettings s) {
  s.maxConnections = clampToDescriptorLimit(s.maxConnections);
  s.maxViewers = std::min(s.maxViewers, s.maxConnections);
  return s;
}
}  // namespace

struct Service::Impl {
  Impl(const ServiceSettings& s, Exchange& e, Log& log)
      : exchange(e),
        state{withDescriptorLimit(s),
              log,
              Site(s.site),
              ViewerHub(e, log, s.hub),
              {},
              0,
              0,
              [this](std::string_view path, AssetLoader::Callback callback) {
                return assets.request(path, std::move(callback));
              },
              [this] { update(); }},
        assets(state.hub.assets(), e, log, [this](std::function<void()> f) { asio::post(io, std::move(f)); }) {
    open(s);
    const int copy = ::fcntl(exchange.wakeupFd(), F_DUPFD_CLOEXEC, 0);  // `wakeup` closes its descriptor
    if (copy < 0) throw Error("cannot open the web server: too many files are open");
    wakeup.assign(copy);
    awaitWakeup();
    accept();
    update();
    start();
  }

  ~Impl() {
    io.stop();
    thread.join();
    assets.stop();
    state.hub.clear();  // the remaining sessions are owned by handlers in io, which is destroyed before `state`
  }

  // ---- listening port ----

  void open(const ServiceSettings& s) {
    error_code ec;
    const auto address = asio::ip::make_address(s.address, ec);
    if (ec)
      throw Error(fmt::format(
          "the web server's address: expected an IP address such as 127.0.0.1 or 0.0.0.0, found '{}'", s.address));
    const bool bound = bind({address, s.port}, ec);
    const std::string why = ec.message();
    if (!bound && (s.port == 0 || !bind({address, 0}, ec)))
      throw Error(fmt::format("the web server cannot listen on {}:{}: {}", s.address, s.port, why));
    port = acceptor.local_endpoint().port();
    if (!bound) state.log.info("Web: port {} cannot be had ({}), {} is taken instead.", s.port, why, port);
  }

  bool bind(const tcp::endpoint& endpoint, error_code& ec) {
    acceptor.close(ec);
    acceptor.open(endpoint.protocol(), ec);
    if (!ec) closeOnExec(acceptor.native_handle());
    if (!ec) acceptor.set_option(tcp::acceptor::reuse_address(true), ec);
    if (!ec) acceptor.bind(endpoint, ec);
    if (!ec) acceptor.listen(asio::socket_base::max_listen_connections, ec);
    return !ec;
  }

  void accept() {
    acceptor.async_accept([this](error_code ec, tcp::socket socket) {
      if (ec) return retryAccept(ec);
      serve(std::move(socket));
      accept();
    });
  }

  /// The likely cause is that the process has no descriptor left: closes a connection and tries again later.
  void retryAccept(error_code ec) {
    if (ec == asio::error::operation_aborted) return;
    state.log.debug("Web: cannot take a connection: {}.", ec.message());
    makeRoom();
    retryTimer.expires_after(kAcceptRetryDelay);
    retryTimer.async_wait([this](error_code stopped) {
      if (!stopped) accept();
    });
  }

  void serve(tcp::socket socket) {
    closeOnExec(socket.native_handle());
    error_code ignored;
    socket.set_option(tcp::no_delay(true), ignored);
    socket.set_option(tcp::socket::send_buffer_size(kSendBufferBytes), ignored);
    if (openConnections() >= state.settings.maxConnections && !makeRoom()) return;
    serveHttp(state, beast::tcp_stream(std::move(socket)));
  }

  int openConnections() const { return static_cast<int>(state.connections.size()) + state.viewers; }

  /// Drops the HTTP connection that has been idle longest, or the oldest one if all are busy. Never drops a viewer.
  /// False if there is no HTTP connection.
  bool makeRoom() {
    auto& all = state.connections;
    const auto idle = std::find_if(all.begin(), all.end(), [](const Connection* c) { return !c->answering; });
    const auto victim = idle == all.end() ? all.begin() : idle;
    if (victim == all.end()) return false;
    (*victim)->drop();
    return true;
  }

  // ---- hub ----

  /// Waits for the simulation thread to signal snapshots and replies.
  void awaitWakeup() {
    wakeup.async_wait(asio::posix::stream_descriptor::wait_read, [this](error_code ec) {
      if (ec) return;
      std::uint64_t count = 0;
      [[maybe_unused]] const auto got = ::read(wakeup.native_handle(), &count, sizeof count);
      state.hub.collect(Clock::now());
      update();
      awaitWakeup();
    });
  }

  /// Publishes the counters, runs the hub's due work and sets the timer for the next.
  void update() {
    viewers.store(static_cast<int>(state.hub.size()), std::memory_order_relaxed);
    connections.store(openConnections(), std::memory_order_relaxed);
    const auto next = state.hub.tick(Clock::now());
    if (next == timerAt) return;
    timerAt = next;
    timer.expires_at(next);
    timer.async_wait([this](error_code ec) {
      if (!ec) timerAt = {}, update();
    });
  }

  /// Starts the thread. It blocks all signals, which belong to the simulation thread. With SCHED_BATCH it does not
  /// preempt the simulation thread when both share a processor.
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
  ServerState state;
  asio::io_context io{1};
  tcp::acceptor acceptor{io};
  unsigned short port = 0;
  asio::posix::stream_descriptor wakeup{io};     // Exchange::wakeupFd()
  asio::steady_timer timer{io}, retryTimer{io};  // of the hub; of accept()
  Clock::time_point timerAt{};                   // when `timer` expires; {}: it is not set
  std::atomic<int> viewers{0}, connections{0};   // for other threads
  AssetLoader assets;
  std::thread thread;
};

Service::Service(const ServiceSettings& settings, Exchange& exchange, Log& log)
    : impl_(std::make_unique<Impl>(settings, exchange, log)) {}
Service::~Service() = default;
unsigned short Service::port() const { return impl_->port; }
int Service::viewers() const { return impl_->viewers.load(std::memory_order_relaxed); }
int Service::connections() const { return impl_->connections.load(std::memory_order_relaxed); }

}  // namespace spark::web
