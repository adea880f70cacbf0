#pragma once
/// \file
/// The messages of the benchmark's agents. They load a robot, choose a number and a position, and then move with speeds
/// that the raw side uses as well.

#include <cstdint>
#include <string>
#include <string_view>

#include "worlds.h"

namespace spark::bench {

/// Cycles between two humanoids that join: humanoids at the same position would overlap and load the solver. Spheres
/// join all at once.
inline constexpr int kJoinCycles = 8;
/// Cycles from the last agent's joining until they begin to move: by then they have their positions and stand.
inline constexpr int kSettleCycles = 50;
/// Additional cycles for a heap until it has collapsed.
inline constexpr int kHeapCycles = 100;
/// Period of the motions in cycles. Their messages are prepared in advance and cost nothing during the measurement.
inline constexpr int kPeriod = 100;

/// Index of a humanoid's effector in the order of commands; -1 if it is not a motor.
int motorIndex(std::string_view effector);
/// Commanded speed of motor `i` in its n-th cycle [rad/s], rounded as printed: slow swings with different phases.
double motorSpeed(int i, std::int64_t n);
/// Drive power of sphere `agent` in its n-th cycle, by axis, rounded as printed.
double drivePower(std::size_t agent, std::int64_t n, int axis);

/// The messages of one agent.
class Dialogue {
 public:
  Dialogue(const World& world, std::size_t agent);
  /// The message to send after `received` messages; 0: the first one, which is sent at once. Valid until the next call.
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
