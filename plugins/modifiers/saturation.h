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
    d.property("least", &Saturation::least, &Saturation::setLeast)
        .unit("of the number")
        .doc("Smaller numbers become this one.");
    d.property("most", &Saturation::most, &Saturation::setMost)
        .unit("of the number")
        .doc("Larger numbers become this one.");
  }

 protected:
  double change(double value, std::size_t, const Event&) override { return std::min(std::max(value, least_), most_); }

 private:
  double least() const { return least_; }
  void setLeast(double value) { least_ = known(value); }
  double most() const { return most_; }
  void setMost(double value) { most_ = known(value); }
  /// The value, which may be infinite. Throws RefusedValue if it is NaN.
  static double known(double value) {
    if (std::isnan(value)) throw RefusedValue("expected a number or infinity, found nan");
    return value;
  }
  double least_ = -HUGE_VAL, most_ = HUGE_VAL;
};

}  // namespace spark
