#include "safe_reposition.h"

#include <algorithm>
#include <cmath>

#include "pitch.h"

namespace spark::soccer {

namespace {
constexpr int kMaxAttempts = 1000;  // the search takes quadratic time
}

Vec3 SafeReposition::find(const Pitch& pitch, const Player& player, const Vec3& target, bool avoidBall) {
  obstacles_.clear();
  for (const Player& p : pitch.players())
    if (&p != &player) obstacles_.push_back(p.bounds());
  if (isSafe(pitch, player, target.x(), target.y(), avoidBall)) return target;

  origin_ = player.position();
  target_ = target;
  stepX_ = -direction(player.side()) * pitch.settings().agentRadius;
  stepY_ = (target.y() < 0 ? -1 : 1) * pitch.settings().agentRadius;
  candidates_.clear();
  seen_.clear();
  addCandidate(1, 0);
  addCandidate(0, 1);
  const int attempts = std::min(pitch.settings().maxNumSafeRepositionAttempts, kMaxAttempts);
  for (int n = 0; n < attempts; ++n) {
    const Candidate c = takeNearest();
    Vec3 position(target.x() + stepX_ * c.i, target.y() + stepY_ * c.j, target.z());
    if (isSafe(pitch, player, position.x(), position.y(), avoidBall)) return position;
    addCandidate(c.i + 1, c.j);
    addCandidate(c.i, c.j + 1);
  }
  return target;
}

void SafeReposition::addCandidate(int i, int j) {
  if (std::find(seen_.begin(), seen_.end(), std::pair(i, j)) != seen_.end()) return;
  seen_.emplace_back(i, j);
  const double x = target_.x() + stepX_ * i, y = target_.y() + stepY_ * j;
  candidates_.push_back({i, j, std::hypot(x - origin_.x(), y - origin_.y())});
}

SafeReposition::Candidate SafeReposition::takeNearest() {
  const auto at = std::min_element(candidates_.begin(), candidates_.end(),
                                   [](const Candidate& a, const Candidate& b) { return a.distance < b.distance; });
  const Candidate c = *at;
  candidates_.erase(at);
  return c;
}

bool SafeReposition::isSafe(const Pitch& pitch, const Player& player, double x, double y, bool avoidBall) const {
  const SoccerSettings& s = pitch.settings();

  // Reject a position that brings too many players into the own penalty area.
  const Area own = pitch.penaltyArea(player.side());
  if (own.contains(x, y, s.agentRadius)) {
    int inside = 0;
    for (const Player& p : pitch.players())
      if (&p != &player && p.side() == player.side() && own.contains(p.position().x(), p.position().y())) ++inside;
    if (inside >= s.maxPlayersInsideOwnArea) return false;
  }

  // Reject a position behind a goal.
  if (std::abs(x) > s.fieldLength / 2 && std::abs(y) < s.goalWidth / 2 + s.agentRadius) return false;

  // Reject a position near the ball.
  const Vec3 ball = pitch.ballPosition();
  if (avoidBall && std::hypot(x - ball.x(), y - ball.y()) < std::max(2 * s.agentRadius, s.passModeMinOppBallDist))
    return false;

  // Reject a position inside another player.
  const Vec3 centre(x, y, s.agentRadius);
  return std::none_of(obstacles_.begin(), obstacles_.end(),
                      [&](const Bounds& b) { return b.intersectsSphere(centre, s.agentRadius); });
}

}  // namespace spark::soccer
