#pragma once
/// \file
/// What there is in a world and where it is, which the parts of a world share: WorldModel edits it, JointKinematics
/// reads it, BodyWatch and Stepper change its state in a step.

#include <algorithm>
#include <vector>

#include "api/single_precision.h"
#include "api/state.h"

namespace spark::physics {

/// A world as arrays.
struct WorldData {
  engine::Model model;
  engine::State state;
  /// Another number whenever a body was moved or the angle of a joint may have changed.
  std::uint64_t poses = 1;

  /// The state of a joint's body; nullptr: the world.
  const engine::DynamicState* stateAt(engine::Index body) const {
    return body == engine::kNone ? nullptr : &state.bodies[body];
  }
  /// As the number enters an engine: rounded in exact replay.
  template <class T>
  T rounded(const T& v) const {
    return model.exactReplay ? T(roundToFloat(v)) : v;
  }
};

/// Moves the elements of an array to their new indices; those whose new index is kNone are removed. See
/// Handles::compact().
template <class T>
void renumber(std::vector<T>& array, const std::vector<engine::Index>& now) {
  std::size_t size = 0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (now[i] == engine::kNone) continue;
    if (now[i] != i) array[now[i]] = std::move(array[i]);
    ++size;
  }
  array.resize(size);
}

/// True when the magnitudes of `n` numbers (m, m/s, rad/s) sum up to less than 1e8; false also for NaN. Larger
/// coordinates do not fit the cells of hash spaces.
inline bool inRange(const double* v, int n) {
  double sum = 0;
  for (int i = 0; i < n; ++i) sum += std::abs(v[i]);
  return sum < 1e8;
}
inline bool inRange(const Vec3& v) { return inRange(v.data(), 3); }

// What engines can compute with: the squares, products and inverses of other numbers overflow or lose all digits. A
// gnat has 1e-6 kg, a cruise ship 1e8 kg.
inline constexpr double kLeastMass = 1e-15, kMostMass = 1e15;        ///< [kg]
inline constexpr double kLeastInertia = 1e-30, kMostInertia = 1e30;  ///< about any axis [kg m^2]

/// The nearest number within +-1e30: larger forces, torques and joint parameters make engines overflow.
inline double bounded(double v) { return std::clamp(v, -1e30, 1e30); }
inline Vec3 bounded(const Vec3& v) { return v.cwiseMax(-1e30).cwiseMin(1e30); }

}  // namespace spark::physics
