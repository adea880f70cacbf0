#pragma once
/// \file
/// The run loop: defines the phases of a cycle and runs them in real time, in lockstep, or as fast as possible.

#include <chrono>
#include <string>
#include <vector>

#include "api/inputs.h"
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

  /// Runs cycles while `more()` returns true and no stop is requested.
  template <class More>
  void loop(More more);
  bool stopping() const { return stopped_ || kernel().stopRequested(); }
  /// True when `duration` is reached or a stop is requested.
  bool finished() const;
  /// Polls all input sources.
  void poll();
  /// True when all input gates are ready.
  bool gatesOpen();
  /// Waits for input, at most `seconds` and at most one slice, and processes it.
  void waitForInput(double seconds);
  /// Waits until the next cycle is due in real time. Processes input meanwhile.
  void waitForClock();
  /// Waits for clock and gates and processes all input that belongs to the next cycle. Returns false when a stop was
  /// requested meanwhile.
  bool collectInput();
  /// Emits a phase and measures it from `mark` on; sets `mark` to its end.
  void emit(simulation::Part part, Channel& channel, Clock::time_point& mark);
  void executeCycle();

  double step_ = 0.02, duration_ = 0, time_ = 0;  ///< s
  std::int64_t cycle_ = 0;
  std::string rate_ = "real";
  bool sync_ = false, stopped_ = false, running_ = false;
  int threads_ = 1;

  Links<IInputSource> sources_;
  Links<IInputGate> gates_;
  Link<IInputTape> tape_;

  Channel *act_ = nullptr, *prepare_ = nullptr, *physics_ = nullptr, *place_ = nullptr, *rule_ = nullptr,
          *sense_ = nullptr, *publish_ = nullptr;
  Clock::time_point due_{};       ///< time at which the next cycle is due in real time
  Clock::time_point startDue_{};  ///< time at which the current cycle was due, or at which the last agent had answered
  double lostTime_ = 0;           ///< wall time [s]; a measurement of the host, not state of the world
  std::int64_t lateCycles_ = 0;
  simulation::Timers timers_;
  simulation::Pace pace_;
};

}  // namespace spark
