#pragma once

#include <algorithm>
#include <vector>

#include "api/modifier.h"

namespace spark {

/// The play of a gear: the output follows the input only when the input has moved through the gap.
///
///     input            ┌──────┐
///     ─────────────────┤      ├────   the output is anywhere in [input - width / 2, input + width / 2]
///     output               │          and moves only when the input pushes it
class Backlash : public NumberModifier {
  SPARK_CLASS(Backlash, NumberModifier)
 public:
  static void describe(Description<Backlash>& d) {
    d.doc("Play between each number and what becomes of it: a change of direction first has to cross a gap.");
    d.property("width", &Backlash::width_)
        .unit("of the number")
        .min(0)
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
