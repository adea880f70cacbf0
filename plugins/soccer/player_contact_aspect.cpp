#include "player_contact_aspect.h"

#include "game_state_aspect.h"

namespace spark {

using soccer::Side;

void PlayerContactAspect::rule(const Event&) {
  pairs_.clear();
  group_.clear();
  touchesBall_.clear();
  GameStateAspect* game = game_.get();
  if (game && game->pitch().ready()) {
    pitch_ = &game->pitch();
    touchesBall_.resize(pitch_->players().size());
    // Each player starts in a group of its own.
    for (std::size_t i = 0; i < pitch_->players().size(); ++i) group_.push_back(static_cast<int>(i));
    for (const Report& r : reports_) {
      const int self = playerOf(r.self);
      if (self < 0) continue;
      if (!r.other) {
        touchesBall_[self] = 1;
      } else if (const int other = playerOf(r.other); other >= 0 && other != self) {
        addContact(std::min(self, other), std::max(self, other), r.point);
      }
    }
    // So far, `point` is the sum of the contact points.
    for (Pair& p : pairs_) p.point /= p.points;
  }
  reports_.clear();
}

int PlayerContactAspect::playerOf(const AgentAspect* agent) const {
  const auto& players = pitch_->players();
  for (std::size_t i = 0; i < players.size(); ++i)
    if (players[i].agent == agent) return players[i].side() == Side::none ? -1 : static_cast<int>(i);
  return -1;
}

void PlayerContactAspect::addContact(int a, int b, const Vec3& point) {
  auto pair = std::find_if(pairs_.begin(), pairs_.end(), [&](const Pair& p) { return p.a == a && p.b == b; });
  if (pair == pairs_.end()) {
    pair = pairs_.insert(pairs_.end(), Pair{a, b});
    mergeGroups(a, b);
  }
  pair->point += point;
  ++pair->points;
}

void PlayerContactAspect::mergeGroups(int a, int b) {
  const int keep = std::min(group_[a], group_[b]), drop = std::max(group_[a], group_[b]);
  std::replace(group_.begin(), group_.end(), drop, keep);
}

}  // namespace spark
