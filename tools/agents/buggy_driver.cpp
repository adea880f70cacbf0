#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "team.h"

// Drives the buggy of buggy.lua round its course: it steers to the freer side, and brakes before walls.

namespace {
using spark::Element;
using spark::Predicates;

class Driver : public spark::agent::Player {
 public:
  explicit Driver(int speed) : speed_(speed) {}
  void start(Predicates& actions) override { actions.open("syn").close(); }
  void think(const Predicates& percepts, Predicates& actions) override {
    for (const Element percept : percepts)
      if (percept.head() == "LDR") look(percept);
    if (free_.size() < 3) return;
    ++seen_;
    const std::size_t half = free_.size() / 2;
    double right = 0, left = 0;
    for (std::size_t i = 0; i < half; ++i) right += free_[i], left += free_[free_.size() - 1 - i];
    const double angle =
        std::clamp(kTurn * (right - left) / static_cast<double>(half), -kMostAngle, kMostAngle);  // to the right
    const double speed = speed_ * (1 - kCaution * std::max(0.0, 1 - free_[half] / kFar));
    for (const char* wheel : {"lb", "rb"}) actions.open(wheel).add(speed).close();
    for (const char* wheel : {"lf", "rf"}) actions.open(wheel).add(angle).close();
  }
  bool placed() const override { return seen_ > 0; }
  std::string name() const override { return "buggy"; }
  std::string result() const override { return fmt::format("{} scans", seen_); }

 private:
  static constexpr double kTurn = 20, kMostAngle = 40, kCaution = 0.5, kFar = 8;  // deg/m, deg, m
  /// `(LDR (n scan) (d 2.31 2.30 ...))`, from right to left.
  void look(const Element& percept) {
    for (const Element part : percept) {
      if (part.head() != "d") continue;
      free_.clear();
      for (std::size_t i = 1; const Element distance = part.at(i); ++i) free_.push_back(distance.number());
    }
  }
  const double speed_;  ///< of the wheels on a free road [deg/s]
  std::vector<double> free_;
  std::int64_t seen_ = 0;
};
}  // namespace

int main(int argc, char** argv) {
  spark::agent::TeamProgram program("buggy-driver", "Drives the buggy of buggy.lua round its course.", 1);
  int speed = 800;
  program.addNumber("--speed", speed, 0, 5000, "Of the wheels on a free road, in deg/s");
  return program.run(argc, argv, [&](int) { return std::make_unique<Driver>(speed); });
}
