#include "restart_rules.h"

namespace spark {

using soccer::opponent;

void SetPieceRule::repelOnce() {
  if (repelledIn_ == game().modeChanges()) return;
  repelledIn_ = game().modeChanges();
  const double distance = settings().kickRepelDist;
  pitch().repel(side(), referee().kickPosition(), distance, distance, random());
}

void RestartRule::judge(const Event&) {
  const bool indirect = in(PlayMode::kickInLeft) || in(PlayMode::freeKickLeft);
  if (!indirect && !in(PlayMode::cornerKickLeft) && !in(PlayMode::directFreeKickLeft)) return;
  if (!isOpen()) return;
  const Vec3& position = referee().kickPosition();
  pitch().clearSphere(opponent(side()), position, settings().freeKickDistance, settings().freeKickMoveDist, random());
  repelOnce();
  if (kicked())
    referee().taken(indirect);
  else
    pitch().placeBall(position);
}

void GoalKickRule::judge(const Event&) {
  if (!in(PlayMode::goalKickLeft) || !isOpen()) return;
  const soccer::Area area = pitch().penaltyArea(side());
  pitch().clearArea(opponent(side()), area, settings().freeKickMoveDist, random());
  repelOnce();
  // After the first touch the ball is free until it leaves the area.
  if (kickedIn_ != game().modeChanges()) {
    if (!kicked()) return pitch().placeBall(referee().kickPosition());
    kickedIn_ = game().modeChanges();
    referee().lastKick().taken(ball().last(), false);
  }
  if (!area.contains(ball().position().x(), ball().position().y()) || !ball().onField())
    game().setMode(PlayMode::playOn);
}

void GoalKickRule::saveState(StateWriter& out) const {
  SetPieceRule::saveState(out);
  out.write(kickedIn_);
}

void GoalKickRule::loadState(StateReader& in) {
  SetPieceRule::loadState(in);
  kickedIn_ = in.readInteger();
}

void DropBallRule::judge(const Event&) {
  // At a kick-off the ball is not held: it is dropped at its current position.
  if (in(PlayMode::kickOffLeft) && game().modeReached(settings().ruleDropBallTime))
    return referee().dropBall(pitch().ballPosition());
  for (const PlayMode restart : {PlayMode::kickInLeft, PlayMode::cornerKickLeft, PlayMode::goalKickLeft,
                                 PlayMode::freeKickLeft, PlayMode::directFreeKickLeft})
    if (in(restart) && game().modeReached(settings().ruleDropBallTime))
      return referee().dropBall(referee().kickPosition());
}

}  // namespace spark
