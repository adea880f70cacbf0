#include "soccer_rule_aspect.h"

namespace spark {

using soccer::Area;
using soccer::opponent;
using soccer::PlayMode;
using soccer::Side;

namespace {
constexpr double kTouchDelay = 0.03;  ///< s after the pause before a touch takes a restart
constexpr std::size_t kFoulsKept = 64;
}  // namespace

void SoccerRuleAspect::describe(Description<SoccerRuleAspect>& d) {
  using R = SoccerRuleAspect;
  d.doc("The referee: restarts, goals, the ball leaving the field, clearing of players.");
  d.property("kickPosition", &R::kickPosition_).unit("m").readOnly().state().doc("Where the current or last restart is taken.");
  d.method("dropBall", &R::dropBall).parameters({"where [m]"}).doc("Drops the ball there; play goes on.");
  d.method("reportFoul", &R::reportFoul).parameters({"type", "team", "unum"}).doc("Tells monitors of a foul; team is left, right or none.");
}

void SoccerRuleAspect::rule(const Event&) {
  GameStateAspect* game = beside(game_, gameVersion_);
  BallStateAspect* ball = beside(ball_, ballVersion_);
  if (!game || !ball) return;
  pitch_ = &game->pitch();
  if (!pitch_->ready() || !pitch_->ball()) return;
  if (modeSeen_ != game->modeChanges()) enterMode();
  const PlayMode mode = game->mode();
  const Side side = sideOf(mode);
  switch (mode) {
    case PlayMode::beforeKickOff:
      return beforeKickOff();
    case PlayMode::kickOffLeft:
    case PlayMode::kickOffRight:
      return kickOff(side);
    case PlayMode::playOn:
      return playOn();
    case PlayMode::kickInLeft:
    case PlayMode::kickInRight:
    case PlayMode::cornerKickLeft:
    case PlayMode::cornerKickRight:
    case PlayMode::freeKickLeft:
    case PlayMode::freeKickRight:
    case PlayMode::directFreeKickLeft:
    case PlayMode::directFreeKickRight:
      return restart(side);
    case PlayMode::goalKickLeft:
    case PlayMode::goalKickRight:
      return goalKick(side);
    case PlayMode::goalLeft:
    case PlayMode::goalRight:
      return goalPause(side);
    case PlayMode::passLeft:
    case PlayMode::passRight:
      return passMode(side);
    case PlayMode::offsideLeft:
    case PlayMode::offsideRight:
    case PlayMode::gameOver:
      return;
  }
}

/// A mode began, by the rules or by a trainer.
void SoccerRuleAspect::enterMode() {
  modeSeen_ = game_->modeChanges();
  const PlayMode mode = game_->mode();
  repelled_ = false;
  if (mode == PlayMode::playOn) return;
  if (!positionGiven_) kickPosition_ = positionFor(mode);
  positionGiven_ = false;
  taker_ = 0;
  takerTouching_ = false;
  kickOffSide_ = Side::none;
}

void SoccerRuleAspect::award(PlayMode mode, const Vec3& where) {
  kickPosition_ = where;
  positionGiven_ = true;
  game_->setMode(mode);
}

Vec3 SoccerRuleAspect::positionFor(PlayMode mode) const {
  switch (mode) {
    case PlayMode::goalKickLeft:
    case PlayMode::goalKickRight:
      return goalKickPosition(sideOf(mode));
    case PlayMode::cornerKickLeft:
    case PlayMode::cornerKickRight:
      return cornerPosition(opponent(sideOf(mode)));
    case PlayMode::kickInLeft:
    case PlayMode::kickInRight: {
      const double y = pitch_->settings().fieldWidth / 2 - pitch_->settings().ballRadius;
      return {ball_->lastValid().x(), ball_->position().y() < 0 ? -y : y, pitch_->settings().ballRadius};
    }
    default:
      return pitch_->freeBallPosition(ball_->lastValid());
  }
}

Vec3 SoccerRuleAspect::goalKickPosition(Side side) const {
  const SoccerSettings& s = pitch_->settings();
  return {-direction(side) * (s.fieldLength / 2 - s.goalKickDist), 0, s.ballRadius};
}

Vec3 SoccerRuleAspect::cornerPosition(Side defending) const {
  // between corner and goal: the installed base's compromise of 2012
  const SoccerSettings& s = pitch_->settings();
  const double y = (s.fieldWidth + s.goalWidth) / 4 - s.ballRadius;
  return {-direction(defending) * (s.fieldLength / 2 - s.ballRadius), ball_->position().y() < 0 ? -y : y, s.ballRadius};
}

void SoccerRuleAspect::beforeKickOff() {
  if (pitch_->players().empty()) return;
  pitch_->placeBall(pitch_->centre());
  if (pitch_->settings().startAnyFieldPosition) return;
  for (Side s : {Side::left, Side::right})
    pitch_->clearArea(s, pitch_->opponentHalf(s), pitch_->settings().freeKickMoveDist, game_->random());
}

void SoccerRuleAspect::clearForKickOff(Side side) {
  const SoccerSettings& s = pitch_->settings();
  const Side other = opponent(side);
  pitch_->clearArea(other, pitch_->opponentHalf(other), s.freeKickMoveDist, game_->random());
  pitch_->clearSphere(other, pitch_->centre(), s.freeKickDistance, s.freeKickMoveDist, game_->random());
  // the kicking team may stand in the other half only wholly inside the circle
  for (const soccer::Player& p : pitch_->players()) {
    if (p.side() != side || !p.torso) continue;
    const soccer::Bounds b = p.bounds();
    if (b.empty() || !pitch_->opponentHalf(side).touches(b)) continue;
    const double farX = std::max(std::abs(b.low.x()), std::abs(b.high.x())), farY = std::max(std::abs(b.low.y()), std::abs(b.high.y()));
    if (std::hypot(farX, farY) < s.freeKickDistance) continue;
    Vec3 target = p.position();
    target.x() = -direction(side) * s.freeKickMoveDist;
    pitch_->moveSafely(p, target, true);
  }
}

void SoccerRuleAspect::kickOff(Side side) {
  clearForKickOff(side);
  if (ball_->touched() && game_->modeTime() > 0) {
    taken(true);
    kickOffSide_ = side;
  } else {
    dropBallIfLate(pitch_->centre());
  }
}

void SoccerRuleAspect::restart(Side side) {
  const SoccerSettings& s = pitch_->settings();
  if (game_->modeTime() < s.ruleKickInPauseTime || dropBallIfLate(kickPosition_)) return;
  pitch_->clearSphere(opponent(side), kickPosition_, s.freeKickDistance, s.freeKickMoveDist, game_->random());
  repelOnce(side, kickPosition_);
  const PlayMode mode = game_->mode();
  if (ball_->touched() && game_->modeTime() > s.ruleKickInPauseTime + kTouchDelay)
    taken(mode == PlayMode::kickInLeft || mode == PlayMode::kickInRight || mode == PlayMode::freeKickLeft ||
          mode == PlayMode::freeKickRight);
  else
    pitch_->placeBall(kickPosition_);
}

void SoccerRuleAspect::goalKick(Side side) {
  const SoccerSettings& s = pitch_->settings();
  if (game_->modeTime() < s.ruleKickInPauseTime || dropBallIfLate(kickPosition_)) return;
  const Area area = pitch_->penaltyArea(side);
  pitch_->clearArea(opponent(side), area, s.freeKickMoveDist, game_->random());
  repelOnce(side, kickPosition_);
  if (ball_->touched() && game_->modeTime() > s.ruleKickInPauseTime + kTouchDelay) {
    taker_ = ball_->last().agent;
    takerContact_ = ball_->last().time;
    takerTouching_ = true;
    indirect_ = false;
  }
  if (!taker_) return pitch_->placeBall(kickPosition_);
  if (!area.contains(ball_->position().x(), ball_->position().y()) || !ball_->onField()) game_->setMode(PlayMode::playOn);
}

/// The restart is taken by who touches the ball now.
void SoccerRuleAspect::taken(bool indirect) {
  taker_ = ball_->last().agent;
  takerContact_ = ball_->last().time;
  takerTouching_ = true;
  indirect_ = indirect;
  game_->setMode(PlayMode::playOn);
}

void SoccerRuleAspect::repelOnce(Side side, const Vec3& from) {
  if (repelled_) return;
  repelled_ = true;
  pitch_->repel(side, from, pitch_->settings().kickRepelDist, pitch_->settings().kickRepelDist, game_->random());
}

bool SoccerRuleAspect::dropBallIfLate(const Vec3& where) {
  if (game_->modeTime() < pitch_->settings().ruleDropBallTime) return false;
  dropBall(where);
  return true;
}

void SoccerRuleAspect::dropBall(const Vec3& where) {
  GameStateAspect* game = beside(game_, gameVersion_);
  if (!game) return;
  pitch_ = &game->pitch();
  if (!pitch_->ready()) return;
  const SoccerSettings& s = pitch_->settings();
  const Vec3 target = pitch_->freeBallPosition(where);
  pitch_->placeBall(target);
  const Side first = game->random().below(2) == 0 ? Side::left : Side::right;
  for (Side side : {first, opponent(first)}) pitch_->clearSphere(side, target, s.freeKickDistance, s.freeKickMoveDist, game->random());
  taker_ = 0;
  takerTouching_ = false;
  kickOffSide_ = Side::none;
  game->setMode(PlayMode::playOn);
}

void SoccerRuleAspect::goalPause(Side scorer) {
  const Side conceding = opponent(scorer);
  clearForKickOff(conceding);
  if (game_->modeTime() >= pitch_->settings().ruleGoalPauseTime) game_->kickOff(conceding);
}

void SoccerRuleAspect::passMode(Side side) {
  const SoccerSettings& s = pitch_->settings();
  if (game_->modeTime() >= s.passModeDuration || ball_->newTouch()) return game_->setMode(PlayMode::playOn);
  pitch_->repel(opponent(side), ball_->position(), s.passModeMinOppBallDist, 1.1 * s.passModeMinOppBallDist, game_->random());
  playOn();
}

void SoccerRuleAspect::playOn() {
  if (doubleTouch()) return;
  earnRightToScore();
  if (goal()) return;
  if (!ball_->onField()) ballOut();
}

/// With a single opponent, or in a shoot-out, a restart is not restricted.
bool SoccerRuleAspect::restricted() const { return pitch_->players().size() > 2 && !pitch_->settings().penaltyShootout; }

/// True when the taker of a restart touched the ball again before anybody else did.
bool SoccerRuleAspect::doubleTouch() {
  if (!taker_ || !ball_->touched()) return false;
  const BallStateAspect::Touch& last = ball_->last();
  if (last.agent != taker_) {
    taker_ = 0;
    takerTouching_ = false;
    return false;
  }
  const bool again = last.time - takerContact_ >= BallStateAspect::kContactGap;
  takerContact_ = last.time;
  if (!again) return false;
  takerTouching_ = false;
  taker_ = 0;
  if (!restricted()) return false;
  award(forSide(PlayMode::freeKickLeft, opponent(last.side)), pitch_->freeBallPosition(ball_->lastValid()));
  return true;
}

void SoccerRuleAspect::earnRightToScore() {
  if (kickOffSide_ == Side::none || !ball_->touched()) return;
  const Vec3& b = ball_->position();
  if (ball_->last().side != kickOffSide_ || std::hypot(b.x(), b.y()) > pitch_->settings().freeKickDistance) kickOffSide_ = Side::none;
}

bool SoccerRuleAspect::goal() {
  const Side goalOf = ball_->inGoalOf();
  if (goalOf == Side::none) return false;
  const Side scorer = opponent(goalOf);
  // a goal does not count: a goal kick, or after an own goal a corner
  const auto refuse = [&](bool own) {
    if (own)
      award(forSide(PlayMode::cornerKickLeft, scorer), cornerPosition(goalOf));
    else
      award(forSide(PlayMode::goalKickLeft, goalOf), goalKickPosition(goalOf));
  };
  if (restricted() && kickOffSide_ != Side::none) {
    refuse(kickOffSide_ == goalOf);
  } else if (const bool own = ball_->last().side == goalOf; restricted() && takerTouching_ && taker_ && (indirect_ || own)) {
    refuse(own);
  } else {
    countGoal(goalOf);
  }
  return true;
}

void SoccerRuleAspect::countGoal(Side goalOf) {
  const Side scorer = opponent(goalOf);
  game_->addGoal(scorer);
  const BallStateAspect::Touch& last = ball_->last();
  kernel().log().info("soccer: goal for {}, {} : {}, last touch by {} {}", soccer::sideName(scorer), game_->score(Side::left),
                      game_->score(Side::right), soccer::sideName(last.side), last.unum);
  game_->setMode(forSide(PlayMode::goalLeft, scorer));
}

void SoccerRuleAspect::ballOut() {
  const SoccerSettings& s = pitch_->settings();
  const Vec3& p = ball_->position();
  const Side last = ball_->last().side;
  if (last == Side::none) return pitch_->placeBall(Vec3(ball_->lastValid().x(), ball_->lastValid().y(), s.ballRadius));
  if (std::abs(p.x()) >= s.fieldLength / 2 + s.ballRadius) {
    const Side defending = p.x() < 0 ? Side::left : Side::right;
    if (last == opponent(defending))
      award(forSide(PlayMode::goalKickLeft, defending), goalKickPosition(defending));
    else
      award(forSide(PlayMode::cornerKickLeft, opponent(defending)), cornerPosition(defending));
  } else {
    const double y = s.fieldWidth / 2 - s.ballRadius;
    award(forSide(PlayMode::kickInLeft, opponent(last)), Vec3(ball_->lastValid().x(), p.y() < 0 ? -y : y, s.ballRadius));
  }
}

void SoccerRuleAspect::reportFoul(int type, std::string team, int unum) {
  if (fouls_.size() >= kFoulsKept) fouls_.erase(fouls_.begin());
  fouls_.push_back({++foulCount_, type, team == "left" ? Side::left : team == "right" ? Side::right : Side::none, unum});
}

void SoccerRuleAspect::saveState(StateWriter& out) const {
  out.write(modeSeen_);
  for (int i = 0; i < 3; ++i) out.write(kickPosition_[i]);
  out.write(taker_);
  out.write(takerContact_);
  for (bool b : {positionGiven_, repelled_, takerTouching_, indirect_}) out.write(b);
  out.write(static_cast<int>(kickOffSide_));
  out.write(foulCount_);
}

void SoccerRuleAspect::loadState(StateReader& in) {
  modeSeen_ = in.readInteger();
  for (int i = 0; i < 3; ++i) kickPosition_[i] = in.readNumber();
  taker_ = static_cast<int>(in.readInteger());
  takerContact_ = in.readNumber();
  for (bool* b : {&positionGiven_, &repelled_, &takerTouching_, &indirect_}) *b = in.readBool();
  kickOffSide_ = static_cast<Side>(in.readInteger());
  foulCount_ = in.readInteger();
}

}  // namespace spark
