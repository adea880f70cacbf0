#pragma once
/// \file
/// What the bench's agents say: they load a robot, take a number and a place, and then move by numbers that the raw
/// side knows as well.

#include <cstdint>
#include <string>
#include <string_view>

#include "worlds.h"

namespace spark::bench {

/// Humanoids come one after another, so many cycles apart: several in one place are a knot for the solver. Spheres come
/// all at once.
inline constexpr int kJoinCycles = 8;
/// Cycles from the last one's coming until they begin to move: they have reached their places and stand.
inline constexpr int kSettleCycles = 50;
/// More of them for a heap, until it has fallen together.
inline constexpr int kHeapCycles = 100;
/// Motions repeat after so many cycles: messages are written beforehand and cost nothing while it is measured.
inline constexpr int kPeriod = 100;

/// Place of a humanoid's effector in the order of commands; -1 for one that is none of the motors.
int motorIndex(std::string_view effector);
/// What motor `i` is told in its n-th cycle [rad/s], as printed: slow swings, each with a phase of its own.
double motorSpeed(int i, std::int64_t n);
/// How hard sphere `agent` drives in its n-th cycle, by axis, as printed.
double drivePower(std::size_t agent, std::int64_t n, int axis);

/// One agent's side.
class Dialogue {
 public:
  Dialogue(const World& world, std::size_t agent);
  /// Its message after `received` messages came; 0: the first, which nobody asked for. Valid until the next call.
  std::string_view say(std::int64_t received);

 private:
  std::string init() const;
  std::string beam() const;
  const World& world_;
  std::size_t agent_;
  std::int64_t begin_;  ///< messages after which it moves
  std::string text_;
};

}  // namespace spark::bench
