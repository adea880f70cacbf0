#pragma once
/// \file
/// The viewer inside the host that all browsers look through.

#include "api/monitor.h"
#include "spark/describe.h"
#include "web_server.h"

namespace spark {

/// Below the monitor server. When somebody watches and wants a frame, copies the newest one for the web server's
/// thread; otherwise it costs a look at a pointer. Has no state: who watches does not change the simulation.
class WebMonitor : public Node, public IFrameTaker {
  SPARK_CLASS(WebMonitor, Node)
 public:
  static void describe(Description<WebMonitor>& d);

  void event(const Element& event) override;
  void take(const NewestFrame& newest, IMonitorEncoder* encoder, const Event& event) override;

  /// The frame taken last is handed over again if somebody waits for one and no cycle comes. Called by the web server,
  /// between cycles.
  void takeAgain();

 private:
  web::Exchange* exchange() const { return server_ ? &server_->exchange() : nullptr; }
  void fill(const NewestFrame& newest, double time, web::Snapshot& out);

  Link<WebServer> server_;
  Predicates events_;  ///< since the last snapshot
  std::vector<double> eventTimes_;
  std::size_t eventCount_ = 0;
  const NewestFrame* newest_ = nullptr;  ///< the monitor server's
  double time_ = 0;                      ///< s, of it
  std::uint64_t takenAt_ = 0;            ///< structure version when it was taken
};

}  // namespace spark
