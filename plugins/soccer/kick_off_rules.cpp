#include "kick_off_rules.h"

namespace spark {

void BeforeKickOffRule::judge(const Event&) {
  if (mode() != PlayMode::beforeKickOff || pitch().gameControl()->agents().empty()) return;
  pitch().placeBall(pitch().centre());
  if (settings().startAnyFieldPosition) return;
  pitch().bothSides(random(), [&](Side s) { pitch().clearOpponentHalf(s, 0, settings().freeKickMoveDist, random()); });
}

void KickOffRule::judge(const Event&) {
  if (referee().playing()) return earnRightToScore();
  if (!in(PlayMode::kickOffLeft)) return;
  pitch().clearForKickOff(side(), random());
  if (!ball().touched()) return;
  referee().taken(true);
  referee().setKickOffSide(ball().last().side == side() ? side() : Side::none);
}

void KickOffRule::earnRightToScore() {
  const Side kickOffSide = referee().kickOffSide();
  if (kickOffSide == Side::none || !ball().touched()) return;
  const Vec3& b = ball().position();
  if (ball().last().side != kickOffSide || std::hypot(b.x(), b.y()) > settings().freeKickDistance)
    referee().setKickOffSide(Side::none);
}

}  // namespace spark
