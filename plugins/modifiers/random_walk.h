#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "api/modifier.h"
#include "spark/random.h"

namespace spark {

/// Adds an offset that drifts: a Wiener process for each number, whose variance grows by sigma² in each second of
/// simulated time, whatever the interval of the perceptor. It is 0 when the number comes first.
class RandomWalk : public NumberModifier {
  SPARK_CLASS(RandomWalk, NumberModifier)
 public:
  static void describe(Description<RandomWalk>& d) {
    d.doc("Adds an offset to each number that begins at 0 and drifts, as the bias of a gyroscope does.");
    d.property("sigma", &RandomWalk::sigma_)
        .unit("of the number / sqrt(s)")
        .range(0, kMost)
        .doc("Standard deviation of the drift in one second; in t seconds it is sqrt(t) times that.");
    d.property("random", &RandomWalk::random_).state().doc("State of the drift's random numbers.");
  }

 protected:
  bool adds() const override { return true; }
  double change(double value, std::size_t index, const Event& event) override {
    while (walks_.size() <= index) walks_.push_back({0, event.time});
    Walk& walk = walks_[index];
    // A number that comes twice in a cycle, as of two objects in one list, has one offset.
    if (const double passed = event.time - std::exchange(walk.time, event.time); passed > 0)
      walk.offset += random_.normal(0, sigma_ * std::sqrt(passed));
    return value + walk.offset;
  }
  void saveState(StateWriter& out) const override {
    out.write(walks_.size());
    for (const Walk& walk : walks_) out.write(walk.offset), out.write(walk.time);
  }
  void loadState(StateReader& in) override {
    walks_.resize(static_cast<std::size_t>(in.readInteger()));
    for (Walk& walk : walks_) walk.offset = in.readNumber(), walk.time = in.readNumber();
  }

 private:
  struct Walk {
    double offset, time;  // [s]
  };
  double sigma_ = 0;
  std::vector<Walk> walks_;
  RandomStream random_{*this, "random walk"};
};

}  // namespace spark
