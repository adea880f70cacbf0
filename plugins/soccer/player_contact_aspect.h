#pragma once

#include <span>

#include "soccer_control_aspect.h"

namespace spark {

/// The contacts of this cycle between players, and between players and the ball. AgentCollisionHandlers report them
/// during the physics phase; the fouls that run after this aspect read them. Players without a team are ignored.
class PlayerContactAspect : public SoccerControlAspect {
  SPARK_CLASS(PlayerContactAspect, SoccerControlAspect)
 public:
  /// Two players that touch each other.
  struct Pair {
    int a = 0, b = 0;           ///< indices of players, a < b
    Vec3 point = Vec3::Zero();  ///< mean of their contact points, world frame [m]
    int points = 0;             ///< number of contact points
  };

  static void describe(Description<PlayerContactAspect>& d) {
    d.doc("The contacts of this cycle between players, and with the ball; touching and charging are judged by them.");
  }
  void rule(const Event& event) override;
  /// Disabled: there are no contacts.
  void rest(const Event& event) override {
    reports_.clear();
    rule(event);
  }

  /// Reports a contact of `self` with `other` at `point` (world frame [m]); `other` nullptr: with the ball. Called
  /// during the physics phase. Both agents may report the same point.
  void report(const AgentAspect& self, const AgentAspect* other, const Vec3& point) {
    reports_.push_back({&self, other, point});
  }

  /// The pairs of players that touch, in the order in which their contacts were reported. Valid until the next rule
  /// phase.
  std::span<const Pair> pairs() const { return pairs_; }
  /// True when the player (an index) touches the ball.
  bool touchesBall(int player) const { return touchesBall_[player] != 0; }
  /// The contact group of the player: players that touch each other, directly or through others, are in the same
  /// group. It is the smallest index of its members.
  int group(int player) const { return group_[player]; }

 private:
  struct Report {
    const AgentAspect* self;
    const AgentAspect* other;  ///< nullptr: the ball
    Vec3 point;
  };
  /// Index of the agent's player; -1 when it has no team.
  int playerOf(const AgentAspect* agent) const;
  void mergeGroups(int a, int b);
  void addContact(int a, int b, const Vec3& point);

  const soccer::Pitch* pitch_ = nullptr;  ///< of this cycle
  // Rebuilt in each cycle; members only to keep their capacity.
  std::vector<Report> reports_;
  std::vector<Pair> pairs_;
  std::vector<int> group_;         ///< by player
  std::vector<char> touchesBall_;  ///< by player
};

}  // namespace spark
