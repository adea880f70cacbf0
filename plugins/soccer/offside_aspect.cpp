#include "offside_aspect.h"

namespace spark {

using soccer::opponent;
using soccer::PlayMode;
using soccer::Side;

bool OffsideAspect::isInPlay() {
  GameStateAspect* game = game_.get();
  BallStateAspect* ball = ball_.get();
  SoccerRuleAspect* referee = referee_.get();
  if (!game || !ball || !referee) return false;
  soccer::Pitch& pitch = game->pitch();
  if (!pitch.ready()) return false;
  const PlayMode mode = game->mode();
  if (mode == PlayMode::offsideLeft || mode == PlayMode::offsideRight) {
    pitch.placeBall(kickPosition_);
    if (game->modeTime() >= pitch.settings().ruleKickInPauseTime)
      referee->award(forSide(PlayMode::freeKickLeft, opponent(sideOf(mode))), kickPosition_);
    return false;
  }
  if (mode != PlayMode::playOn) marked_.fill(false);
  return mode == PlayMode::playOn;
}

void OffsideAspect::rule(const Event&) {
  // In the first cycle of PlayOn the touch is that of the restart: no offside.
  if (isInPlay() && ball_->newTouch() && game_->modeTime() > 0) judgeTouch(game_->pitch());
}

void OffsideAspect::rest(const Event&) {
  if (isInPlay()) marked_.fill(false);
}

void OffsideAspect::judgeTouch(soccer::Pitch& pitch) {
  const BallStateAspect::Touch& last = ball_->last();
  const bool offends = last.side == markedSide_ && last.unum <= GameStateAspect::kTeamSize && marked_[last.unum];
  marked_.fill(false);
  if (!offends) return mark(pitch, last.side, last.unum);
  kickPosition_ = Vec3(ball_->lastValid().x(), ball_->lastValid().y(), pitch.settings().ballRadius);
  kernel().log().info("soccer: offside, {} {}", soccer::sideName(last.side), last.unum);
  game_->setMode(forSide(PlayMode::offsideLeft, last.side));
}

void OffsideAspect::mark(const soccer::Pitch& pitch, Side side, int toucher) {
  markedSide_ = side;
  // x of the last and second-last opponent in the frame of `side`, which attacks towards +x.
  const double attack = direction(side);
  double last = -HUGE_VAL, second = -HUGE_VAL;
  for (const soccer::Player& p : pitch.players()) {
    if (p.side() != opponent(side)) continue;
    const double x = attack * p.position().x();
    if (x > last)
      second = std::exchange(last, x);
    else
      second = std::max(second, x);
  }
  const double line = std::max({0.0, attack * ball_->position().x(), second});
  for (const soccer::Player& p : pitch.players())
    if (p.side() == side && p.state->unum() != toucher && p.state->unum() <= GameStateAspect::kTeamSize)
      marked_[p.state->unum()] = attack * p.position().x() > line;
}

std::vector<int> OffsideAspect::markedUnums() const {
  std::vector<int> out;
  for (std::size_t n = 1; n < marked_.size(); ++n)
    if (marked_[n]) out.push_back(static_cast<int>(n));
  return out;
}

void OffsideAspect::saveState(StateWriter& out) const {
  for (bool m : marked_) out.write(m);
  out.write(static_cast<int>(markedSide_));
  for (int i = 0; i < 3; ++i) out.write(kickPosition_[i]);
}

void OffsideAspect::loadState(StateReader& in) {
  for (bool& m : marked_) m = in.readBool();
  markedSide_ = static_cast<Side>(in.readInteger());
  for (int i = 0; i < 3; ++i) kickPosition_[i] = in.readNumber();
}

}  // namespace spark
