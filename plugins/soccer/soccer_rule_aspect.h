#pragma once

#include <span>
#include <vector>

#include "ball_state_aspect.h"

namespace spark {

/// The referee: restarts, goals, the ball leaving the field, clearing of players. Runs after ball state.
///
///     BeforeKickOff -> KickOff_X -> PlayOn -> Goal_X -> KickOff_(other)
///                          |          | ^
///                          +- 15 s ---+ +-- KickIn_X, corner_kick_X, goal_kick_X, free_kick_X, direct_free_kick_X (touch or 15 s)
///
/// In a restart nothing happens for the pause; then the ball is pinned to the kick position and opponents are kept away until the touch.
class SoccerRuleAspect : public SoccerControlAspect {
  SPARK_CLASS(SoccerRuleAspect, SoccerControlAspect)
 public:
  using Side = soccer::Side;
  using PlayMode = soccer::PlayMode;

  /// What monitors are told of a foul.
  struct Foul {
    std::int64_t index = 0;  ///< counts from 1
    int type = 0;            ///< protocol section 6.7
    Side side = Side::none;
    int unum = 0;
  };

  static void describe(Description<SoccerRuleAspect>& d);
  void rule(const Event& event) override;

  /// The ball lies free at `where` (outside of penalty areas), both teams are cleared from it, play goes on.
  void dropBall(const Vec3& where);
  /// A restart at `where`.
  void award(PlayMode mode, const Vec3& where);
  /// Tells monitors of a foul; `team` is left, right or none.
  void reportFoul(int type, std::string team, int unum);
  /// The last fouls, oldest first.
  std::span<const Foul> fouls() const { return fouls_; }

 protected:
  void saveState(StateWriter& out) const override;
  void loadState(StateReader& in) override;

 private:
  void enterMode();
  void beforeKickOff();
  void kickOff(Side side);
  void clearForKickOff(Side side);
  void restart(Side side);
  void goalKick(Side side);
  void passMode(Side side);
  void goalPause(Side scorer);
  void playOn();
  bool doubleTouch();
  void earnRightToScore();
  bool goal();
  void countGoal(Side goalOf);
  void ballOut();
  bool dropBallIfLate(const Vec3& where);
  void taken(bool indirect);
  void repelOnce(Side side, const Vec3& from);
  bool restricted() const;
  Vec3 positionFor(PlayMode mode) const;
  Vec3 goalKickPosition(Side side) const;
  Vec3 cornerPosition(Side defending) const;

  GameStateAspect* game_ = nullptr;
  BallStateAspect* ball_ = nullptr;
  soccer::Pitch* pitch_ = nullptr;  ///< of this cycle
  std::uint64_t gameVersion_ = 0, ballVersion_ = 0;

  std::int64_t modeSeen_ = 0;
  Vec3 kickPosition_ = Vec3::Zero();
  bool positionGiven_ = false, repelled_ = false;
  int taker_ = 0;               ///< agent that took the restart and that nobody else has touched the ball after; 0: none
  double takerContact_ = 0;     ///< s of play
  bool takerTouching_ = false;  ///< his contact of the restart itself still counts
  bool indirect_ = false;
  Side kickOffSide_ = Side::none;  ///< has not earned the right to score; none: no restriction
  std::vector<Foul> fouls_;
  std::int64_t foulCount_ = 0;
};

/// The SPL variant: accepted, plays by the same rules.
class SPLRule : public SoccerRuleAspect {
  SPARK_CLASS(SPLRule, SoccerRuleAspect)
 public:
  static void describe(Description<SPLRule>& d) { d.doc("Accepted for SPL configs; the same as SoccerRuleAspect."); }
};

}  // namespace spark
