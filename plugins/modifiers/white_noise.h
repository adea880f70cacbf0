#pragma once

#include <cmath>

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
    d.property("relative", &WhiteNoise::relative_)
        .range(0, kMost)
        .doc("Standard deviation of a part in addition, as a fraction of the number.");
    d.property("random", &WhiteNoise::random_).state().doc("State of the noise's random numbers.");
  }

 protected:
  bool adds() const override { return true; }
  double change(double value, std::size_t, const Event&) override {
    return value + random_.normal(0, relative_ > 0 ? std::hypot(sigma_, relative_ * value) : sigma_);
  }

 private:
  double sigma_ = 0, relative_ = 0;
  RandomStream random_{*this, "white noise"};
};

}  // namespace spark
