#pragma once
/// \file
/// How a run goes, on stderr: one line that a terminal keeps up to date, elsewhere a line in the log now and then.

#include <chrono>

#include "api/status.h"
#include "spark/describe.h"
#include "spark/kernel.h"

namespace sparkhost {

/// Shows clock, real-time factor, what was lost against real time, what the game reports, and agents. Has no state:
/// what it shows never influences the simulation.
class StatusLine : public spark::Node {
  SPARK_CLASS(StatusLine, spark::Node)
 public:
  static void describe(spark::Description<StatusLine>& d);
  /// Makes one in the kernel's tree. On a terminal the kernel's log writes above it.
  static void install(spark::Kernel& kernel, bool terminal);

 private:
  using Clock = std::chrono::steady_clock;
  void show(const spark::Event& event);
  std::string text(double time, double factor);

  spark::StatusReporters reporters_;
  Clock::time_point next_{}, last_{};
  double lastTime_ = 0;
  bool terminal_ = false;
};

}  // namespace sparkhost
