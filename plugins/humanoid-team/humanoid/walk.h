#pragma once
/// \file
/// Omnidirectional walk: the legs swing alternately while the torso sways over the support foot.

#include "legs.h"
#include "posture.h"

namespace humanoid {

/// Parameters of a walk. Lengths in m, angles in rad.
struct Gait {
  double period = 0.5;    ///< of two steps [s]
  double height = 0.93;   ///< of the hips above the soles, as a fraction of the length of a straight leg
  double lift = 0.025;    ///< height of the swing foot
  double pause = 0.1;     ///< fraction of a step with double support, at its beginning and end
  double sway = 0.02;     ///< amplitude of the torso to each side
  double swayLead = 0.3;  ///< phase by which the sway leads the legs [rad]
  double spread = 0.0;    ///< lateral offset of each foot outwards from its hip
  double forward = 0.0;   ///< offset of the feet in front of the hips
  double lean = 0.05;     ///< forward lean of the torso
  double tiltForward = 0, rateForward = 0, tiltRight = 0,
         rateRight = 0;  ///< shift of the feet per lean [m/rad] and per its rate [m s/rad]
  double maxForward = 0.3, maxSide = 0.1, maxTurn = 0.8;  ///< m/s, m/s, rad/s
  double change = 0.5;                     ///< maximum acceleration, as a fraction of the maximum speed [1/s]
  double brake = 0.5;                      ///< maximum deceleration, likewise
  double leanSpeed = 0, forwardSpeed = 0;  ///< additional lean and forward offset of the feet per speed
  double soleTilt = 0, soleRate = 0;       ///< pitch of the soles per lean and per its rate
  double share = 0.8;                      ///< fraction of the remaining angle that a joint covers in a cycle
};
/// The optimised gait of a type, 0..4.
const Gait& gaitOf(int type);

/// A walking velocity in the robot's frame.
struct Velocity {
  double forward = 0, right = 0, turn = 0;  ///< m/s, m/s, rad/s; turn is positive to the left
  template <class F>
  void fields(F& f) {
    f(forward, right, turn);
  }
};

/// Generates the leg angles of a walk.
class Walk {
 public:
  Walk(const Build& build, const Gait& gait) : build_(build), gait_(gait) {}
  /// Starts with steps on the spot of growing height. `from`: the current pose of the whole body.
  void start(const Pose& from);
  /// Sets the leg angles of `pose` for the next cycle; arms stay as they are in `pose`. `wanted` is clamped to the
  /// gait's maximum speeds.
  void step(const Velocity& wanted, const Percepts& percepts, const Posture& posture, Pose& pose);
  /// Sets the leg angles of a statically stable stance.
  void stand(Pose& pose) const;
  /// The current velocity, for odometry.
  const Velocity& velocity() const { return now_; }
  /// True while it steps on the spot with both feet on the ground: it may be stopped then.
  bool mayStop() const;
  template <class F>
  void fields(F& f) {
    f(phase_, strength_, blended_, from_, sole_, now_);
  }

 private:
  Foot footOf(bool right, double lift, double way, const Vec2& shift) const;

  const Build& build_;
  const Gait& gait_;
  double phase_ = 0;     ///< 0..1; the right leg swings in the first half
  double strength_ = 0;  ///< 0..1, grows at the start
  double blended_ = 1;   ///< progress from the pose in which it started, 0..1
  Pose from_{};
  double sole_ = 0;  ///< pitch of both soles relative to the ground [rad]
  Velocity now_;
};

}  // namespace humanoid
