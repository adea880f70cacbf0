#include "get_up.h"

#include <algorithm>

namespace humanoid {

namespace {
constexpr double kHold = 0.3;  // of the first frame [s]
constexpr double kMost = 25;   // maximum correction of the ankles [deg]

/// Joints about the vertical and the forward axis have the opposite sign on the left side.
void apply(const Keyframe& k, Pose& pose) {
  const auto alike = [&pose](Joint right, Joint left, double deg) { pose[right] = pose[left] = radians(deg); };
  const auto mirrored = [&pose](Joint right, Joint left, double deg) {
    pose[right] = radians(deg);
    pose[left] = -pose[right];
  };
  alike(Joint::rShoulderPitch, Joint::lShoulderPitch, k.shoulderPitch);
  mirrored(Joint::rShoulderYaw, Joint::lShoulderYaw, -k.shoulderOut);
  mirrored(Joint::rArmRoll, Joint::lArmRoll, k.armRoll);
  mirrored(Joint::rElbow, Joint::lElbow, k.elbow);
  alike(Joint::rHipYaw, Joint::lHipYaw, k.hipYaw);
  mirrored(Joint::rHipRoll, Joint::lHipRoll, -k.legOut);
  alike(Joint::rHipPitch, Joint::lHipPitch, k.hipPitch);
  alike(Joint::rKnee, Joint::lKnee, k.knee);
  alike(Joint::rAnklePitch, Joint::lAnklePitch, k.ankle);
  mirrored(Joint::rAnkleRoll, Joint::lAnkleRoll, k.legOut);
  alike(Joint::rToe, Joint::lToe, 0);
}
}  // namespace

void GetUp::start(const Movement& movement, const Pose& from) {
  movement_ = &movement;
  frame_ = 0;
  time_ = 0;
  from_ = to_ = from;
  apply(movement.frames[0], to_);
}

void GetUp::step(const Percepts& percepts, const Posture& posture, Pose& pose) {
  const std::size_t count = movement_->frames.size();
  const double seconds = movement_->frames[frame_].seconds;
  time_ += kCycle;
  const double share = std::min(1.0, time_ / seconds);
  for (std::size_t i = index(Joint::rShoulderPitch); i < kJoints; ++i)
    pose.at(i) = from_.at(i) + (to_.at(i) - from_.at(i)) * share;

  // In the last two frames the ankles control the lean of the torso.
  if (frame_ + 2 >= count) {
    const double wanted =
        movement_->squatLean + (frame_ + 1 == count ? (movement_->endLean - movement_->squatLean) * share : 0);
    const double off = degrees(posture.forward()) - wanted, rate = -degrees(percepts.gyro.x());
    const double correction = radians(std::clamp(movement_->straighten * off + movement_->damp * rate, -kMost, kMost));
    pose[Joint::rAnklePitch] -= correction;
    pose[Joint::lAnklePitch] -= correction;
  }
  if (time_ < seconds + (frame_ == 0 ? kHold : 0) - 0.5 * kCycle) return;
  time_ = 0;
  if (++frame_ == count) return stop();
  from_ = to_;
  apply(movement_->frames[frame_], to_);
}

}  // namespace humanoid
