#pragma once
/// \file
/// A walk in all directions: the legs swing in turn while the torso sways over the standing foot.

#include "legs.h"
#include "posture.h"

namespace humanoid {

/// How a type of robot walks. Lengths in m, angles in rad.
struct Gait {
  double period = 0.5;    ///< s, two steps
  double height = 0.93;   ///< of the hips above the soles, in parts of a straight leg
  double lift = 0.025;    ///< of a swinging foot
  double pause = 0.1;     ///< part of a step in which both feet stand, at its begin and end
  double sway = 0.02;     ///< of the torso to each side
  double swayLead = 0.3;  ///< rad by which the sway is ahead of the legs
  double spread = 0.0;    ///< of the feet, each further out than its hip
  double forward = 0.0;   ///< of the feet before the hips
  double lean = 0.05;     ///< of the torso, forward
  double tiltForward = 0, rateForward = 0, tiltRight = 0, rateRight = 0;  ///< m of feet for a rad of lean, for a rad/s
  double maxForward = 0.3, maxSide = 0.1, maxTurn = 0.8;                  ///< m/s, m/s, rad/s
  double change = 0.5;                     ///< 1/s: part of the highest speed that may be gained in a second
  double brake = 0.5;                      ///< the same, lost
  double leanSpeed = 0, forwardSpeed = 0;  ///< more lean and feet further forward for a m/s
  double soleTilt = 0, soleRate = 0;       ///< of the soles' pitch for a rad of lean, for a rad/s
  double share = 0.8;                      ///< of the way left that a joint makes in a cycle
};
/// The gait that suits a type, 0..4.
const Gait& gaitOf(int type);

/// Which way to walk, as the robot sees it.
struct Velocity {
  double forward = 0, right = 0, turn = 0;  ///< m/s, m/s, rad/s; turn is positive to the left
};

class Walk {
 public:
  Walk(const Build& build, const Gait& gait) : build_(build), gait_(gait) {}
  /// Starts with steps on the spot that grow. `from`: the pose of the whole body now.
  void start(const Pose& from);
  /// One cycle further. `pose`: the arms' angles as they should be, to which the legs' are added. Speeds beyond the
  /// gait's are cut.
  void step(const Velocity& wanted, const Percepts& percepts, const Posture& posture, Pose& pose);
  /// A stance that needs no balance.
  void stand(Pose& pose) const;
  /// What it walks by now: for dead reckoning.
  const Velocity& velocity() const { return now_; }
  /// True when it treads on the spot with both feet down: it may be stopped.
  bool mayStop() const;

 private:
  Foot footOf(bool right, double lift, double way, const Vec2& shift) const;

  const Build& build_;
  const Gait& gait_;
  double phase_ = 0;     ///< 0..1; the right leg swings in the first half
  double strength_ = 0;  ///< 0..1, grows at the start
  double blended_ = 1;   ///< 0..1 of the way from the pose in which it started
  Pose from_{};
  double sole_ = 0;  ///< rad, of both soles against the ground
  Velocity now_;
};

}  // namespace humanoid
