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
      frame(0.62, {-33.4, -94.1, -100.1, 17.6}, {120, 1, -3.2, 0.2}, {-12.6, -12.9, 100, -130}, {-3.2, -10.1, -25, -79.9}),
      frame(0.30, {-42.8, -95, -120, 24.1}, {120, -27.5, -55.4, 10.4}, {1, -24.9, 58.6, 1}, {1, 25, -25, -32.1}),
      frame(0.55, {14.7, 1, -22.2, 76.4}, {120, -57.2, -16.3, -1}, {1, 25, 0.5, -8.9}, {1, 25, -15.4, -49.5}),
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
