#pragma once

#include "api/modifier.h"
#include "spark/random.h"

namespace spark {

/// Loses percepts or actions: all of a cycle, each time with the same probability.
class Dropout : public Modifier {
  SPARK_CLASS(Dropout, Modifier)
 public:
  static void describe(Description<Dropout>& d) {
    d.doc("Loses the percept, or the actions, of some cycles.");
    d.property("probability", &Dropout::probability_)
        .range(0, 1)
        .doc("Probability that those of a cycle are lost. Cycles without any do not count.");
    d.property("random", &Dropout::random_).state().doc("State of the random numbers that decide.");
  }
  void apply(Signal& signal, const Event&) override {
    if (!signal.empty() && random_.uniform() < probability_) signal.clear();
  }

 private:
  double probability_ = 0;
  RandomStream random_{*this, "dropout"};
};

}  // namespace spark
