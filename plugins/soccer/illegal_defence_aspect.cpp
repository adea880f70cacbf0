#include "illegal_defence_aspect.h"

namespace spark {

void IllegalDefenceAspect::judgePlay(const Event&) {
  follow(were_);
  std::array<int, 2> inside{};
  for (std::size_t i = 0; i < players().size(); ++i) {
    were_[i].is = isJudged(i) && inOwnArea(players()[i]);
    inside[players()[i].side() == Side::right] += were_[i].is;
  }
  for (const Side side : {Side::left, Side::right})
    for (int surplus = inside[side == Side::right] - settings().maxPlayersInsideOwnArea; surplus > 0; --surplus)
      if (const int player = guilty(side); player >= 0) punish(player);
  for (Inside& i : were_) i.was = i.is;
}

/// Of those who just came in the farthest from the goal; of all when the goalie came, or nobody. -1: there are only
/// goalies.
int IllegalDefenceAspect::guilty(Side side) const {
  const Vec3 goal(-direction(side) * settings().fieldLength / 2, 0, 0);
  int found = -1;
  bool foundNew = false;
  double farthest = -1;
  for (std::size_t i = 0; i < players().size(); ++i) {
    if (players()[i].side() != side || !were_[i].is || isGoalie(i)) continue;
    const bool isNew = !were_[i].was;
    const double far = distance(players()[i].position(), goal);
    if (foundNew && !isNew) continue;
    if (isNew == foundNew && far <= farthest) continue;
    found = static_cast<int>(i), foundNew = isNew, farthest = far;
  }
  return found;
}

void IllegalDefenceAspect::punish(std::size_t player) {
  were_[player].is = false;
  if (settings().illegalDefenseBeamPenalty) return sendOff(player, Foul::illegalDefence);
  penalties().moveAside(pitch(), player, Foul::illegalDefence, exitOf(players()[player]));
}

/// One radius beyond the nearest edge that is not the goal line.
Vec3 IllegalDefenceAspect::exitOf(const soccer::Player& player) const {
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
