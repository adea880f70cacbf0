#include "crowding_foul_aspect.h"

namespace spark {

namespace {
constexpr double kSecondPlayerSlack = 0.01;  ///< added to Min2PlDistance, as in the installed base [m]
}

void CrowdingFoulAspect::judgePlay(const Event&) {
  const SoccerSettings& s = settings();
  if (s.minOppDistance <= 0) return;
  std::array<Nearest, 2> teams;
  for (std::size_t i = 0; i < players().size(); ++i)
    if (isJudged(i))
      teams[players()[i].side() == Side::right].insert(static_cast<int>(i),
                                                       distance(players()[i].position(), ball().position()));
  for (const Side side : {Side::left, Side::right}) {
    if (game().mode() == forSide(soccer::PlayMode::kickOffLeft, side)) continue;
    if (teams[side == Side::left].distance[0] > s.minOppDistance) continue;
    // The nearest opponent is at the ball: `side` may not crowd it.
    const Nearest& team = teams[side == Side::right];
    if (s.min2PlDistance > 0) judgeRank(team, 1, s.min2PlDistance + kSecondPlayerSlack);
    if (s.min3PlDistance > 0) judgeRank(team, 2, s.min3PlDistance);
  }
}

void CrowdingFoulAspect::judgeRank(const Nearest& team, int rank, double limit) {
  const int player = team.player[rank];
  if (player >= 0 && team.distance[rank] <= limit && !isGoalie(player)) sendOff(player, Foul::crowding);
}

void CrowdingFoulAspect::Nearest::insert(int newPlayer, double newDistance) {
  for (std::size_t rank = 0; rank < player.size(); ++rank)
    if (newDistance < distance[rank]) {
      std::swap(newDistance, distance[rank]);
      std::swap(newPlayer, player[rank]);
    }
}

}  // namespace spark
