#pragma once

#include "penalty_aspect.h"
#include "player_contact_aspect.h"
#include "soccer_rule.h"

namespace spark {

/// Base of the fouls. Each is judged in every cycle, after the rules of play and before PenaltyAspect; while the match
/// pauses (before kick-off, after a goal) its counters are reset.
class FoulAspect : public SoccerRule {
  SPARK_CLASS(FoulAspect, SoccerRule)
 public:
  using Foul = soccer::Foul;
  static constexpr double kStandingHeight = 0.25;  ///< m: a torso below is not standing
  static constexpr double kGroundHeight = 0.15;    ///< m: a torso below is on the ground
  static constexpr int kGoalie = 1;                ///< his number

  static void describe(Description<FoulAspect>& d) {
    d.doc("Base of the fouls that the automatic referee judges.");
    d.abstract();
    d.link(&FoulAspect::penalties_, Beside<PenaltyAspect>());
    d.link(&FoulAspect::contacts_, Beside<PlayerContactAspect>());
  }

 protected:
  /// A cycle of play. Everything below may be called.
  virtual void judgePlay(const Event& event) = 0;
  /// A cycle in which nothing is judged: counters start anew.
  virtual void reset() = 0;

  PenaltyAspect& penalties() const { return *penalties_; }
  /// nullptr when the config has none: then nobody touches anybody.
  const PlayerContactAspect* contacts() const { return contacts_.get(); }
  const std::vector<soccer::Player>& players() const { return pitch().players(); }
  /// Has a team and a body, and no penalty to serve.
  bool isJudged(std::size_t player) const {
    return players()[player].side() != Side::none && players()[player].torso && penalties_->isFree(player);
  }
  void sendOff(std::size_t player, Foul foul) { penalties_->sendOff(pitch(), player, foul); }
  /// Lower than a standing player, and not beside the field, where players lie who wait.
  bool isDown(const soccer::Player& player) const;
  /// On the ground plane [m].
  static double distance(const Vec3& a, const Vec3& b) { return (a - b).head<2>().norm(); }
  bool isGoalie(std::size_t player) const { return players()[player].state->unum() == kGoalie; }
  /// The centre of the torso is in the penalty area that his team defends.
  bool inOwnArea(const soccer::Player& player) const;

  template <class T>
  void follow(soccer::PlayerRecords<T>& records) const {
    records.follow(pitch(), *this);
  }

 private:
  void judge(const Event& event) final;
  void skip() final { reset(); }

  Link<PenaltyAspect> penalties_;
  Link<PlayerContactAspect> contacts_;
};

}  // namespace spark
