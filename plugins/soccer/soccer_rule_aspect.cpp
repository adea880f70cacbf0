#include "soccer_rule_aspect.h"

#include "pass_mode_rule.h"

namespace spark {

using soccer::opponent;
using soccer::PlayMode;
using soccer::Side;

namespace {
constexpr std::size_t kMaxFouls = 64;
/// The rules, in the order in which they judge.
constexpr const char* kRules[] = {"BeforeKickOffRule", "KickOffRule",     "RestartRule", "GoalKickRule",
                                  "PassModeRule",      "DoubleTouchRule", "GoalRule",    "PenaltyShootoutRule",
                                  "BallOutRule",       "DropBallRule"};
}  // namespace

void SoccerRuleAspect::describe(Description<SoccerRuleAspect>& d) {
  using R = SoccerRuleAspect;
  d.doc(
      "The referee: the state that the rules of play share. It creates the rules below itself: KickOffRule, GoalRule, "
      "PassModeRule, ...");
  d.link(&SoccerRuleAspect::passMode_, Child<PassModeRule>());
  d.property("kickPosition", &R::kickPosition_)
      .unit("m")
      .readOnly()
      .state()
      .doc("Position of the current or last restart.");
  d.method("dropBall", &R::dropBall).parameters({"position [m]"}).doc("Drops the ball there and starts PlayOn.");
  d.method("reportFoul", &R::reportFoul)
      .parameters({"type", "team", "unum"})
      .doc("Reports a foul to monitors; team is left, right or none.");
}

void SoccerRuleAspect::onLink() {
  SoccerControlAspect::onLink();
  for (const char* name : kRules) create(name, name);
}

bool SoccerRuleAspect::findMatch() { return game_ && ball_ && game_->pitch().ready() && game_->pitch().ball(); }

void SoccerRuleAspect::rule(const Event&) {
  ready_ = findMatch();
  if (!ready_) return;
  mode_ = game_->mode();
  if (modeSeen_ != game_->modeChanges()) enterMode();
  lastKick_.update(*ball_);
}

void SoccerRuleAspect::enterMode() {
  // The mode was started by a rule (award() has set the position) or by a trainer.
  modeSeen_ = game_->modeChanges();
  if (isPlay(mode_)) return;
  if (positionGivenAt_ != modeSeen_) kickPosition_ = positionFor(mode_);
  lastKick_.reset();
  kickOffSide_ = Side::none;
}

void SoccerRuleAspect::award(PlayMode mode, const Vec3& position) {
  kickPosition_ = position;
  game_->setMode(mode);
  positionGivenAt_ = game_->modeChanges();
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
    case PlayMode::kickInRight:
      return kickInPosition();
    case PlayMode::kickOffLeft:
    case PlayMode::kickOffRight:
      return pitch().centre();
    default:
      return freeKickPosition();
  }
}

Vec3 SoccerRuleAspect::freeKickPosition() const {
  const Vec3& last = ball_->lastValid();
  return pitch().freeBallPosition(Vec3(last.x(), last.y(), settings().ballRadius));
}

Vec3 SoccerRuleAspect::goalKickPosition(Side side) const {
  const SoccerSettings& s = settings();
  return {-direction(side) * (s.fieldLength / 2 - s.goalKickDist), 0, s.ballRadius};
}

Vec3 SoccerRuleAspect::cornerPosition(Side defending) const {
  // Halfway between corner and goal, a compromise of the installed base from 2012.
  const SoccerSettings& s = settings();
  const double y = (s.fieldWidth + s.goalWidth) / 4 - s.ballRadius;
  return {-direction(defending) * (s.fieldLength / 2 - s.ballRadius), ball_->position().y() < 0 ? -y : y, s.ballRadius};
}

Vec3 SoccerRuleAspect::kickInPosition() const {
  const SoccerSettings& s = settings();
  const double y = s.fieldWidth / 2 - s.ballRadius;
  return {ball_->lastValid().x(), ball_->position().y() < 0 ? -y : y, s.ballRadius};
}

void SoccerRuleAspect::taken(bool indirect) {
  lastKick_.taken(ball_->last(), indirect);
  game_->setMode(PlayMode::playOn);
}

void SoccerRuleAspect::dropBall(const Vec3& position) {
  if (!findMatch()) return;
  const Vec3 target = pitch().freeBallPosition(position);
  pitch().placeBall(target);
  const SoccerSettings& s = settings();
  pitch().bothSides(game_->random(), [&](Side side) {
    pitch().clearSphere(side, target, s.freeKickDistance, s.freeKickMoveDist, game_->random());
  });
  lastKick_.reset();
  kickOffSide_ = Side::none;
  if (PassModeRule* pass = passMode()) pass->reset();
  game_->setMode(PlayMode::playOn);
}

void SoccerRuleAspect::reportFoul(int type, const std::string& team, int unum) {
  if (fouls_.size() >= kMaxFouls) fouls_.erase(fouls_.begin());
  fouls_.push_back({++foulCount_, type,
                    team == "left"    ? Side::left
                    : team == "right" ? Side::right
                                      : Side::none,
                    unum});
}

void SoccerRuleAspect::saveState(StateWriter& out) const {
  out.write(static_cast<int>(mode_));
  out.write(modeSeen_);
  out.write(positionGivenAt_);
  for (int i = 0; i < 3; ++i) out.write(kickPosition_[i]);
  lastKick_.save(out);
  out.write(static_cast<int>(kickOffSide_));
  out.write(foulCount_);
}

void SoccerRuleAspect::loadState(StateReader& in) {
  mode_ = static_cast<PlayMode>(in.readInteger());
  modeSeen_ = in.readInteger();
  positionGivenAt_ = in.readInteger();
  for (int i = 0; i < 3; ++i) kickPosition_[i] = in.readNumber();
  lastKick_.load(in);
  kickOffSide_ = static_cast<Side>(in.readInteger());
  foulCount_ = in.readInteger();
}

}  // namespace spark
