#include "legs.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

// The joints of a leg: hip yaw (about an axis slanted by 45 degrees), hip roll and hip pitch at one point, knee, ankle
// pitch and roll:
//
//     foot = Ry(-s 45) Rz(s yaw) Ry(s 45) . Ry(hip roll) Rx(hip pitch) Rx(knee) Rx(ankle pitch) Ry(ankle roll)
//
// with s = 1 for the right leg, -1 for the left.
//
// The position of the hip in the frame of the sole determines ankle and knee; the hip joints make the rest of the
// rotation.

namespace humanoid {

namespace {
Mat3 about(int axis, double rad) { return Eigen::AngleAxisd(rad, Vec3::Unit(axis)).toRotationMatrix(); }
}  // namespace

double legLength(const Build& build) { return build.thigh + build.shank + kSole; }

void placeFoot(const Build& build, bool right, const Foot& foot, Pose& pose) {
  const double slant = right ? kPi / 4 : -kPi / 4;
  const Mat3 rotation = about(2, foot.yaw) * about(0, foot.pitch) * about(1, foot.roll);
  Vec3 hip = rotation.transpose() * -foot.place - Vec3(0, 0, kSole);  // relative to the ankle, in the frame of the foot

  const double thigh = std::hypot(build.thigh, kKneeForward), bend = std::atan2(kKneeForward, build.thigh);
  const double reach = thigh + build.shank - 1e-6;
  if (hip.norm() > reach) hip *= reach / hip.norm();
  const double roll = std::atan2(-hip.x(), hip.z());
  const Vec3 level = about(1, roll) * hip;
  const double cosine = (level.squaredNorm() - thigh * thigh - build.shank * build.shank) / (2 * thigh * build.shank);
  const double knee = bend - std::acos(std::clamp(cosine, -1.0, 1.0));
  const Vec3 straight = Vec3(0, 0, build.shank) + about(0, -knee) * Vec3(0, -kKneeForward, build.thigh);
  const double ankle = std::atan2(straight.z(), straight.y()) - std::atan2(level.z(), level.y());

  const Mat3 atHip = about(1, slant) * rotation * about(1, -roll) * about(0, -ankle - knee);
  const double yaw = std::atan2(atHip(1, 0), atHip(0, 0));
  const double hipRoll = std::asin(std::clamp(-atHip(2, 0), -1.0, 1.0)) - slant;
  const double hipPitch = std::atan2(atHip(2, 1), atHip(2, 2));

  const std::array<double, 6> angles{right ? yaw : -yaw, hipRoll, hipPitch, knee, ankle, roll};
  const std::size_t first = index(right ? Joint::rHipYaw : Joint::lHipYaw);
  for (std::size_t i = 0; i < angles.size(); ++i)
    pose.at(first + i) = std::clamp(angles[i], kJointFacts[first + i].low, kJointFacts[first + i].high);
}

}  // namespace humanoid
