#pragma once
/// \file
/// The status of a run on stderr: on a terminal a line that is updated, otherwise a log line from time to time.

#include <chrono>

#include "api/status.h"
#include "spark/describe.h"
#include "spark/kernel.h"

namespace sparkhost {

/// Shows simulated time, real-time factor, time lost against real time, the game's status, faults and number of agents.
/// It has no state and does not influence the simulation.
class StatusLine : public spark::Node {
  SPARK_CLASS(StatusLine, spark::Node)
 public:
  static void describe(spark::Description<StatusLine>& d);
  /// Creates one in the kernel's tree. `terminal`: stderr is one; log lines then appear above the status line.
  static void install(spark::Kernel& kernel, bool terminal);

 private:
  using Clock = std::chrono::steady_clock;
  void show(const spark::Event& event);
  std::string text(double time, double factor);

  spark::StatusReporters reporters_;
  Clock::time_point next_{}, last_{};  ///< of the next and the last update
  double lastTime_ = 0;                ///< s, simulated, of the last update
  bool terminal_ = false;
};

}  // namespace sparkhost
