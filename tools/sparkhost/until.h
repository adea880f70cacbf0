#pragma once
/// \file
/// The end of a run that goes on from a recording.

#include <cmath>

#include "api/phases.h"
#include "spark/describe.h"
#include "spark/kernel.h"

namespace sparkhost {

/// Stops the simulation at a time. A setting such as the loop's duration would make it another run.
class Until : public spark::Node {
  SPARK_CLASS(Until, spark::Node)
 public:
  static constexpr double kTolerance = 1e-6;  ///< of times, which are sums of steps [s]
  /// The last cycle: the last that ends no later than the time, or the first that ends no earlier.
  enum class Last { notLater, notEarlier };

  /// Adds one to a host's tree. `time`: s
  static void add(spark::Kernel& kernel, double time, Last last) {
    kernel.registerClass<Until>();
    Until& made = kernel.create<Until>("Until", "/sys/host/until");
    made.time_ = time, made.last_ = last;
  }
  static void describe(spark::Description<Until>& d) {
    d.doc("Stops the simulation at a time.");
    d.on<&Until::look>(spark::phase::kPublish);
  }

 private:
  void look(const spark::Event& event) {
    const bool isLast =
        last_ == Last::notLater ? event.time + event.step > time_ + kTolerance : event.time >= time_ - kTolerance;
    if (isLast) kernel().root().require<spark::ISimulation>(spark::ISimulation::kPath).stop();
  }
  double time_ = HUGE_VAL;
  Last last_ = Last::notLater;
};

}  // namespace sparkhost
