#include "nao.h"

#include <cmath>

namespace humanoid {

double normalized(double rad) {
  const double r = std::fmod(rad + kPi, 2 * kPi);
  return (r < 0 ? r + 2 * kPi : r) - kPi;
}

namespace {
constexpr JointFacts joint(std::string_view perceptor, std::string_view effector, double lowDeg, double highDeg) {
  return {perceptor, effector, radians(lowDeg), radians(highDeg)};
}
}  // namespace

const std::array<JointFacts, kJoints> kJointFacts{{
    joint("hj1", "he1", -120, 120),   joint("hj2", "he2", -45, 45),     joint("raj1", "rae1", -120, 120),
    joint("raj2", "rae2", -95, 1),    joint("raj3", "rae3", -120, 120), joint("raj4", "rae4", -1, 90),
    joint("laj1", "lae1", -120, 120), joint("laj2", "lae2", -1, 95),    joint("laj3", "lae3", -120, 120),
    joint("laj4", "lae4", -90, 1),    joint("rlj1", "rle1", -90, 1),    joint("rlj2", "rle2", -45, 25),
    joint("rlj3", "rle3", -25, 100),  joint("rlj4", "rle4", -130, 1),   joint("rlj5", "rle5", -45, 75),
    joint("rlj6", "rle6", -25, 45),   joint("rlj7", "rle7", -1, 70),    joint("llj1", "lle1", -90, 1),
    joint("llj2", "lle2", -25, 45),   joint("llj3", "lle3", -25, 100),  joint("llj4", "lle4", -130, 1),
    joint("llj5", "lle5", -45, 75),   joint("llj6", "lle6", -45, 25),   joint("llj7", "lle7", -1, 70),
}};

const Build& buildOf(int type) {
  constexpr double usual = 6.1395;  // rad/s
  static const std::array<Build, kRobotTypes> builds{{{0.055, 0.12, 0.1, usual, usual, false, 0},
                                                      {0.055, 0.1383, 0.1183, usual, usual, false, radians(20)},
                                                      {0.055, 0.12, 0.1, 8.80667, 3.47234, false, 0},
                                                      {0.072954, 0.1479, 0.1278, usual, usual, false, radians(20)},
                                                      {0.055, 0.12, 0.1, usual, usual, true, 0}}};
  return builds.at(static_cast<std::size_t>(type));
}

double topSpeed(const Build& build, Joint j) {
  if (j == Joint::rAnklePitch || j == Joint::lAnklePitch) return build.anklePitchSpeed;
  if (j == Joint::rAnkleRoll || j == Joint::lAnkleRoll) return build.ankleRollSpeed;
  return 6.1395;
}

int robotType(int unum) {
  constexpr std::array<int, 12> types{0, 3, 4, 2, 0, 2, 0, 1, 4, 1, 4, 1};
  return types.at(static_cast<std::size_t>(std::clamp(unum, 1, 11)));
}

}  // namespace humanoid
