#pragma once

#include "delay_line.h"

namespace spark {

/// Passes a percept or an action on later: the latency of a sensor, the dead time of a motor.
class Delay : public Modifier {
  SPARK_CLASS(Delay, Modifier)
 public:
  static void describe(Description<Delay>& d) {
    d.doc("Passes percepts or actions on after a dead time.");
    d.property("cycles", &Delay::cycles_).min(0).doc("Dead time in cycles of the agent.");
    d.property("seconds", &Delay::seconds_)
        .unit("s")
        .range(0, modifiers::DelayLine::kMostSeconds)
        .doc("Dead time in simulated time; with both, the longer one counts.");
  }
  void apply(Signal& signal, const Event& event) override { line_.pass(signal, event.time, cycles_, seconds_); }

 protected:
  void saveState(StateWriter& out) const override { line_.save(out); }
  void loadState(StateReader& in) override { line_.load(in); }

 private:
  int cycles_ = 0;
  double seconds_ = 0;
  modifiers::DelayLine line_;
};

}  // namespace spark
