#pragma once

#include <cmath>

#include "api/modifier.h"

namespace spark {

/// Rounds each number to the nearest multiple of a step, as an encoder or an analog-to-digital converter does.
class Quantization : public NumberModifier {
  SPARK_CLASS(Quantization, NumberModifier)
 public:
  static void describe(Description<Quantization>& d) {
    d.doc("Rounds each number to the nearest multiple of a step.");
    d.property("step", &Quantization::step_)
        .unit("of the number")
        .range(0, kMost)
        .doc("The step; 0: numbers stay as they are.");
  }

 protected:
  double change(double value, std::size_t, const Event&) override {
    return step_ > 0 ? std::round(value / step_) * step_ : value;
  }

 private:
  double step_ = 0;
};

}  // namespace spark
