#pragma once

#include <span>

#include "soccer_control_aspect.h"

namespace spark {

/// Who touches whom, and who the ball, in this cycle: what the colliders' AgentCollisionHandlers tell during physics,
/// put together for the fouls that come after it. Players without a team count as nobody.
class PlayerContactAspect : public SoccerControlAspect {
  SPARK_CLASS(PlayerContactAspect, SoccerControlAspect)
 public:
  /// Two players touch each other.
  struct Meeting {
    int a = 0, b = 0;           ///< indices of players, a < b
    Vec3 point = Vec3::Zero();  ///< mean of their contact points [m]
    int points = 0;
  };

  static void describe(Description<PlayerContactAspect>& d) {
    d.doc("Who touches whom, and who the ball, in this cycle; touching and charging are judged by it.");
  }
  void rule(const Event& event) override;
  /// Switched off, nobody touches anybody.
  void rest(const Event& event) override {
    told_.clear();
    rule(event);
  }

  /// A collider of `self` meets one of `other`, nullptr: the ball's. During physics. The same point may be told from
  /// both sides.
  void add(const AgentAspect& self, const AgentAspect* other, const Vec3& point) {
    told_.push_back({&self, other, point});
  }

  /// In the order in which their contacts were found.
  std::span<const Meeting> meetings() const { return meetings_; }
  /// The player touches the ball.
  bool atBall(int player) const { return atBall_[player] != 0; }
  /// Players who touch each other, directly or through others, have the same group: the least index of its members.
  int group(int player) const { return group_[player]; }

 private:
  struct Told {
    const AgentAspect* self;
    const AgentAspect* other;
    Vec3 point;
  };
  int playerOf(const AgentAspect* agent) const;
  void join(int a, int b);
  void meet(int a, int b, const Vec3& point);

  const soccer::Pitch* pitch_ = nullptr;  ///< of this cycle
  // kept between cycles for their capacity only
  std::vector<Told> told_;
  std::vector<Meeting> meetings_;
  std::vector<int> group_;
  std::vector<char> atBall_;
};

}  // namespace spark
