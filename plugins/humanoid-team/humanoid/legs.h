#pragma once
/// \file
/// Inverse kinematics of the legs.

#include "nao.h"
#include "percepts.h"

namespace humanoid {

/// Pose of a sole relative to its hip. Parallel to the torso's ground plane unless tilted.
struct Foot {
  Vec3 place = Vec3::Zero();  ///< m from the hip to the sole below the ankle, torso frame
  double yaw = 0;             ///< rad, positive turns the toes to the left
  double pitch = 0,
         roll = 0;  ///< rad about x and y of the torso: positive lifts the toes, and the side to the left of the foot
};

/// Sets the six joint angles of a leg so that the sole has this pose. If the pose is out of reach, the leg is stretched
/// in that direction. `right`: the right leg, else the left.
void placeFoot(const Build& build, bool right, const Foot& foot, Pose& pose);
/// Distance from hip to sole of a straight leg [m].
double legLength(const Build& build);

}  // namespace humanoid
