#pragma once

#include "penalty_aspect.h"
#include "player_contact_aspect.h"
#include "soccer_rule.h"

namespace spark {

/// Base of the fouls. A foul is judged in every cycle, after the rules of play and before PenaltyAspect. While the
/// match is paused (before kick-off, after a goal) its counters are reset.
class FoulAspect : public SoccerRule {
  SPARK_CLASS(FoulAspect, SoccerRule)
 public:
  using Foul = soccer::Foul;
  static constexpr double kStandingHeight = 0.25;  ///< lower torsos do not stand [m]
  static constexpr double kGroundHeight = 0.15;    ///< lower torsos are on the ground [m]
  static constexpr int kGoalie = 1;                ///< uniform number of a goalie

  static void describe(Description<FoulAspect>& d) {
    d.doc("Base of the fouls that the automatic referee judges.");
    d.abstract();
    d.link(&FoulAspect::penalties_, Beside<PenaltyAspect>());
    d.link(&FoulAspect::contacts_, Beside<PlayerContactAspect>());
  }

 protected:
  /// Judges a cycle of play. Only here and in reset() may the accessors below be called.
  virtual void judgePlay(const Event& event) = 0;
  /// Resets all counters. Called instead of judgePlay() in a cycle in which nothing is judged.
  virtual void reset() = 0;

  /// Carries out penalties.
  PenaltyAspect& penalties() const { return *penalties_; }
  /// The contacts of players; nullptr when the config has no PlayerContactAspect.
  const PlayerContactAspect* contacts() const { return contacts_.get(); }
  /// The players of the match. Fouls identify a player by its index here.
  const std::vector<soccer::Player>& players() const { return pitch().players(); }
  /// True when the player has a team and a body and serves no penalty.
  bool isJudged(std::size_t player) const {
    return players()[player].side() != Side::none && players()[player].torso && penalties_->isFree(player);
  }
  /// Calls a foul: the player is held and then put beside the field (see PenaltyAspect).
  void sendOff(std::size_t player, Foul foul) { penalties_->sendOff(pitch(), player, foul); }
  /// True when the torso is lower than that of a standing player. Players beside the field never are: they wait there.
  bool isDown(const soccer::Player& player) const;
  /// Distance on the ground plane [m].
  static double distance(const Vec3& a, const Vec3& b) { return (a - b).head<2>().norm(); }
  bool isGoalie(std::size_t player) const { return players()[player].state->unum() == kGoalie; }
  /// True when the centre of the torso is in the penalty area that the player's team defends.
  bool inOwnArea(const soccer::Player& player) const;

  /// Matches the records to the players of this cycle.
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
