#pragma once
/// \file
/// From where a foot should be to the angles of its leg.

#include "nao.h"
#include "percepts.h"

namespace humanoid {

/// Where a sole is below its hip. The sole is level with the torso unless tilted.
struct Foot {
  Vec3 place = Vec3::Zero();  ///< m from the hip to the sole below the ankle, torso frame
  double yaw = 0;             ///< rad, positive turns the toes to the left
  double pitch = 0,
         roll = 0;  ///< rad about x and y of the torso: positive lifts the toes, and the side to the left of the foot
};

/// Sets the six joints of a leg so that the sole gets there; out of reach the leg is straight in that direction.
/// `right`: which leg.
void placeFoot(const Build& build, bool right, const Foot& foot, Pose& pose);
/// m, from hip to sole of a straight leg.
double legLength(const Build& build);

}  // namespace humanoid
