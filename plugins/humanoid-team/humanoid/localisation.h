#pragma once
/// \file
/// Self-localisation by flags and goal posts, and positions of the objects that a robot sees.

#include "posture.h"

namespace humanoid {

/// Pose of the robot in its team's frame: opponents' goal at +x, y to the left, origin at the centre of the field [m].
class Localisation {
 public:
  /// Call it for every message, after Posture::update(). `moved`: odometry since the last message, x to the robot's
  /// right, y forward [m].
  void update(const Percepts& percepts, const Posture& posture, const Vec2& moved);
  /// True while the pose is known: enough landmarks were seen within the last few seconds.
  bool known() const { return age_ < kTrust; }
  /// Position of the robot [m].
  const Vec2& place() const { return place_; }
  /// Heading [rad]; 0: towards the opponents' goal, positive to the left.
  double heading() const { return heading_; }
  /// A point of the head's frame in the levelled frame of the torso: x right, y forward, z up [m].
  Vec3 level(const Vec3& inHead, const Percepts& percepts, const Posture& posture) const;
  /// Converts points from the levelled frame of the robot to the team's frame, and back [m].
  Vec2 toField(const Vec2& fromRobot) const;
  Vec2 toRobot(const Vec2& onField) const;
  /// Marks the pose as unknown.
  void lose() { age_ = kTrust; }
  template <class F>
  void fields(F& f) {
    f(place_, heading_, age_, nod_);
  }

 private:
  static constexpr double kTrust = 3;  ///< time for which odometry alone is trusted [s]
  void match(const Percepts& percepts, const Posture& posture);
  void findHorizon(const Percepts& percepts, const Posture& posture);

  Vec2 place_ = Vec2::Zero();
  double heading_ = 0, age_ = kTrust;  ///< rad; time since enough landmarks were seen [s]
  double nod_ = 0;                     ///< correction of the posture's forward lean [rad]
};

}  // namespace humanoid
