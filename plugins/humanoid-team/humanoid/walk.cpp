#include "walk.h"

#include <algorithm>
#include <cmath>

namespace humanoid {

namespace {
constexpr double kStartTime = 0.6;  // until the steps have their full height [s]
constexpr double kBlend = 0.2;      // from the start pose to that of the walk [s]
constexpr double kStanceHeight = 0.92, kStanceForward = 0.001, kStanceLean = 0.04,
                 kStanceSpread = -0.006;  // as in Gait; statically stable

struct Leg {
  double lift, way;  ///< height of the foot, 0..1; its position along the step, -1..1
};

/// `phase` of the leg: swing in the first half, support in the second.
Leg legAt(double phase, double pause) {
  const double t = phase - std::floor(phase);
  if (t >= 0.5) return {0, 1 - 4 * (t - 0.5)};
  const double s = std::clamp((2 * t - pause) / (1 - 2 * pause), 0.0, 1.0);
  return {0.5 - 0.5 * std::cos(2 * kPi * s), -std::cos(kPi * s)};
}

/// Converts the position of a level sole below an upright torso to the frame of a torso that leans forward.
Foot leant(const Vec3& place, double lean) {
  const double c = std::cos(lean), s = std::sin(lean);
  Foot foot;
  foot.place = Vec3(place.x(), c * place.y() - s * place.z(), s * place.y() + c * place.z());
  foot.pitch = lean;
  return foot;
}
}  // namespace

void Walk::start(const Pose& from) {
  phase_ = strength_ = blended_ = 0;
  from_ = from;
  now_ = {};
}

bool Walk::mayStop() const {
  const double toStep = std::abs(phase_ - 0.5) < 0.25 ? std::abs(phase_ - 0.5) : std::min(phase_, 1 - phase_);
  return toStep < 0.06 && std::abs(now_.forward) < 0.02 && std::abs(now_.right) < 0.02 && std::abs(now_.turn) < 0.1;
}

void Walk::stand(Pose& pose) const {
  for (const bool right : {true, false}) {
    Foot foot =
        leant({(right ? 1 : -1) * kStanceSpread, kStanceForward, -kStanceHeight * legLength(build_)}, kStanceLean);
    placeFoot(build_, right, foot, pose);
  }
}

/// `shift`: offset of both feet relative to the torso [m].
Foot Walk::footOf(bool right, double lift, double way, const Vec2& shift) const {
  const double side = right ? 1 : -1, step = gait_.period / 4, lean = gait_.lean + gait_.leanSpeed * now_.forward;
  const Vec3 place(side * gait_.spread + now_.right * step * way + shift.x(),
                   gait_.forward + gait_.forwardSpeed * now_.forward + now_.forward * step * way + shift.y(),
                   -gait_.height * legLength(build_) + gait_.lift * strength_ * lift);
  Foot foot = leant(place, lean);
  foot.pitch += sole_;
  foot.yaw = now_.turn * step * way - side * std::abs(now_.turn) * step;  // hips turn feet outwards only
  return foot;
}

void Walk::step(const Velocity& wanted, const Percepts& percepts, const Posture& posture, Pose& pose) {
  const double gain = gait_.change * kCycle;
  const double forwardWanted = std::clamp(wanted.forward, -0.6 * gait_.maxForward, gait_.maxForward);
  now_.forward =
      towards(now_.forward, forwardWanted,
              (std::abs(forwardWanted) < std::abs(now_.forward) ? gait_.brake * kCycle : gain) * gait_.maxForward);
  now_.right = towards(now_.right, std::clamp(wanted.right, -gait_.maxSide, gait_.maxSide), gain * gait_.maxSide);
  now_.turn = towards(now_.turn, std::clamp(wanted.turn, -gait_.maxTurn, gait_.maxTurn), 2 * gain * gait_.maxTurn);
  strength_ = std::min(1.0, strength_ + kCycle / kStartTime);

  const double forward = posture.forward() - gait_.lean - gait_.leanSpeed * now_.forward, right = posture.right();
  sole_ = std::clamp(gait_.soleTilt * forward - gait_.soleRate * percepts.gyro.x(), -0.3, 0.3);
  Vec2 shift(gait_.tiltRight * right + gait_.rateRight * percepts.gyro.y(),
             gait_.tiltForward * forward - gait_.rateForward * percepts.gyro.x());
  shift.x() += strength_ * gait_.sway * std::sin(2 * kPi * phase_ + gait_.swayLead);
  for (const bool isRight : {true, false}) {
    const Leg leg = legAt(isRight ? phase_ : phase_ + 0.5, gait_.pause);
    placeFoot(build_, isRight, footOf(isRight, leg.lift, leg.way, shift), pose);
  }
  blended_ = std::min(1.0, blended_ + kCycle / kBlend);
  for (std::size_t i = index(Joint::rShoulderPitch); i < kJoints; ++i)
    pose.at(i) = from_.at(i) + (pose.at(i) - from_.at(i)) * blended_;
  phase_ += kCycle / gait_.period;
  if (phase_ >= 1) phase_ -= 1;
}

}  // namespace humanoid
