#include "safe_place.h"

#include <algorithm>
#include <cmath>

#include "pitch.h"

namespace spark::soccer {

namespace {
constexpr int kMostAttempts = 1000;  // a search is quadratic in them
}

Vec3 SafePlace::find(const Pitch& pitch, const Player& player, const Vec3& target, bool avoidBall) {
  others_.clear();
  for (const Player& p : pitch.players())
    if (&p != &player) others_.push_back(p.bounds());
  if (isSafe(pitch, player, target.x(), target.y(), avoidBall)) return target;
  from_ = player.position();
  target_ = target;
  stepX_ = -direction(player.side()) * pitch.settings().agentRadius;
  stepY_ = (target.y() < 0 ? -1 : 1) * pitch.settings().agentRadius;
  open_.clear();
  seen_.clear();
  propose(1, 0);
  propose(0, 1);
  const int attempts = std::min(pitch.settings().maxNumSafeRepositionAttempts, kMostAttempts);
  for (int n = 0; n < attempts; ++n) {
    const Candidate c = nearest();
    const Vec3 place(target.x() + stepX_ * c.i, target.y() + stepY_ * c.j, target.z());
    if (isSafe(pitch, player, place.x(), place.y(), avoidBall)) return place;
    propose(c.i + 1, c.j);
    propose(c.i, c.j + 1);
  }
  return target;
}

void SafePlace::propose(int i, int j) {
  if (std::find(seen_.begin(), seen_.end(), std::pair(i, j)) != seen_.end()) return;
  seen_.emplace_back(i, j);
  open_.push_back({i, j, std::hypot(target_.x() + stepX_ * i - from_.x(), target_.y() + stepY_ * j - from_.y())});
}

/// Takes it out. Among equals the first proposed.
SafePlace::Candidate SafePlace::nearest() {
  const auto at = std::min_element(open_.begin(), open_.end(),
                                   [](const Candidate& a, const Candidate& b) { return a.distance < b.distance; });
  const Candidate c = *at;
  open_.erase(at);
  return c;
}

bool SafePlace::isSafe(const Pitch& pitch, const Player& player, double x, double y, bool avoidBall) const {
  const SoccerSettings& s = pitch.settings();
  const Area own = pitch.penaltyArea(player.side());
  if (own.contains(x, y, s.agentRadius)) {
    int inside = 0;
    for (const Player& p : pitch.players())
      if (&p != &player && p.side() == player.side() && own.contains(p.position().x(), p.position().y())) ++inside;
    if (inside >= s.maxPlayersInsideOwnArea) return false;
  }
  if (std::abs(x) > s.fieldLength / 2 && std::abs(y) < s.goalWidth / 2 + s.agentRadius) return false;
  const Vec3 ball = pitch.ballPosition();
  if (avoidBall && std::hypot(x - ball.x(), y - ball.y()) < std::max(2 * s.agentRadius, s.passModeMinOppBallDist))
    return false;
  const Vec3 here(x, y, s.agentRadius);
  return std::none_of(others_.begin(), others_.end(),
                      [&](const Bounds& b) { return b.touchesSphere(here, s.agentRadius); });
}

}  // namespace spark::soccer
