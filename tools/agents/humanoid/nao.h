#pragma once
/// \file
/// The Nao as its players know it: joints, their names and limits, and the lengths of its legs by robot type.

#include <algorithm>
#include <array>
#include <cstddef>
#include <numbers>
#include <string_view>

namespace humanoid {

constexpr double kPi = std::numbers::pi;
constexpr double kCycle = 0.02;  ///< s between two sense messages
constexpr int kRobotTypes = 5;   ///< types are 0..4
constexpr double radians(double deg) { return deg * (kPi / 180); }
constexpr double degrees(double rad) { return rad * (180 / kPi); }
/// The angle brought into [-pi, pi).
double normalized(double rad);
/// `from` moved towards `to` by at most `by`.
inline double towards(double from, double to, double by) { return from + std::clamp(to - from, -by, by); }

/// All joints of all types; the toes exist with type 4 only. Arms and legs of the right side first, in the order of the
/// percepts.
enum class Joint : std::size_t {
  headYaw,
  headPitch,
  rShoulderPitch,
  rShoulderYaw,
  rArmRoll,
  rElbow,
  lShoulderPitch,
  lShoulderYaw,
  lArmRoll,
  lElbow,
  rHipYaw,
  rHipRoll,
  rHipPitch,
  rKnee,
  rAnklePitch,
  rAnkleRoll,
  rToe,
  lHipYaw,
  lHipRoll,
  lHipPitch,
  lKnee,
  lAnklePitch,
  lAnkleRoll,
  lToe,
};
constexpr std::size_t kJoints = 24;
constexpr std::size_t index(Joint j) { return static_cast<std::size_t>(j); }

/// A number for each joint: angles [rad] or speeds [rad/s].
struct Pose : std::array<double, kJoints> {
  double& operator[](Joint j) { return at(index(j)); }
  double operator[](Joint j) const { return at(index(j)); }
};

struct JointFacts {
  std::string_view perceptor, effector;  ///< names in messages
  double low, high;                      ///< rad, the stops
};
extern const std::array<JointFacts, kJoints> kJointFacts;

/// What differs between the types and matters for moving. Lengths in m.
struct Build {
  double hipX;                             ///< of the hip from the torso's middle, sideways
  double thigh, shank;                     ///< hip to knee, knee to ankle
  double anklePitchSpeed, ankleRollSpeed;  ///< rad/s, highest
  bool toes;
  double armsOut;  ///< rad away from the body, so that hanging arms keep clear of the thighs
};
/// `type`: 0..4.
const Build& buildOf(int type);
/// rad/s, highest speed of a joint of that build.
double topSpeed(const Build& build, Joint j);
constexpr double kSole = 0.05;           ///< m from the ankle down to the sole
constexpr double kKneeForward = 0.005;   ///< m that the knee is before the hip when the leg is straight
constexpr double kCameraHeight = 0.155;  ///< m from the torso's middle up to the head's, where the camera is

/// Robot types of a team of eleven, by uniform number 1..11: within the league's limits (at most 7 of a type, 9 of two,
/// at least 3 types). All five types play; the widest, which others knock over most easily, keeps the goal.
int robotType(int unum);

}  // namespace humanoid
