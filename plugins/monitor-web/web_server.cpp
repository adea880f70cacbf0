#include "web_server.h"

#include <fmt/format.h>

#include <filesystem>

#include "desk.h"
#include "referee.h"
#include "service.h"
#include "spark/plugin.h"
#include "web_monitor.h"

namespace spark {

namespace {
constexpr std::size_t kShortestToken = 16;
constexpr auto kStandsStill = std::chrono::milliseconds(300);
}  // namespace

WebServer::WebServer() : viewerLacks_(SPARK_VIEWER_LACKS) {}
WebServer::~WebServer() = default;

void WebServer::describe(Description<WebServer>& d) {
  using W = WebServer;
  d.doc(
      "Shows the match in browsers: serves the viewer, streams frames, answers questions, takes a referee's commands.");
  d.implements<IInputSource>();
  d.link(&WebServer::monitor_, At<IMonitorServer>().child<WebMonitor>());
  d.property("address", &W::address_).doc("Where it listens; 0.0.0.0: for the whole network, unencrypted.");
  d.property("port", &W::port, &W::setPort)
      .range(0, 65535)
      .unit("1")
      .doc("TCP port; 0: a free one. Taken: a free one, and the log says so.");
  d.property("viewer", &W::viewerFolder_)
      .doc("Folder of the built viewer, with index.html; without one a plain page is served.");
  d.property("viewerLacks", &W::viewerLacks_).doc("What the plain page says is missing for the viewer.");
  d.property("logs", &W::logs_)
      .doc("Folder whose files are served as /logs/NAME, to be played by the viewer; empty: none.");
  d.property("hosts", &W::hosts_)
      .doc("Names under which browsers may reach it, besides IP addresses, localhost and the machine's name; *: any.");
  d.property("rate", &W::rate_)
      .unit("1/s")
      .range(1, 50)
      .doc("Frames that a viewer gets unless it asks for another rate.");
  d.property("maxConnections", &W::maxConnections_)
      .range(16, 100000)
      .doc("Connections at a time, viewers included, as far as the process may open files. Idle ones make room.");
  d.property("maxViewers", &W::maxViewers_).range(1, 100000).doc("Viewers at a time; further ones are turned away.");
  d.property("requestTimeout", &W::requestTimeout_)
      .unit("s")
      .range(0.1, 3600)
      .doc("A connection that takes longer to ask, or to take a piece of its answer, is closed.");
  d.property("stallTimeout", &W::stallTimeout_)
      .unit("s")
      .range(0.1, 3600)
      .doc("A viewer that takes nothing for so long is closed.");
  d.property("share", &W::share_)
      .range(0, 1)
      .doc("Share of wall time that answers to all viewers' questions may take of the simulation's thread.");
  d.property("inspection", &W::inspection_)
      .choices({"everybody", "referee"})
      .doc("Who may ask about the tree, properties, contacts, percepts.");
  d.property("refereeChanges", &W::refereeChanges_).doc("The referee may also set properties and call methods.");
  d.property("viewers", &W::viewers).doc("Number of viewers now.");
  d.property("connections", &W::connections).doc("Number of connections now, viewers included.");
  d.method("listen", &W::listen).doc("Opens the port; the first poll does so otherwise.");
  d.method("setToken", &W::setToken)
      .parameters({"token"})
      .doc("Sets the referee's token, of at least 16 characters; empty: one is made up. Before listen().");
  d.method("link", &W::link).doc("Where browsers find it, empty when it is not open.");
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

void WebServer::setToken(std::string token) {
  mustNotListen("setToken");
  const auto plain = [](unsigned char c) { return std::isalnum(c) || c == '-' || c == '_'; };
  if (!token.empty() && (token.size() < kShortestToken || !std::all_of(token.begin(), token.end(), plain)))
    throw Error(
        fmt::format("{}.setToken: expected at least {} letters, digits, - or _, so that it cannot be guessed and can "
                    "stand in a link",
                    path(), kShortestToken));
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
      kernel().log().info("Web: the viewer was not built{}{}; a plain page with the live numbers stands in for it.",
                          viewerLacks_.empty() ? "" : ", missing is ", viewerLacks_);
  } catch (const std::exception& e) {
    kernel().log().warning("Nobody can watch in a browser: {}", e.what());
  }
}

void WebServer::open() {
  if (token_.empty()) token_ = web::makeToken();
  web::ServiceSettings s;
  s.address = address_;
  s.port = static_cast<unsigned short>(port_);
  s.maxConnections = maxConnections_;
  s.maxViewers = maxViewers_;
  s.requestTimeout = requestTimeout_;
  s.site = {viewerFolder_, viewerLacks_, logs_, hosts_};
  s.audience.token = token_;
  s.audience.rate = rate_;
  s.audience.stallTimeout = stallTimeout_;
  if (const auto* clock = kernel().root().find<ISimulation>()) s.audience.step = clock->step();
  service_ = std::make_unique<web::Service>(std::move(s), exchange_, kernel().log());
  desk_ = std::make_unique<web::Desk>(kernel(), exchange_);
}

void WebServer::poll() {
  if (!tried_) listen();
  if (!service_) return;
  if (exchange_.wanted.load(std::memory_order_relaxed)) handOverAgain();
  desk_->work({share_, inspection_ == "everybody", refereeChanges_}, service_->viewers());
}

/// While the clock stands still, as it does for agents that are waited for, no publish phase comes: who begins to watch
/// sees what there is.
void WebServer::handOverAgain() {
  const auto* clock = kernel().root().find<ISimulation>();
  const auto now = std::chrono::steady_clock::now();
  if (!clock || std::exchange(cycle_, clock->cycle()) != clock->cycle()) {
    cycleAt_ = now;
  } else if (now - cycleAt_ > kStandsStill) {
    cycleAt_ = now;
    if (monitor_) monitor_->takeAgain();
  }
}

void WebServer::onUnlink() {
  service_.reset();
  desk_.reset();
  tried_ = false;
}

}  // namespace spark

SPARK_PLUGIN("monitor-web", "1.0",
             "The match in browsers: HTTP and WebSockets, a compact stream, questions, a referee's console.",
             spark::WebServer, spark::WebMonitor)
