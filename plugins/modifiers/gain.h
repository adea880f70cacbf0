#pragma once

#include "api/modifier.h"

namespace spark {

/// Multiplies each number by a factor: an error of scale.
class Gain : public NumberModifier {
  SPARK_CLASS(Gain, NumberModifier)
 public:
  static void describe(Description<Gain>& d) {
    d.doc("Multiplies each number by a factor.");
    d.property("gain", &Gain::gain_).unit("1").range(-kMost, kMost).doc("The factor.");
  }

 protected:
  double change(double value, std::size_t, const Event&) override { return gain_ * value; }

 private:
  double gain_ = 1;
};

}  // namespace spark
