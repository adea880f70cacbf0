#pragma once

#include "delay_line.h"
#include "spark/random.h"

namespace spark {

/// Delays each percept or action by another, random time. None overtakes an earlier one.
class Jitter : public Modifier {
  SPARK_CLASS(Jitter, Modifier)
 public:
  static void describe(Description<Jitter>& d) {
    d.doc("Passes percepts or actions on after a random time, in their order.");
    d.property("cycles", &Jitter::cycles_)
        .min(0)
        .doc("Longest delay in cycles of the agent: each number from 0 to this one has the same probability.");
    d.property("seconds", &Jitter::seconds_)
        .unit("s")
        .range(0, modifiers::DelayLine::kMostSeconds)
        .doc("Longest delay in simulated time, uniformly distributed from 0; with both, the longer draw counts.");
    d.property("random", &Jitter::random_).state().doc("State of the random numbers of the delays.");
  }
  void apply(Signal& signal, const Event& event) override {
    if (signal.empty()) return line_.pass(signal, event.time, 0, 0);
    const auto cycles = static_cast<std::int64_t>(random_.below(static_cast<std::uint64_t>(cycles_) + 1));
    line_.pass(signal, event.time, cycles, random_.uniform(0, seconds_));
  }

 protected:
  void saveState(StateWriter& out) const override { line_.save(out); }
  void loadState(StateReader& in) override { line_.load(in); }

 private:
  int cycles_ = 0;
  double seconds_ = 0;
  RandomStream random_{*this, "jitter"};
  modifiers::DelayLine line_;
};

}  // namespace spark
