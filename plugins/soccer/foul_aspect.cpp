#include "foul_aspect.h"

namespace spark {

void FoulAspect::judge(const Event& event) {
  if (!penalties_) return idle();
  penalties_->follow(pitch());
  if (game().paused())
    reset();
  else
    judgePlay(event);
}

bool FoulAspect::isDown(const soccer::Player& player) const {
  // The limits of the installed base; 0.1 m beyond the touch lines still count as field.
  const Vec3 p = player.position();
  return p.z() < kStandingHeight && std::abs(p.y()) < settings().fieldWidth / 2 + 0.1;
}

bool FoulAspect::inOwnArea(const soccer::Player& player) const {
  const Vec3 p = player.position();
  return pitch().penaltyArea(player.side()).contains(p.x(), p.y());
}

}  // namespace spark
