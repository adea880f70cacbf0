#pragma once
/// \file
/// The web server as a node: its settings, and its part in the simulation's thread.

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "api/phases.h"
#include "exchange.h"
#include "spark/describe.h"
#include "spark/kernel.h"

namespace spark {

class WebMonitor;
namespace web {
class Desk;
class Service;
}  // namespace web

/// At /sys/server/web. A thread of its own serves viewers; this one hands it frames (WebMonitor) and answers what
/// viewers ask, between cycles. Has no state: who watches does not change the simulation, but for what a referee does.
class WebServer : public Node, public IInputSource {
  SPARK_CLASS(WebServer, Node)
 public:
  static constexpr const char* kPath = "/sys/server/web";
  WebServer();
  ~WebServer() override;
  static void describe(Description<WebServer>& d);

  /// Opens the port; the first poll does so otherwise. A house that gets none runs without, and says so.
  void listen();
  void poll() override;
  bool wait(double) override { return false; }
  bool canWait() const override { return false; }

  /// Where its monitor hands frames over.
  web::Exchange& exchange() { return exchange_; }

 protected:
  void onUnlink() override;

 private:
  int port() const;
  /// Throws Error when it listens already.
  void setPort(int port);
  int viewers() const;
  int connections() const;
  /// Sets the referee's token; "" makes one up. Throws Error: it is short, or the server listens already. No property:
  /// those can be read.
  void setToken(std::string token);
  std::string link() const;
  std::string refereeLink() const;
  void open();
  void handOverAgain();
  void mustNotListen(const char* what) const;

  std::string address_ = "127.0.0.1", viewerFolder_, viewerLacks_, logs_, inspection_ = "everybody";
  std::vector<std::string> hosts_;
  int port_ = 3280, maxConnections_ = 512, maxViewers_ = 256;
  double rate_ = 20, share_ = 0.02, stallTimeout_ = 10, requestTimeout_ = 15;
  bool refereeChanges_ = true;
  std::string token_;

  web::Exchange exchange_;
  Link<WebMonitor, true> monitor_;
  std::unique_ptr<web::Service> service_;
  std::unique_ptr<web::Desk> desk_;
  bool tried_ = false;
  std::int64_t cycle_ = -1;  ///< when one was seen last
  std::chrono::steady_clock::time_point cycleAt_{};
};

}  // namespace spark
