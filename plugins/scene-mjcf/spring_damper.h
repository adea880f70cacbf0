#pragma once
/// \file
/// Springs and dampers that are given by a time constant and a damping ratio.

#include "robot/model.h"

namespace spark::mjcf {

/// Sets stiffness and damping of the joints that have a Joint::springDamper, from the inertia that each joint feels in
/// the pose of the file (MuJoCo's documentation, "joint/springdamper"). Trees with more than kMaxCoordinates
/// coordinates are reported as unsupported.
void setSpringDampers(Model& model, Unsupported& unsupported);
inline constexpr int kMaxCoordinates = 1000;

}  // namespace spark::mjcf
