#include "keyframes.h"

#include <algorithm>

namespace humanoid {

namespace {
/// These joints turn the other way on the left side.
bool turnsAway(Joint j) {
  return j == Joint::rShoulderYaw || j == Joint::rArmRoll || j == Joint::rElbow || j == Joint::rHipRoll || j == Joint::rAnkleRoll;
}

Joint leftOf(Joint j) { return static_cast<Joint>(index(j) + (j <= Joint::rElbow ? 4 : 7)); }
}  // namespace

void apply(const Keyframe& frame, bool mirrored, Pose& pose) {
  for (const Angle& a : frame.angles) {
    if (a.joint <= Joint::headPitch) {
      pose[a.joint] = radians(a.deg);
      continue;
    }
    const bool right = a.side == Side::both || (a.side == Side::right) != mirrored, left = a.side == Side::both || !right;
    if (right) pose[a.joint] = radians(a.deg);
    if (left) pose[leftOf(a.joint)] = radians(turnsAway(a.joint) ? -a.deg : a.deg);
  }
}

void Player::start(const Movement& movement, const Pose& from, bool mirrored) {
  movement_ = &movement;
  mirrored_ = mirrored;
  frame_ = 0;
  time_ = 0;
  from_ = to_ = from;
  next();
}

void Player::next() {
  if (frame_ == movement_->size()) return stop();
  from_ = to_;
  apply((*movement_)[frame_], mirrored_, to_);
  time_ = 0;
}

void Player::step(Pose& pose) {
  if (!movement_) return;
  const double length = (*movement_)[frame_].seconds;
  time_ += kCycle;
  const double share = length > 0 ? std::min(1.0, time_ / length) : 1;
  for (std::size_t i = 0; i < kJoints; ++i) pose.at(i) = from_.at(i) + (to_.at(i) - from_.at(i)) * share;
  if (time_ >= length - 0.5 * kCycle) {
    ++frame_;
    next();
  }
}

}  // namespace humanoid
