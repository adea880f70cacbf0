#pragma once

#include "soccer_rule.h"

namespace spark {

/// Base of the restarts, with the procedure of the installed base: nothing happens for RuleKickInPauseTime; then
/// opponents are moved away, players of the kicking team are once moved to KickRepelDist from the ball, and the ball is
/// held at the kick position until it is touched.
class SetPieceRule : public SoccerRule {
  SPARK_CLASS(SetPieceRule, SoccerRule)
 public:
  static constexpr double kTouchDelay = 0.03;  ///< after the pause, before a touch takes a restart [s]
  static void describe(Description<SetPieceRule>& d) {
    d.doc("Base of the restarts.");
    d.abstract();
  }

 protected:
  /// True when the pause is over.
  bool isOpen() const { return game().modeReached(settings().ruleKickInPauseTime); }
  /// True when the restart is taken in this cycle, by a touch of any player.
  bool kicked() const { return ball().touched() && game().modeTime() > settings().ruleKickInPauseTime + kTouchDelay; }
  /// Moves the kicking team away from the ball, once in each mode.
  void repelOnce();
  void saveState(StateWriter& out) const override { out.write(repelledIn_); }
  void loadState(StateReader& in) override { repelledIn_ = in.readInteger(); }

 private:
  std::int64_t repelledIn_ = -1;  ///< count of mode changes then
};

/// KickIn_X, corner_kick_X, free_kick_X and direct_free_kick_X. Kick-ins and free kicks are indirect.
class RestartRule : public SetPieceRule {
  SPARK_CLASS(RestartRule, SetPieceRule)
 public:
  static void describe(Description<RestartRule>& d) { d.doc("Kick-ins, corners and free kicks."); }

 private:
  void judge(const Event&) override;
};

/// goal_kick_X: opponents are moved out of the penalty area; PlayOn when the ball has left the area.
class GoalKickRule : public SetPieceRule {
  SPARK_CLASS(GoalKickRule, SetPieceRule)
 public:
  static void describe(Description<GoalKickRule>& d) { d.doc("Goal kicks: the ball must leave the penalty area."); }

 protected:
  void saveState(StateWriter& out) const override;
  void loadState(StateReader& in) override;

 private:
  void judge(const Event&) override;
  std::int64_t kickedIn_ = -1;  ///< count of mode changes then
};

/// A restart or kick-off that is not taken within RuleDropBallTime becomes a drop ball.
class DropBallRule : public SoccerRule {
  SPARK_CLASS(DropBallRule, SoccerRule)
 public:
  static void describe(Description<DropBallRule>& d) {
    d.doc("A restart that is not taken in time becomes a drop ball.");
  }

 private:
  void judge(const Event&) override;
};

}  // namespace spark
