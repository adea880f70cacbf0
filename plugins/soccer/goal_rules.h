#pragma once

#include "soccer_rule.h"

namespace spark {

/// The taker of a restart touched the ball again before anybody else: an indirect free kick for the others.
class DoubleTouchRule : public SoccerRule {
  SPARK_CLASS(DoubleTouchRule, SoccerRule)
 public:
  static void describe(Description<DoubleTouchRule>& d) {
    d.doc("The taker of a restart may not touch the ball twice.");
  }

 private:
  void judge(const Event&) override;
};

/// Goals, and what forbids them; after a goal the pause and the other side's kick-off.
class GoalRule : public SoccerRule {
  SPARK_CLASS(GoalRule, SoccerRule)
 public:
  static void describe(Description<GoalRule>& d) { d.doc("Goals, what forbids them, and the pause after one."); }

 private:
  void judge(const Event&) override;
  void goal(Side goalOf);
  void pause();
  bool refused(Side goalOf);
};

/// Penalty shoot-out: the right team's goalie leaves his area, and it is a goal.
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
