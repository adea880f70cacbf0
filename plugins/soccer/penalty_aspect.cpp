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

void PenaltyAspect::call(const Pitch& pitch, std::size_t player, Foul foul, Sentence sentence, const Vec3& target) {
  if (!enabled() || !isFree(player)) return;
  records_[player] = {sentence, foul, 0, target};
  const Player& p = pitch.players()[player];
  ++count_;
  kernel().log().info("soccer: foul: {}, {} {}", foulName(foul), soccer::sideName(p.side()), p.state->unum());
}

void PenaltyAspect::report(const Player& player, Foul foul) {
  if (SoccerRuleAspect* referee = referee_.get())
    referee->reportFoul(static_cast<int>(foul), soccer::sideName(player.side()), player.state->unum());
}

void PenaltyAspect::serve(const Pitch& pitch, const Player& player, Record& record, double step) {
  if (record.sentence == Sentence::aside) {
    report(player, record.foul);
    pitch.moveSafely(player, record.target, true);
    record = {};
  } else if (record.held * step < pitch.settings().foulHoldTime - 1e-9) {
    ++record.held;
    report(player, record.foul);
    const Vec3 here = player.position();
    pitch.hold(player, Vec3(here.x(), here.y(), kHoldHeight + kHoldRise * record.held));
  } else {
    pitch.putOutside(player, pitch.settings().agentRadius);
    record = {};
  }
}

void PenaltyAspect::Record::save(StateWriter& out) const {
  out.write(static_cast<int>(sentence));
  out.write(static_cast<int>(foul));
  out.write(held);
  for (int i = 0; i < 3; ++i) out.write(target[i]);
}

void PenaltyAspect::Record::load(StateReader& in) {
  sentence = static_cast<Sentence>(in.readInteger());
  foul = static_cast<Foul>(in.readInteger());
  held = static_cast<int>(in.readInteger());
  for (int i = 0; i < 3; ++i) target[i] = in.readNumber();
}

}  // namespace spark
