#pragma once

#include <algorithm>
#include <cmath>

#include "api/modifier.h"

namespace spark {

/// Limits each number to a range.
class Saturation : public NumberModifier {
  SPARK_CLASS(Saturation, NumberModifier)
 public:
  static void describe(Description<Saturation>& d) {
    d.doc("Limits each number to a range.");
    constexpr double kAny = HUGE_VAL;  // infinities, too, but not NaN
    d.property("least", &Saturation::least_)
        .unit("of the number")
        .range(-kAny, kAny)
        .doc("Smaller numbers become this one.");
    d.property("most", &Saturation::most_)
        .unit("of the number")
        .range(-kAny, kAny)
        .doc("Larger numbers become this one.");
  }

 protected:
  double change(double value, std::size_t, const Event&) override { return std::min(std::max(value, least_), most_); }

 private:
  double least_ = -HUGE_VAL, most_ = HUGE_VAL;
};

}  // namespace spark
