#include "keyframes.h"

namespace humanoid {

namespace {
struct Arm {
  double pitch, yaw, roll, elbow;
};
struct Leg {
  double yaw, roll, pitch, knee;
};

Keyframe frame(double seconds, const Arm& rightArm, const Arm& leftArm, const Leg& rightLeg, const Leg& leftLeg) {
  Keyframe f{seconds, {}};
  const auto add = [&f](Side side, const Arm& arm, const Leg& leg) {
    f.angles.insert(f.angles.end(), {{side, Joint::rShoulderPitch, arm.pitch},
                                     {side, Joint::rShoulderYaw, arm.yaw},
                                     {side, Joint::rArmRoll, arm.roll},
                                     {side, Joint::rElbow, arm.elbow},
                                     {side, Joint::rHipYaw, leg.yaw},
                                     {side, Joint::rHipRoll, leg.roll},
                                     {side, Joint::rHipPitch, leg.pitch},
                                     {side, Joint::rKnee, leg.knee}});
  };
  add(Side::right, rightArm, rightLeg);
  add(Side::left, leftArm, leftLeg);
  return f;
}
}  // namespace

// The right arm pushes against the ground behind the back while the right leg swings across. Found by a search in simulation.
const Movement& rollOver() {
  static const Movement movement{
      frame(0.53, {-15, -95, -99, 10}, {120, 1, -65, 18}, {-7, -30, 100, -110}, {-16, -2, -25, -126}),
      frame(0.31, {-59, -95, -120, 31}, {120, -38, -44, -1}, {1, -27, 45, 1}, {1, 13, -25, -56}),
      frame(0.53, {40, 1, -3, 90}, {116, -6, -40, -1}, {1, 25, -10, -60}, {1, 25, -25, -69}),
      frame(0.5, {0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}),
  };
  return movement;
}

// The arm that he lies on pushes against the ground behind the back.
const Movement& tipForward() {
  static const Movement movement{
      frame(0.3, {-120, 0, 0, 0}, {-120, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}),
      frame(0.4, {-120, -95, 0, 0}, {-120, -95, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}),
      frame(0.4, {-120, 0, 0, 0}, {-120, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}),
      frame(0.3, {0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}),
  };
  return movement;
}

}  // namespace humanoid
