#pragma once

#include "soccer_rule.h"

namespace spark {

/// Double touch: the taker of a restart touches the ball again before any other player. Indirect free kick for the
/// opponents.
class DoubleTouchRule : public SoccerRule {
  SPARK_CLASS(DoubleTouchRule, SoccerRule)
 public:
  static void describe(Description<DoubleTouchRule>& d) {
    d.doc("The taker of a restart may not touch the ball twice.");
  }

 private:
  void judge(const Event&) override;
};

/// Goals: counts them unless they are disallowed; after a goal the pause and the kick-off of the team that conceded it.
/// Disallowed are, in the order of the installed base, goals before the kick-off team may score, goals directly from an
/// indirect restart, own goals directly from any restart, and goals too soon after the team's pass mode.
class GoalRule : public SoccerRule {
  SPARK_CLASS(GoalRule, SoccerRule)
 public:
  static void describe(Description<GoalRule>& d) { d.doc("Goals, disallowed goals, and the pause after a goal."); }

 private:
  void judge(const Event&) override;
  void goal(Side goalOf);
  void pause();
  /// True when the goal does not count; the restart is awarded then. `goalOf`: the side that defends the goal.
  bool isDisallowed(Side goalOf);
};

/// Penalty shoot-out: if a player of the right team leaves its penalty area, the left team scores.
class PenaltyShootoutRule : public SoccerRule {
  SPARK_CLASS(PenaltyShootoutRule, SoccerRule)
 public:
  static void describe(Description<PenaltyShootoutRule>& d) {
    d.doc("In a penalty shoot-out the right team's players stay in their penalty area, or it is a goal.");
  }

 private:
  void judge(const Event&) override;
};

/// The ball leaves the field: goal kick, corner, kick-in.
class BallOutRule : public SoccerRule {
  SPARK_CLASS(BallOutRule, SoccerRule)
 public:
  static void describe(Description<BallOutRule>& d) {
    d.doc("The ball leaves the field: goal kick, corner or kick-in.");
  }

 private:
  void judge(const Event&) override;
};

}  // namespace spark
