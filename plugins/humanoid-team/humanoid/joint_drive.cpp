#include "joint_drive.h"

#include <algorithm>

namespace humanoid {

void JointDrive::drive(const Pose& wanted, const Pose& measured, double share, spark::Predicates& out) {
  for (std::size_t i = 0; i < kJoints; ++i) {
    const auto joint = static_cast<Joint>(i);
    if (!build_.toes && (joint == Joint::rToe || joint == Joint::lToe)) continue;
    const double soon = measured.at(i) + underWay_.at(i) * kCycle;
    const double top = topSpeed(build_, joint);
    underWay_.at(i) = std::clamp((wanted.at(i) - soon) * share / kCycle, -top, top);
    out.open(kJointFacts[i].effector).add(underWay_.at(i)).close();
  }
}

}  // namespace humanoid
