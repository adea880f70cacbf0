#include "goal_rules.h"

#include "pass_mode_rule.h"

namespace spark {

using soccer::opponent;

void DoubleTouchRule::judge(const Event&) {
  if (referee().playing() && referee().lastKick().doubleTouch() && referee().restricted())
    referee().awardFreeKick(opponent(ball().last().side));
}

void GoalRule::judge(const Event&) {
  if (in(PlayMode::goalLeft)) return pause();
  if (referee().playing() && ball().inGoalOf() != Side::none) goal(ball().inGoalOf());
}

void GoalRule::goal(Side goalOf) {
  if (isDisallowed(goalOf)) return;
  const Side scorer = opponent(goalOf);
  game().addGoal(scorer);
  const BallStateAspect::Touch& last = ball().last();
  kernel().log().info("soccer: goal for {}, {} : {}, last touch by {} {}", soccer::sideName(scorer),
                      game().score(Side::left), game().score(Side::right), soccer::sideName(last.side), last.unum);
  game().setMode(forSide(PlayMode::goalLeft, scorer));
}

bool GoalRule::isDisallowed(Side goalOf) {
  const Side scorer = opponent(goalOf);

  // After a kick-off, or directly from a restart: a goal kick; a corner for an own goal.
  if (referee().restricted()) {
    const Side kickOffSide = referee().kickOffSide();
    const bool ownGoal = kickOffSide != Side::none ? kickOffSide == goalOf : ball().last().side == goalOf;
    const soccer::LastKick& kick = referee().lastKick();
    if (kickOffSide != Side::none || (kick.isDirectFromRestart() && (kick.indirect() || ownGoal))) {
      ownGoal ? referee().awardCorner(scorer) : referee().awardGoalKick(goalOf);
      return true;
    }
  }

  // After pass mode.
  PassModeRule* pass = referee().passMode();
  if (!pass || pass->scoreWait(scorer) <= 0) return false;
  referee().awardGoalKick(goalOf);
  return true;
}

void GoalRule::pause() {
  const Side conceding = opponent(side());
  pitch().clearForKickOff(conceding, random());
  if (!game().modeReached(settings().ruleGoalPauseTime)) return;
  if (settings().penaltyShootout)
    game().setMode(PlayMode::gameOver);
  else
    game().kickOff(conceding);
}

void PenaltyShootoutRule::judge(const Event&) {
  if (!settings().penaltyShootout || !referee().playing()) return;
  const soccer::Area area = pitch().penaltyArea(Side::right);
  for (const soccer::Player& p : pitch().players()) {
    const Vec3 at = p.position();
    if (p.side() != Side::right || !p.torso || (at.x() > area.minX && std::abs(at.y()) < area.maxY)) continue;
    game().addGoal(Side::left);
    kernel().log().info("soccer: goal for left, {} left the penalty area", p.state->unum());
    return game().setMode(PlayMode::goalLeft);
  }
}

void BallOutRule::judge(const Event&) {
  if (!referee().playing() || ball().onField()) return;
  const SoccerSettings& s = settings();
  const Vec3 &at = ball().position(), &valid = ball().lastValid();
  const Side last = ball().last().side;
  // If no player has touched the ball, it is put back to its last position on the field.
  if (last == Side::none) return pitch().placeBall(Vec3(valid.x(), valid.y(), s.ballRadius));
  if (ball().crossedLine() == BallStateAspect::Line::goal) {
    const Side defending = at.x() < 0 ? Side::left : Side::right;
    last == defending ? referee().awardCorner(opponent(defending)) : referee().awardGoalKick(defending);
  } else {
    const double y = s.fieldWidth / 2 - s.ballRadius;
    referee().award(forSide(PlayMode::kickInLeft, opponent(last)), Vec3(valid.x(), at.y() < 0 ? -y : y, s.ballRadius));
  }
}

}  // namespace spark
