#pragma once

#include <vector>

#include "api/modifier.h"
#include "spark/random.h"

namespace spark {

/// Adds an offset that stays the same: `mean`, and for each number an error of calibration that is drawn once.
class Bias : public NumberModifier {
  SPARK_CLASS(Bias, NumberModifier)
 public:
  static void describe(Description<Bias>& d) {
    d.doc("Adds a constant offset to each number, which may be drawn once from a normal distribution.");
    d.property("mean", &Bias::mean_).unit("of the number").range(-kMost, kMost).doc("Mean of the offsets.");
    d.property("sigma", &Bias::sigma_)
        .unit("of the number")
        .range(0, kMost)
        .doc("Standard deviation of the offsets; 0: all are the mean.");
    d.property("random", &Bias::random_).state().doc("State of the random numbers of the offsets.");
  }

 protected:
  bool adds() const override { return true; }
  double change(double value, std::size_t index, const Event&) override {
    while (drawn_.size() <= index) drawn_.push_back(random_.normal());
    return value + mean_ + sigma_ * drawn_[index];
  }
  void saveState(StateWriter& out) const override {
    out.write(drawn_.size());
    for (const double offset : drawn_) out.write(offset);
  }
  void loadState(StateReader& in) override {
    drawn_.resize(static_cast<std::size_t>(in.readInteger()));
    for (double& offset : drawn_) offset = in.readNumber();
  }

 private:
  double mean_ = 0, sigma_ = 0;
  std::vector<double> drawn_;  ///< the offset of each number, in units of sigma from the mean
  RandomStream random_{*this, "bias"};
};

}  // namespace spark
