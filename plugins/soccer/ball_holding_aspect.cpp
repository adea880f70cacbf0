#include "ball_holding_aspect.h"

namespace spark {

void BallHoldingAspect::judgePlay(const Event& event) {
  follow(holders_);
  const SoccerSettings& s = settings();
  if (!s.useBallHolding) return holders_.reset();
  for (std::size_t i = 0; i < players().size(); ++i) {
    Holder& h = holders_[i];
    if (!isJudged(i)) {
      h = {};
      continue;
    }
    const soccer::Player& p = players()[i];
    const bool hasBall = distance(p.position(), ball().position()) <= s.ballHoldRadius;
    // Time counts under pressure only; a hold ends after BallHoldResetTime without the ball.
    h.cyclesAway = hasBall ? 0 : h.cyclesAway + 1;
    if (hasBall && underPressure(p.side())) ++h.cyclesHeld;
    if (h.cyclesAway * event.step >= s.ballHoldResetTime - 1e-9) h = {};
    const double maxTime = isGoalie(i) && inOwnArea(p) ? s.goalieBallHoldMaxTime : s.ballHoldMaxTime;
    if (hasBall && h.cyclesHeld * event.step > maxTime + 1e-9) sendOff(i, Foul::ballHolding);
  }
}

bool BallHoldingAspect::underPressure(Side side) const {
  if (settings().ballHoldOppDist <= 0) return true;
  return std::any_of(players().begin(), players().end(), [&](const soccer::Player& p) {
    return p.side() == opponent(side) && p.torso &&
           distance(p.position(), ball().position()) <= settings().ballHoldOppDist;
  });
}

}  // namespace spark
