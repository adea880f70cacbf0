#pragma once

#include "api/modifier.h"
#include "spark/random.h"

namespace spark {

/// Adds normally distributed noise, independent for each number and cycle.
class WhiteNoise : public NumberModifier {
  SPARK_CLASS(WhiteNoise, NumberModifier)
 public:
  static void describe(Description<WhiteNoise>& d) {
    d.doc("Adds normally distributed noise to each number, anew in each cycle.");
    d.property("sigma", &WhiteNoise::sigma_).unit("of the number").range(0, kMost).doc("Standard deviation.");
    d.property("random", &WhiteNoise::random_).state().doc("State of the noise's random numbers.");
  }

 protected:
  double change(double value, std::size_t, const Event&) override { return value + random_.normal(0, sigma_); }

 private:
  double sigma_ = 0;
  RandomStream random_{*this, "white noise"};
};

}  // namespace spark
