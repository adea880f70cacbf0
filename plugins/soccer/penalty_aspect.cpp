#include "penalty_aspect.h"

namespace spark {

using soccer::Foul;
using soccer::Pitch;
using soccer::Player;

void PenaltyAspect::rule(const Event& event) {
  GameStateAspect* game = game_.get();
  if (!game || !referee_) return;
  const Pitch& pitch = game->pitch();
  if (!pitch.ready()) return;
  follow(pitch);
  if (game->paused()) return records_.reset();
  for (std::size_t i = 0; i < records_.size(); ++i)
    if (!isFree(i)) serve(pitch, pitch.players()[i], records_[i], event.step);
}

void PenaltyAspect::call(const Pitch& pitch, std::size_t player, Foul foul, Penalty penalty, const Vec3& target) {
  if (!enabled() || !isFree(player)) return;
  records_[player] = {penalty, foul, 0, target};
  const Player& p = pitch.players()[player];
  ++count_;
  kernel().log().info("soccer: foul: {}, {} {}", foulName(foul), soccer::sideName(p.side()), p.state->unum());
}

void PenaltyAspect::report(const Player& player, Foul foul) {
  if (SoccerRuleAspect* referee = referee_.get())
    referee->reportFoul(static_cast<int>(foul), soccer::sideName(player.side()), player.state->unum());
}

void PenaltyAspect::serve(const Pitch& pitch, const Player& player, Record& record, double step) {
  if (record.penalty == Penalty::moveAside) {
    report(player, record.foul);
    pitch.moveSafely(player, record.target, true);
    record = {};
  } else if (record.cyclesHeld * step < pitch.settings().foulHoldTime - 1e-9) {
    ++record.cyclesHeld;
    report(player, record.foul);
    const Vec3 position = player.position();
    pitch.relocate(player, Vec3(position.x(), position.y(), kHoldHeight + kHoldRise * record.cyclesHeld));
  } else {
    pitch.moveOffField(player, pitch.settings().agentRadius);
    record = {};
  }
}

void PenaltyAspect::Record::save(StateWriter& out) const {
  out.write(static_cast<int>(penalty));
  out.write(static_cast<int>(foul));
  out.write(cyclesHeld);
  for (int i = 0; i < 3; ++i) out.write(target[i]);
}

void PenaltyAspect::Record::load(StateReader& in) {
  penalty = static_cast<Penalty>(in.readInteger());
  foul = static_cast<Foul>(in.readInteger());
  cyclesHeld = static_cast<int>(in.readInteger());
  for (int i = 0; i < 3; ++i) target[i] = in.readNumber();
}

}  // namespace spark
