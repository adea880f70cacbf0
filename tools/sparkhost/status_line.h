#pragma once
/// \file
/// The one line that a terminal shows while a house runs.

#include <chrono>

#include "spark/describe.h"
#include "spark/kernel.h"

namespace sparkhost {

/// Shows clock, play mode, score, agents and real-time factor on stderr, a few times a second. Has no state: what it shows never
/// influences the simulation.
class StatusLine : public spark::Node {
  SPARK_CLASS(StatusLine, spark::Node)
 public:
  static void describe(spark::Description<StatusLine>& d);
  /// Makes one in the kernel's tree, and the kernel's log write above it.
  static void install(spark::Kernel& kernel);

 private:
  using Clock = std::chrono::steady_clock;
  void show(const spark::Event& event);

  Clock::time_point next_{}, last_{};
  double lastTime_ = 0;
};

}  // namespace sparkhost
