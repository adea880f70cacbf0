#pragma once

#include <algorithm>
#include <vector>

#include "api/modifier.h"

namespace spark {

/// The play of a gear. The output is within half a width of the input, and moves only as far as the input pushes it:
///
///     input    0 ─► 2 ─► 1 ─► 0 ─► -1      of a gap 2 wide, at first in its middle
///     output   0    1    1    1     0
class Backlash : public NumberModifier {
  SPARK_CLASS(Backlash, NumberModifier)
 public:
  static void describe(Description<Backlash>& d) {
    d.doc("Play between each number and what becomes of it: a change of direction first has to cross a gap.");
    d.property("width", &Backlash::width_)
        .unit("of the number")
        .range(0, kMost)
        .doc("Width of the gap; the first number is in its middle.");
  }

 protected:
  double change(double value, std::size_t index, const Event&) override {
    while (outputs_.size() <= index) outputs_.push_back(value);
    double& output = outputs_[index];
    return output = std::min(std::max(output, value - width_ / 2), value + width_ / 2);
  }
  void saveState(StateWriter& out) const override {
    out.write(outputs_.size());
    for (const double output : outputs_) out.write(output);
  }
  void loadState(StateReader& in) override {
    outputs_.resize(static_cast<std::size_t>(in.readInteger()));
    for (double& output : outputs_) output = in.readNumber();
  }

 private:
  double width_ = 0;
  std::vector<double> outputs_;
};

}  // namespace spark
