#pragma once
/// \file
/// The run loop: names the phases of a cycle and drives them in real time, in lockstep, or as fast as possible.

#include <chrono>
#include <string>
#include <vector>

#include "api/phases.h"
#include "pace.h"
#include "spark/describe.h"
#include "spark/kernel.h"
#include "timers.h"

namespace spark {

/// The run loop, at /sys/server/simulation.
class Simulation : public Node, public ISimulation {
  SPARK_CLASS(Simulation, Node)
 public:
  static void describe(Description<Simulation>& d);

  double time() const override { return time_; }
  std::int64_t cycle() const override { return cycle_; }
  double step() const override { return step_; }
  bool lockstep() const override { return sync_; }
  bool paced() const override { return rate_ == "real"; }
  void setPaced(bool on) override { rate_ = on ? "real" : "max"; }
  void run() override;
  void runCycles(std::int64_t count) override;
  void stop() override { stopped_ = true; }

 protected:
  void onLink() override;
  void saveState(StateWriter& out) const override;
  void loadState(StateReader& in) override;

 private:
  using Clock = simulation::Timers::Clock;

  void setThreads(int count);
  int threads() const { return threads_; }
  std::int64_t faults() const { return kernel().faults(); }
  Value phaseMicros() const { return timers_.means(); }
  Value cycleTimes() const { return pace_.percentiles(); }
  std::string paceTable() const { return pace_.table(); }
  Value histogram() const { return pace_.buckets(); }
  void resetTimers() { timers_.reset(), pace_.reset(); }

  template <class More>
  void loop(More more);
  bool stopping() const { return stopped_ || kernel().stopRequested(); }
  bool finished() const;
  void poll();
  bool gatesOpen();
  /// Waits for input or until `seconds` have passed, at most one slice, and takes what came.
  void waitForInput(double seconds);
  void waitForClock();
  /// Everything that must have been read before the cycle starts; false when asked to stop meanwhile.
  bool collectInput();
  void emit(simulation::Part part, Channel& channel, Clock::time_point& mark);
  void executeCycle();

  double step_ = 0.02, duration_ = 0, time_ = 0;
  std::int64_t cycle_ = 0;
  std::string rate_ = "real";
  bool sync_ = false, stopped_ = false, running_ = false;
  int threads_ = 1;

  Links<IInputSource> sources_;
  Links<IInputGate> gates_;

  Channel *act_ = nullptr, *prepare_ = nullptr, *physics_ = nullptr, *place_ = nullptr, *rule_ = nullptr,
          *sense_ = nullptr, *publish_ = nullptr;
  Clock::time_point due_{};     ///< when the next cycle may start in real time
  Clock::time_point wanted_{};  ///< when this one was due, or could start because agents had answered
  double lostTime_ = 0;         ///< s of wall time; says how the host does, not how the world is: no state
  std::int64_t lateCycles_ = 0;
  simulation::Timers timers_;
  simulation::Pace pace_;
};

}  // namespace spark
