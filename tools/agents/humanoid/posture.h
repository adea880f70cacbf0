#pragma once
/// \file
/// How the torso leans, from its gyroscope and accelerometer.

#include "percepts.h"

namespace humanoid {

enum class Lying { no, onFront, onBack, onSide };

/// Follows the direction that is up. Everything in the torso's frame.
class Posture {
 public:
  /// To be called for every message.
  void update(const Percepts& percepts);
  /// Starts anew, upright; after a referee or a beam set the robot up.
  void reset() { up_ = Vec3(0, 0, 1); }
  /// Unit vector.
  const Vec3& up() const { return up_; }
  /// rad, positive: leans forward; to the right.
  double forward() const;
  double right() const;
  /// rad between the torso's axis and the vertical.
  double tilt() const;
  /// Which side the robot lies on when it leans by more than 60 degrees.
  Lying lying() const;
  /// From torso frame to a level frame with the same heading.
  Mat3 level() const;

 private:
  Vec3 up_{0, 0, 1};
};

}  // namespace humanoid
