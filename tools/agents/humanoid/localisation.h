#pragma once
/// \file
/// Where a robot is on the field, from flags and goal posts, and where things are that it sees.

#include "posture.h"

namespace humanoid {

/// The field as a team sees it: the opponents' goal at +x, y to the left, origin in the middle [m].
class Localisation {
 public:
  /// To be called for every message, after the posture's. `moved`: the way walked since the last one, x to the robot's
  /// right, y forward [m].
  void update(const Percepts& percepts, const Posture& posture, const Vec2& moved);
  /// True when it has found itself, and seen enough since to trust it.
  bool known() const { return age_ < kTrust; }
  /// The robot's place [m].
  const Vec2& place() const { return place_; }
  /// rad; 0: its front is towards the opponents' goal, positive to the left.
  double heading() const { return heading_; }
  /// A point of the head's frame, seen from the torso's middle but level: x right, y forward, z up [m].
  Vec3 level(const Vec3& inHead, const Percepts& percepts, const Posture& posture) const;
  /// From the robot's level frame to the field, and back.
  Vec2 toField(const Vec2& fromRobot) const;
  Vec2 toRobot(const Vec2& onField) const;
  /// Forgets where it is.
  void lose() { age_ = kTrust; }

 private:
  static constexpr double kTrust = 3;  ///< s
  void match(const Percepts& percepts, const Posture& posture);
  void findHorizon(const Percepts& percepts, const Posture& posture);

  Vec2 place_ = Vec2::Zero();
  double heading_ = 0, age_ = kTrust;  ///< age: s since it saw enough
  double nod_ = 0;                     ///< rad that the posture's lean is wrong
};

}  // namespace humanoid
