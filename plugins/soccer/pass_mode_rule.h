#pragma once

#include <array>

#include "soccer_rule.h"

namespace spark {

/// Pass mode (protocol sections 2.5, 6.3, 6.4): opponents are kept away from a resting ball for a while; in return the
/// team may not score for PassModeScoreWaitTime. The ban ends early when two team-mates have touched the ball since,
/// and one of them after it had gone PassModeMinOppBallDist from where it lay.
class PassModeRule : public SoccerRule {
  SPARK_CLASS(PassModeRule, SoccerRule)
 public:
  static void describe(Description<PassModeRule>& d);

  /// A player asks for pass mode; what is not fulfilled is ignored quietly.
  void request(const soccer::Player& player);
  /// s that goals of this team do not count yet, 0: they count.
  double scoreWait(Side side) const;
  /// Ends both teams' bans and waits.
  void forget();

 protected:
  void saveState(StateWriter& out) const override;
  void loadState(StateReader& in) override;

 private:
  static constexpr double kNever = -1e6;  ///< s
  struct Team {
    double lastActive = kNever;  ///< s of the simulated clock, when pass mode was on
    bool cleared = true;         ///< goals count
    bool ballAway = false;       ///< the ball has been far from `spot`
    int toucher = 0;             ///< number of the first who touched the ball since
    bool twoTouched = false;
    static constexpr double kUnknown = -1;  ///< m
    Vec3 spot = Vec3::Zero();               ///< where the ball was in pass mode [m]
    std::array<double, GameStateAspect::kTeamSize + 1>
        ballDistance{};  ///< of each player at the last judging [m]; < 0: unknown
    double before(int unum) const { return unum <= GameStateAspect::kTeamSize ? ballDistance[unum] : kUnknown; }
  };
  Team& team(Side s) { return teams_[s == Side::right]; }
  const Team& team(Side s) const { return teams_[s == Side::right]; }

  void judge(const Event&) override;
  void begin();
  void passing();
  void earnRightToScore(Side side);
  void noteDistances();
  bool mayPass(const soccer::Player& player) const;
  double waitLeft() const { return scoreWait(Side::left); }
  double waitRight() const { return scoreWait(Side::right); }

  std::array<Team, 2> teams_;
  std::int64_t modeSeen_ = -1;
};

}  // namespace spark
