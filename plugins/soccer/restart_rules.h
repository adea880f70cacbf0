#pragma once

#include "soccer_rule.h"

namespace spark {

/// What restarts have in common. Nothing happens for RuleKickInPauseTime; then opponents are cleared, the kicking team
/// is pushed off the ball once, and the ball is pinned to the kick position until it is touched.
class SetPieceRule : public SoccerRule {
  SPARK_CLASS(SetPieceRule, SoccerRule)
 public:
  static constexpr double kTouchDelay = 0.03;  ///< s after the pause before a touch takes a restart
  static void describe(Description<SetPieceRule>& d) {
    d.doc("What restarts have in common.");
    d.abstract();
  }

 protected:
  /// The pause is over.
  bool open() const { return game().modeReached(settings().ruleKickInPauseTime); }
  /// The ball is touched, and the touch takes the restart.
  bool kicked() const { return ball().touched() && game().modeTime() > settings().ruleKickInPauseTime + kTouchDelay; }
  /// Pushes the kicking team off the ball, once in a mode.
  void repelOnce();
  void saveState(StateWriter& out) const override { out.write(repelledIn_); }
  void loadState(StateReader& in) override { repelledIn_ = in.readInteger(); }

 private:
  std::int64_t repelledIn_ = -1;  ///< count of mode changes
};

/// KickIn_X, corner_kick_X, free_kick_X, direct_free_kick_X.
class RestartRule : public SetPieceRule {
  SPARK_CLASS(RestartRule, SetPieceRule)
 public:
  static void describe(Description<RestartRule>& d) { d.doc("Kick-ins, corners and free kicks."); }

 private:
  void judge(const Event&) override;
};

/// goal_kick_X: opponents leave the penalty area; play goes on when the ball has left it.
class GoalKickRule : public SetPieceRule {
  SPARK_CLASS(GoalKickRule, SetPieceRule)
 public:
  static void describe(Description<GoalKickRule>& d) { d.doc("Goal kicks: the ball must leave the penalty area."); }

 protected:
  void saveState(StateWriter& out) const override;
  void loadState(StateReader& in) override;

 private:
  void judge(const Event&) override;
  std::int64_t kickedIn_ = -1;  ///< count of mode changes
};

/// A restart or kick-off that nobody takes for RuleDropBallTime becomes a drop ball.
class DropBallRule : public SoccerRule {
  SPARK_CLASS(DropBallRule, SoccerRule)
 public:
  static void describe(Description<DropBallRule>& d) { d.doc("A restart that nobody takes becomes a drop ball."); }

 private:
  void judge(const Event&) override;
};

}  // namespace spark
