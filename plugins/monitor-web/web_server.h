#pragma once
/// \file
/// The web server as a node: its settings and its part in the simulation thread.

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "api/credentials.h"
#include "api/phases.h"
#include "exchange.h"
#include "spark/describe.h"
#include "spark/kernel.h"

namespace spark {

class WebMonitor;
namespace web {
class RequestQueue;
class Service;
}  // namespace web

/// At /sys/server/web. A thread of its own (Service) serves viewers. The simulation thread hands it frames (WebMonitor)
/// and executes viewers' requests between cycles (RequestQueue). It has no state: only a referee's requests change the
/// simulation.
class WebServer : public Node, public IInputSource {
  SPARK_CLASS(WebServer, Node)
 public:
  static constexpr const char* kPath = "/sys/server/web";
  WebServer();
  ~WebServer() override;
  static void describe(Description<WebServer>& d);

  /// Opens the port; without this call the first poll() does. If no port can be opened, logs a warning and stays
  /// closed.
  void listen();
  void poll() override;
  bool wait(double) override { return false; }
  bool canWait() const override { return false; }

  /// Where its monitor hands over frames.
  web::Exchange& exchange() { return exchange_; }

 protected:
  void onUnlink() override;

 private:
  int port() const;
  /// Throws Error if it listens already.
  void setPort(int port);
  int viewers() const;
  int connections() const;
  /// Sets the referee's token; "" generates one. Throws Error if the token is too short or the server listens already.
  /// Not a property, since properties can be read.
  void setToken(const Secret& secret);
  std::string link() const;
  std::string refereeLink() const;
  void open();
  void handOverAgain();
  void mustNotListen(const char* what) const;

  std::string address_ = "127.0.0.1", viewerFolder_, viewerLacks_, logs_, inspection_ = "everybody";
  std::vector<std::string> hosts_;
  int port_ = 3280, maxConnections_ = 512, maxViewers_ = 256;
  int historyMemory_ = 64;
  double history_ = 300, rate_ = 20, share_ = 0.02, stallTimeout_ = 10, requestTimeout_ = 15;
  bool refereeChanges_ = true;
  std::string token_;

  web::Exchange exchange_;
  Link<WebMonitor, true> monitor_;
  std::unique_ptr<web::Service> service_;
  std::unique_ptr<web::RequestQueue> requests_;
  bool tried_ = false;                               ///< listen() was called
  std::int64_t cycle_ = -1;                          ///< seen by the last poll()
  std::chrono::steady_clock::time_point cycleAt_{};  ///< when `cycle_` changed, or the last frame was handed over again
};

}  // namespace spark
