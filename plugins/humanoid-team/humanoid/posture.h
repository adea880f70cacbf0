#pragma once
/// \file
/// Orientation of the torso, from gyroscope and accelerometer.

#include "percepts.h"

namespace humanoid {

/// The side on which the robot lies.
enum class Lying { no, onFront, onBack, onSide };

/// Estimates the vertical direction with a complementary filter. All vectors are in the torso's frame.
class Posture {
 public:
  /// Call it for every message.
  void update(const Percepts& percepts);
  /// Resets the estimate to upright, after a beam or a move by the referee.
  void reset() { up_ = Vec3(0, 0, 1); }
  /// The vertical, a unit vector.
  const Vec3& up() const { return up_; }
  /// Lean forward and to the right [rad].
  double forward() const;
  double right() const;
  /// Angle between the torso's axis and the vertical [rad].
  double tilt() const;
  /// The side on which the robot lies, when it leans by more than 60 degrees.
  Lying lying() const;
  /// Rotation from the torso's frame to a level frame with the same heading.
  Mat3 level() const;
  template <class F>
  void fields(F& f) {
    f(up_);
  }

 private:
  Vec3 up_{0, 0, 1};
};

}  // namespace humanoid
