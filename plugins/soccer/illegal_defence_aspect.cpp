#include "illegal_defence_aspect.h"

namespace spark {

void IllegalDefenceAspect::judgePlay(const Event&) {
  follow(records_);
  std::array<int, 2> inside{};
  for (std::size_t i = 0; i < players().size(); ++i) {
    records_[i].now = isJudged(i) && inOwnArea(players()[i]);
    inside[players()[i].side() == Side::right] += records_[i].now;
  }
  for (const Side side : {Side::left, Side::right})
    for (int surplus = inside[side == Side::right] - settings().maxPlayersInsideOwnArea; surplus > 0; --surplus)
      if (const int player = findOffender(side); player >= 0) penalise(player);
  for (Inside& i : records_) i.before = i.now;
}

int IllegalDefenceAspect::findOffender(Side side) const {
  // Players that have just entered precede all others; among equals the farthest from the goal is taken.
  const Vec3 goal(-direction(side) * settings().fieldLength / 2, 0, 0);
  int offender = -1;
  bool entered = false;
  double maxDistance = -1;
  for (std::size_t i = 0; i < players().size(); ++i) {
    if (players()[i].side() != side || !records_[i].now || isGoalie(i)) continue;
    const bool justEntered = !records_[i].before;
    const double goalDistance = distance(players()[i].position(), goal);
    if (entered && !justEntered) continue;
    if (justEntered == entered && goalDistance <= maxDistance) continue;
    offender = static_cast<int>(i), entered = justEntered, maxDistance = goalDistance;
  }
  return offender;
}

void IllegalDefenceAspect::penalise(std::size_t player) {
  records_[player].now = false;
  if (settings().illegalDefenseBeamPenalty) return sendOff(player, Foul::illegalDefence);
  penalties().moveAside(pitch(), player, Foul::illegalDefence, exitPosition(players()[player]));
}

Vec3 IllegalDefenceAspect::exitPosition(const soccer::Player& player) const {
  const soccer::Area area = pitch().penaltyArea(player.side());
  const double radius = settings().agentRadius;
  Vec3 p = player.position();
  const double front = player.side() == Side::left ? area.maxX : area.minX;
  const double toFront = std::abs(front - p.x()), toLow = p.y() - area.minY, toHigh = area.maxY - p.y();
  if (toFront <= std::min(toLow, toHigh))
    p.x() = front + direction(player.side()) * radius;
  else
    p.y() = toLow < toHigh ? area.minY - radius : area.maxY + radius;
  return p;
}

}  // namespace spark
