#include "recovery.h"

#include <algorithm>
#include <cmath>

namespace humanoid {

namespace {
constexpr double kPrepare = 0.4, kSquat = 1.6, kSteady = 0.16;  // s

void bothLegs(Pose& pose, double hip, double knee, double ankle) {
  pose[Joint::rHipPitch] = pose[Joint::lHipPitch] = radians(hip);
  pose[Joint::rKnee] = pose[Joint::lKnee] = radians(knee);
  pose[Joint::rAnklePitch] = pose[Joint::lAnklePitch] = radians(ankle);
}
void bothArms(Pose& pose, double shoulder) { pose[Joint::rShoulderPitch] = pose[Joint::lShoulderPitch] = radians(shoulder); }
}  // namespace

void Recovery::start(const Pose& from, const Pose& stance, double pace) {
  pace_ = pace;
  stance_ = stance;
  enter(Phase::prepare, from);
}

void Recovery::enter(Phase phase, const Pose& pose) {
  phase_ = phase;
  time_ = settled_ = 0;
  from_ = to_ = pose;
  switch (phase) {
    case Phase::prepare:
      to_ = Pose{};
      bothArms(to_, tuning_.pikeArms);
      to_[Joint::rShoulderYaw] = radians(-tuning_.armsOut);
      to_[Joint::lShoulderYaw] = -to_[Joint::rShoulderYaw];
      to_[Joint::rElbow] = radians(tuning_.elbow);
      to_[Joint::lElbow] = -to_[Joint::rElbow];
      break;
    case Phase::pike:
      bothLegs(to_, tuning_.pikeHip, tuning_.pikeKnee, tuning_.pikeAnkle);
      break;
    case Phase::fold:
      bothLegs(to_, tuning_.squatHip, tuning_.squatKnee, tuning_.squatAnkle);
      bothArms(to_, tuning_.foldArms);
      break;
    case Phase::rise:
      to_ = stance_;
      break;
    default:
      break;
  }
}

void Recovery::blend(double seconds, Pose& pose) const {
  const double share = std::min(1.0, time_ / seconds);
  for (std::size_t i = index(Joint::rShoulderPitch); i < kJoints; ++i) pose.at(i) = from_.at(i) + (to_.at(i) - from_.at(i)) * share;
}

void Recovery::step(const Percepts& percepts, const Posture& posture, Pose& pose) {
  time_ += kCycle;
  const double lean = degrees(posture.forward()), rate = -degrees(percepts.gyro.x());
  switch (phase_) {
    case Phase::prepare:
      blend(kPrepare, pose);
      if (time_ >= kPrepare) enter(Phase::pike, pose);
      return;
    case Phase::pike:
      blend(tuning_.pike / pace_, pose);
      if (time_ >= tuning_.pike / pace_) enter(Phase::fold, pose);
      return;
    case Phase::fold:
      blend(tuning_.fold / pace_, pose);
      if (time_ >= tuning_.fold / pace_) enter(Phase::squat, pose);
      return;
    case Phase::squat:
      return squat(lean, rate, pose);
    case Phase::rise: {
      blend(tuning_.rise, pose);
      const double share = std::min(1.0, time_ / tuning_.rise), wanted = tuning_.squatLean * (1 - share);
      const double correction = radians(std::clamp(tuning_.straighten * (lean - wanted) + tuning_.damp * rate, -25.0, 25.0));
      pose[Joint::rAnklePitch] -= correction;
      pose[Joint::lAnklePitch] -= correction;
      if (time_ >= tuning_.rise + 0.3 || posture.tilt() > radians(75)) phase_ = Phase::done;
      return;
    }
    case Phase::done:
      return;
  }
}

/// Leaning where it should, soon: what the swing makes of the lean within some cycles counts.
void Recovery::squat(double lean, double rate, Pose& pose) {
  const double soon = lean + 0.1 * rate;
  const bool forward = soon > tuning_.squatLean;
  const double ankle = towards(degrees(pose[Joint::rAnklePitch]), forward ? tuning_.backAnkle : tuning_.squatAnkle, 6);
  bothLegs(pose, tuning_.squatHip, tuning_.squatKnee, ankle);
  bothArms(pose, towards(degrees(pose[Joint::rShoulderPitch]), forward ? tuning_.backArms : tuning_.frontArms, 6));
  settled_ = std::abs(soon - tuning_.squatLean) < 12 && std::abs(rate) < 80 ? settled_ + kCycle : 0;
  if (settled_ >= kSteady) return enter(Phase::rise, pose);
  if (time_ >= kSquat) phase_ = Phase::done;
}

}  // namespace humanoid
