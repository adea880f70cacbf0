#include "web_server.h"

#include <fmt/format.h>

#include <filesystem>

#include "api/credentials.h"
#include "request_queue.h"
#include "service.h"
#include "spark/plugin.h"
#include "web_monitor.h"

namespace spark {

namespace {
constexpr std::size_t kMinTokenLength = 16;
constexpr auto kPauseTime = std::chrono::milliseconds(300);  // without a cycle, after which the clock counts as paused
}  // namespace

WebServer::WebServer() : viewerLacks_(SPARK_VIEWER_LACKS) {}
WebServer::~WebServer() = default;

void WebServer::describe(Description<WebServer>& d) {
  using W = WebServer;
  d.doc(
      "Shows the match in browsers: serves the viewer, streams frames, answers requests, takes a referee's commands.");
  d.implements<IInputSource>();
  d.link(&WebServer::monitor_, At<IMonitorServer>().child<WebMonitor>());
  d.property("address", &W::address_).doc("Address to listen on; 0.0.0.0: the whole network, unencrypted.");
  d.property("port", &W::port, &W::setPort)
      .range(0, 65535)
      .unit("1")
      .ofProcess()
      .doc("TCP port; 0: any free one. If it is in use, a free one is opened and logged.");
  d.property("viewer", &W::viewerFolder_)
      .ofProcess()
      .doc("Folder of the built viewer, with index.html; without it a plain page is served.");
  d.property("viewerLacks", &W::viewerLacks_)
      .ofProcess()
      .doc("What is missing to build the viewer; shown by the plain page.");
  d.property("logs", &W::logs_).doc("Folder whose files are served as /logs/NAME for the viewer to play; empty: none.");
  d.property("hosts", &W::hosts_)
      .doc("Host names that browsers may use for it besides IP addresses, localhost and the machine's name; *: any.");
  d.property("rate", &W::rate_)
      .unit("1/s")
      .range(1, 50)
      .doc("Frames that a viewer gets unless it requests another rate.");
  d.property("history", &W::history_)
      .unit("s")
      .range(0, 36000)
      .doc("Simulated time that is kept in memory, so that viewers can scroll back; 0: none.");
  d.property("historyMemory", &W::historyMemory_)
      .unit("MB")
      .range(1, 65536)
      .doc("Most memory for it; if it is too little, less time is kept.");
  d.property("maxConnections", &W::maxConnections_)
      .range(16, 100000)
      .doc(
          "Maximum number of connections, viewers included, within the process's limit of open files. Idle ones make "
          "room.");
  d.property("maxViewers", &W::maxViewers_)
      .range(1, 100000)
      .doc("Maximum number of viewers; further ones are refused.");
  d.property("requestTimeout", &W::requestTimeout_)
      .unit("s")
      .range(0.1, 3600)
      .doc("Time to receive a request, and to send each part of the reply; a slower connection is closed.");
  d.property("stallTimeout", &W::stallTimeout_)
      .unit("s")
      .range(0.1, 3600)
      .doc("A viewer that reads nothing for this time is disconnected.");
  d.property("share", &W::share_)
      .range(0, 1)
      .doc("Fraction of wall time that the simulation thread may spend on viewers' requests.");
  d.property("inspection", &W::inspection_)
      .choices({"everybody", "referee"})
      .doc("Who may inspect the tree, properties, contacts, percepts.");
  d.property("refereeChanges", &W::refereeChanges_).doc("The referee may also set properties and call methods.");
  d.property("viewers", &W::viewers).doc("Number of viewers now.");
  d.property("connections", &W::connections).doc("Number of connections now, viewers included.");
  d.method("listen", &W::listen).doc("Opens the port; otherwise the first poll does.");
  d.method("setToken", &W::setToken)
      .parameters({"token"})
      .doc("Sets the referee's token, at least 16 characters; empty: a random one. Call it before listen().");
  d.method("link", &W::link).doc("Address for browsers; empty while the port is closed.");
  d.method("refereeLink", &W::refereeLink).doc("The same with the referee's token.");
}

void WebServer::mustNotListen(const char* what) const {
  if (service_)
    throw Error(fmt::format("{}.{}: it listens on {} already. Set it before listen().", path(), what, port()));
}

int WebServer::port() const { return service_ ? service_->port() : port_; }

void WebServer::setPort(int port) {
  if (port != this->port()) mustNotListen("port");
  port_ = port;
}

int WebServer::viewers() const { return service_ ? service_->viewers() : 0; }
int WebServer::connections() const { return service_ ? service_->connections() : 0; }

void WebServer::setToken(const Secret& secret) {
  std::string token = secret.text;
  mustNotListen("setToken");
  const auto plain = [](unsigned char c) { return std::isalnum(c) || c == '-' || c == '_'; };
  if (!token.empty() && (token.size() < kMinTokenLength || !std::all_of(token.begin(), token.end(), plain)))
    throw Error(
        fmt::format("{}.setToken: expected at least {} letters, digits, - or _, so that it cannot be guessed and can "
                    "stand in a link",
                    path(), kMinTokenLength));
  token_ = std::move(token);
}

std::string WebServer::link() const {
  if (!service_) return {};
  const bool everywhere = address_ == "0.0.0.0" || address_ == "::";
  const std::string host = everywhere                                ? "127.0.0.1"
                           : address_.find(':') == std::string::npos ? address_
                                                                     : "[" + address_ + "]";
  return fmt::format("http://{}:{}/", host, port());
}

std::string WebServer::refereeLink() const { return service_ ? link() + "#token=" + token_ : std::string(); }

void WebServer::listen() {
  if (std::exchange(tried_, true)) return;
  try {
    open();
    kernel().log().info("Web: {} (referee: {})", link(), refereeLink());
    std::error_code none;
    if (!std::filesystem::is_regular_file(std::filesystem::path(viewerFolder_) / "index.html", none))
      kernel().log().info("Web: the viewer was not built{}{}; a plain page with live numbers is served instead.",
                          viewerLacks_.empty() ? "" : ", missing is ", viewerLacks_);
  } catch (const std::exception& e) {
    kernel().log().warning("Nobody can watch in a browser: {}", e.what());
  }
}

void WebServer::open() {
  if (token_.empty()) token_ = makeToken();
  web::ServiceSettings s;
  s.address = address_;
  s.port = static_cast<unsigned short>(port_);
  s.maxConnections = maxConnections_;
  s.maxViewers = maxViewers_;
  s.requestTimeout = requestTimeout_;
  s.site = {viewerFolder_, viewerLacks_, logs_, hosts_};
  s.hub.token = token_;
  s.hub.rate = rate_;
  s.hub.stallTimeout = stallTimeout_;
  s.hub.history = history_;
  s.hub.historyBytes = static_cast<std::size_t>(historyMemory_) << 20;
  if (const auto* clock = kernel().root().find<ISimulation>()) s.hub.step = clock->step();
  service_ = std::make_unique<web::Service>(std::move(s), exchange_, kernel().log());
  requests_ = std::make_unique<web::RequestQueue>(kernel(), exchange_);
}

void WebServer::poll() {
  if (!tried_) listen();
  if (!service_) return;
  if (exchange_.wantsNow()) handOverAgain();
  requests_->process({share_, inspection_ == "everybody", refereeChanges_}, service_->viewers());
}

/// While the clock is paused, for example until the expected agents have connected, there is no publish phase. New
/// viewers then get the last frame.
void WebServer::handOverAgain() {
  const auto* clock = kernel().root().find<ISimulation>();
  const auto now = std::chrono::steady_clock::now();
  if (!clock || std::exchange(cycle_, clock->cycle()) != clock->cycle()) {
    cycleAt_ = now;
  } else if (now - cycleAt_ > kPauseTime) {
    cycleAt_ = now;
    if (monitor_) monitor_->takeAgain();
  }
}

void WebServer::onUnlink() {
  service_.reset();
  requests_.reset();
  tried_ = false;
}

}  // namespace spark

SPARK_PLUGIN("monitor-web", "1.0",
             "The match in browsers: HTTP and WebSockets, a compact stream, requests, a referee's console.",
             spark::WebServer, spark::WebMonitor)
