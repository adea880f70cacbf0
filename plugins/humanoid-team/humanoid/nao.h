#pragma once
/// \file
/// Model of the Nao: joints with their names and limits, and the dimensions of its legs by robot type.

#include <algorithm>
#include <array>
#include <cstddef>
#include <numbers>
#include <string_view>

namespace humanoid {

constexpr double kPi = std::numbers::pi;
constexpr double kCycle = 0.02;  ///< time between two sense messages [s]
constexpr int kRobotTypes = 5;   ///< types are 0..4
/// Degrees to radians, and back.
constexpr double radians(double deg) { return deg * (kPi / 180); }
constexpr double degrees(double rad) { return rad * (180 / kPi); }
/// The angle normalised to [-pi, pi) [rad].
double normalized(double rad);
/// `from`, changed towards `to` by at most `by`.
inline double towards(double from, double to, double by) { return from + std::clamp(to - from, -by, by); }

/// The joints of all types, in the order of the percepts. Only type 4 has toes.
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

/// One number per joint: angles [rad] or speeds [rad/s].
struct Pose : std::array<double, kJoints> {
  double& operator[](Joint j) { return at(index(j)); }
  double operator[](Joint j) const { return at(index(j)); }
};

/// Names and limits of a joint.
struct JointFacts {
  std::string_view perceptor, effector;  ///< names in messages
  double low, high;                      ///< stops [rad]
};
/// By index().
extern const std::array<JointFacts, kJoints> kJointFacts;

/// Dimensions and speeds in which the types differ. Lengths in m.
struct Build {
  double hipX;                             ///< lateral distance of the hip from the centre of the torso
  double thigh, shank;                     ///< hip to knee, knee to ankle
  double anklePitchSpeed, ankleRollSpeed;  ///< maximum [rad/s]
  bool toes;
  double armsOut;  ///< angle of hanging arms away from the body, so that they do not touch the thighs [rad]
};
/// The build of a type, 0..4.
const Build& buildOf(int type);
/// Maximum speed of a joint [rad/s].
double topSpeed(const Build& build, Joint j);
constexpr double kSole = 0.05;          ///< from the ankle down to the sole [m]
constexpr double kKneeForward = 0.005;  ///< offset of the knee in front of the hip when the leg is straight [m]
constexpr double kCameraHeight =
    0.155;  ///< from the centre of the torso up to that of the head, where the camera is [m]

/// Robot types of a team of eleven, by uniform number 1..11: within the league's limits (at most 7 of a type, 9 of two,
/// at least 3 types). All five types play; the goalie is of the widest type, which falls most easily when pushed.
int robotType(int unum);

}  // namespace humanoid
