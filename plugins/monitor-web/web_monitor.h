#pragma once
/// \file
/// Hands frames of the monitor server to the web server.

#include "api/monitor.h"
#include "spark/describe.h"
#include "web_server.h"

namespace spark {

/// A child of the monitor server. Copies the newest frame when the I/O thread wants it; otherwise it costs two
/// atomic loads per cycle. It has no state: watching does not change the simulation.
class WebMonitor : public Node, public IFrameTaker {
  SPARK_CLASS(WebMonitor, Node)
 public:
  static void describe(Description<WebMonitor>& d);

  void event(const Element& event) override;
  void take(const NewestFrame& newest, IMonitorEncoder* encoder, const Event& event) override;

  /// Hands over the last frame, again, if the I/O thread has requested one. The WebServer calls it between cycles while
  /// the clock is paused.
  void takeAgain();

 private:
  web::Exchange* exchange() const { return server_ ? &server_->exchange() : nullptr; }
  void fill(const NewestFrame& newest, double time, web::SnapshotBatch& batch);

  Link<WebServer> server_;
  Predicates events_;               ///< since the last snapshot
  std::vector<double> eventTimes_;  ///< s, simulated; shorter than the events while their frame has not come
  std::size_t eventCount_ = 0;
  const NewestFrame* newest_ = nullptr;  ///< the monitor server's
  double time_ = 0;                      ///< s, simulated, of `newest_`
  double takenTime_ = 0;                 ///< s, simulated, of the last snapshot
  std::uint64_t takenAt_ = 0;            ///< structure version when `newest_` was set
};

}  // namespace spark
