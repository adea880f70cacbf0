#pragma once

#include <array>

#include "soccer_rule.h"

namespace spark {

/// Pass mode, as in the installed base: for PassModeDuration opponents are kept away from a resting ball. In return the
/// team may not score for PassModeScoreWaitTime. This ban ends early when two team-mates have touched the ball, one of
/// them after the ball has been PassModeMinOppBallDist away from its position in pass mode.
class PassModeRule : public SoccerRule {
  SPARK_CLASS(PassModeRule, SoccerRule)
 public:
  static void describe(Description<PassModeRule>& d);

  /// Why a request for pass mode has no effect. The conditions are those of the installed base.
  enum class Refusal { none, disabled, mode, tooSoon, touched, fast, far, opponents };
  /// One line for the log.
  static std::string text(Refusal refusal);

  /// Requests pass mode for a player's team, and returns why it has no effect.
  Refusal request(const soccer::Player& player);
  /// Time until goals of the team count again [s]; 0: they count.
  double scoreWait(Side side) const;
  /// Ends the bans of both teams, and the time between two pass modes.
  void reset();

 protected:
  void saveState(StateWriter& out) const override;
  void loadState(StateReader& in) override;

 private:
  static constexpr double kNever = -1e6;  ///< s
  struct Team {
    double lastActive = kNever;  ///< simulated time of the last cycle of pass mode [s]
    bool cleared = true;         ///< goals count
    bool ballAway = false;       ///< the ball has been far from `position`
    int toucher = 0;             ///< number of the first player that touched the ball after pass mode; 0: none yet
    bool twoTouched = false;     ///< another player has touched it, too
    static constexpr double kUnknown = -1;  ///< m
    Vec3 position = Vec3::Zero();           ///< of the ball in pass mode [m]
    /// Distances of the players to the ball in the last cycle, by number [m].
    std::array<double, GameStateAspect::kTeamSize + 1> ballDistance{};
    /// Distance of a player to the ball in the last cycle [m].
    double lastDistance(int unum) const { return unum <= GameStateAspect::kTeamSize ? ballDistance[unum] : kUnknown; }
  };
  Team& team(Side s) { return teams_[s == Side::right]; }
  const Team& team(Side s) const { return teams_[s == Side::right]; }

  void judge(const Event&) override;
  void enterMode();
  void judgePassMode();
  void earnRightToScore(Side side);
  void recordDistances();
  /// The conditions of the installed base: PlayOn; PassModeRetryWaitTime since the team's last pass mode; the ball is
  /// slow and no player of the team touches it; in this cycle and the last the player is near the ball and no opponent
  /// is.
  Refusal refusal(const soccer::Player& player) const;
  double waitLeft() const { return scoreWait(Side::left); }
  double waitRight() const { return scoreWait(Side::right); }

  std::array<Team, 2> teams_;
  std::int64_t modeSeen_ = -1;  ///< count of mode changes
};

}  // namespace spark
