#include "incapable_foul_aspect.h"

namespace spark {

namespace {
constexpr double kUpTime = 0.5;  // of standing after which a player is no longer down, as in the installed base [s]
/// True when `cycles` of `step` last longer than `seconds`.
bool exceeds(int cycles, double step, double seconds) { return cycles * step > seconds + 1e-9; }
}  // namespace

void IncapableFoulAspect::judgePlay(const Event& event) {
  follow(clocks_);
  for (std::size_t i = 0; i < players().size(); ++i) {
    if (!isJudged(i)) {
      clocks_[i] = {};
      continue;
    }
    advance(clocks_[i], players()[i], event.step);
    if (isOver(clocks_[i], isGoalie(i), event.step)) sendOff(i, Foul::incapable);
  }
}

void IncapableFoulAspect::advance(Clock& clock, const soccer::Player& player, double step) const {
  if (isDown(player)) {
    ++clock.down;
    clock.standing = 0;
    if (player.position().z() < kGroundHeight) ++clock.ground;
  } else {
    ++clock.standing;
    if (exceeds(clock.standing, step, kUpTime)) clock.down = 0;
  }
  if (player.position().z() >= kStandingHeight) clock.ground = 0;
}

bool IncapableFoulAspect::isOver(const Clock& clock, bool goalie, double step) const {
  const SoccerSettings& s = settings();
  return exceeds(clock.ground, step, goalie ? s.goalieGroundMaxTime : s.groundMaxTime) ||
         exceeds(clock.down, step, goalie ? s.goalieNotStandingMaxTime : s.notStandingMaxTime);
}

void IncapableFoulAspect::Clock::save(StateWriter& out) const {
  for (int n : {ground, down, standing}) out.write(n);
}

void IncapableFoulAspect::Clock::load(StateReader& in) {
  for (int* n : {&ground, &down, &standing}) *n = static_cast<int>(in.readInteger());
}

}  // namespace spark
