#include "player_contact_aspect.h"

#include "game_state_aspect.h"

namespace spark {

using soccer::Side;

void PlayerContactAspect::rule(const Event&) {
  meetings_.clear();
  group_.clear();
  atBall_.clear();
  GameStateAspect* game = game_.get();
  if (game && game->pitch().ready()) {
    pitch_ = &game->pitch();
    atBall_.resize(pitch_->players().size());
    for (std::size_t i = 0; i < pitch_->players().size(); ++i) group_.push_back(static_cast<int>(i));
    for (const Told& t : told_) {
      const int self = playerOf(t.self);
      if (self < 0) continue;
      if (!t.other) {
        atBall_[self] = 1;
      } else if (const int other = playerOf(t.other); other >= 0 && other != self) {
        meet(std::min(self, other), std::max(self, other), t.point);
      }
    }
    for (Meeting& m : meetings_) m.point /= m.points;
  }
  told_.clear();
}

int PlayerContactAspect::playerOf(const AgentAspect* agent) const {
  const auto& players = pitch_->players();
  for (std::size_t i = 0; i < players.size(); ++i)
    if (players[i].agent == agent) return players[i].side() == Side::none ? -1 : static_cast<int>(i);
  return -1;
}

void PlayerContactAspect::meet(int a, int b, const Vec3& point) {
  auto known = std::find_if(meetings_.begin(), meetings_.end(), [&](const Meeting& m) { return m.a == a && m.b == b; });
  if (known == meetings_.end()) {
    known = meetings_.insert(meetings_.end(), Meeting{a, b});
    join(a, b);
  }
  known->point += point;
  ++known->points;
}

void PlayerContactAspect::join(int a, int b) {
  const int keep = std::min(group_[a], group_[b]), drop = std::max(group_[a], group_[b]);
  std::replace(group_.begin(), group_.end(), drop, keep);
}

}  // namespace spark
