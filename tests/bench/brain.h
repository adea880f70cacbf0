#pragma once
/// \file
/// The bench's agents: they load a robot, take a place, and then move by numbers that the raw side knows as well.

#include <cmath>
#include <string>
#include <vector>

#include "api/agents.h"

namespace spark::bench {

/// What motor `i` of an agent is told in its n-th cycle [rad/s]: slow swings, each with a phase of its own.
inline double motorSpeed(std::size_t i, std::int64_t n) { return 0.8 * std::sin(0.06 * static_cast<double>(n) + 0.7 * static_cast<double>(i)); }
/// How hard sphere `i` drives in its n-th cycle, per axis.
inline double drivePower(std::size_t i, std::int64_t n, int axis) {
  const double angle = 0.02 * static_cast<double>(n) + 0.9 * static_cast<double>(i);
  return 60 * (axis == 0 ? std::cos(angle) : std::sin(angle));
}

/// An agent inside the host that thinks as little as possible.
class BenchBrain : public Behavior {
  SPARK_CLASS(BenchBrain, Behavior)
 public:
  static void describe(Description<BenchBrain>& d) { d.doc("An agent for measurements."); }

  std::size_t index = 0;            ///< number among the agents, from 0
  std::string scene;                ///< its robot
  int type = -1;                    ///< the robot file's argument; below 0: none
  double place[2] = {0, 0};         ///< where it goes before kick-off [m]
  std::vector<std::string> motors;  ///< predicates to drive; empty: stand still
  bool drives = false;              ///< a sphere that is to drive
  std::int64_t cycle = 0;           ///< counts from when it began to move

  void start(Predicates& actions) override {
    actions.open("scene").add(scene);
    if (type >= 0) actions.add(type);
    actions.close();
  }
  void think(const Predicates&, Predicates& actions) override {
    ++thoughts_;
    if (thoughts_ == 1) {
      actions.open("init").pair("unum", static_cast<int>(index % 11) + 1).pair("teamname", index < 11 ? "Left" : "Right").close();
    } else if (thoughts_ == 4) {
      actions.open("beam").add(place[0]).add(place[1]).add(0.0).close();
    }
    if (!drives && motors.empty()) return;
    ++cycle;
    for (std::size_t i = 0; i < motors.size(); ++i) actions.open(motors[i]).add(motorSpeed(i, cycle)).close();
    if (drives) actions.open("drive").add(drivePower(index, cycle, 0)).add(drivePower(index, cycle, 1)).add(0.0).close();
  }

 private:
  int thoughts_ = 0;
};

}  // namespace spark::bench
