#include "pass_mode_rule.h"

namespace spark {

using soccer::opponent;

namespace {
constexpr double kRounding = 1e-6;  // of sums of steps [s]

double groundDistance(const Vec3& a, const Vec3& b) { return std::hypot(a.x() - b.x(), a.y() - b.y()); }
}  // namespace

void PassModeRule::describe(Description<PassModeRule>& d) {
  using P = PassModeRule;
  d.doc("Pass mode: a team may pass a resting ball undisturbed, and may not score for a while afterwards.");
  d.property("scoreWaitLeft", &P::waitLeft).unit("s").doc("Time until goals of the left team count again.");
  d.property("scoreWaitRight", &P::waitRight).unit("s").doc("Time until goals of the right team count again.");
}

void PassModeRule::judge(const Event&) {
  if (modeSeen_ != game().modeChanges()) enterMode();
  if (in(PlayMode::passLeft)) judgePassMode();
  if (referee().playing())
    for (Side s : {Side::left, Side::right}) earnRightToScore(s);
  recordDistances();
}

void PassModeRule::enterMode() {
  // Set pieces end the bans of both teams, pass mode for one team that of the other.
  modeSeen_ = game().modeChanges();
  if (!referee().playing()) return reset();
  if (in(PlayMode::passLeft)) team(opponent(side())).cleared = true;
}

void PassModeRule::reset() {
  for (Team& t : teams_) t.lastActive = kNever, t.cleared = true;
}

void PassModeRule::judgePassMode() {
  const SoccerSettings& s = settings();
  if (ball().touched() || game().modeReached(s.passModeDuration)) return game().setMode(PlayMode::playOn);
  pitch().repel(opponent(side()), ball().position(), s.passModeMinOppBallDist, 1.1 * s.passModeMinOppBallDist,
                random());
  Team& t = team(side());
  t.lastActive = pitch().now();
  t.position = ball().position();
  t.cleared = t.ballAway = t.twoTouched = false;
  t.toucher = 0;
}

void PassModeRule::earnRightToScore(Side side) {
  Team& t = team(side);
  if (t.cleared) return;
  // The distance is that before a touch in this cycle moves the ball.
  t.ballAway |= (ball().position() - t.position).norm() >= settings().passModeMinOppBallDist;
  if (!ball().touched() || ball().last().side != side) return;
  if (t.toucher == 0) t.toucher = ball().last().unum;
  t.twoTouched |= t.toucher != ball().last().unum;
  t.cleared = t.twoTouched && t.ballAway;
}

double PassModeRule::scoreWait(Side side) const {
  const Team& t = team(side);
  if (t.cleared || !enabled() || !isLinked() || !referee().ready()) return 0;
  const double left = settings().passModeScoreWaitTime - (pitch().now() - t.lastActive);
  return left > kRounding ? left : 0;
}

PassModeRule::Refusal PassModeRule::request(const soccer::Player& player) {
  const Refusal why = enabled() && isLinked() && referee().ready() ? refusal(player) : Refusal::disabled;
  if (why == Refusal::none) game().setMode(forSide(PlayMode::passLeft, player.side()));
  return why;
}

std::string PassModeRule::text(Refusal refusal) {
  switch (refusal) {
    case Refusal::none:
      return {};
    case Refusal::disabled:
      return "expected an enabled PassModeRule, found a disabled one";
    case Refusal::mode:
      return "expected the mode PlayOn, found another";
    case Refusal::tooSoon:
      return "expected PassModeRetryWaitTime since the team's last pass mode, found less";
    case Refusal::touched:
      return "expected that no player of the team touches the ball, found one that does";
    case Refusal::fast:
      return "expected a ball of at most PassModeMaxBallSpeed, found a faster one";
    case Refusal::far:
      return "expected a player within PassModeMaxBallDist of the ball, also one cycle earlier, found it farther away";
    case Refusal::opponents:
      return "expected no opponent within PassModeMinOppBallDist of the ball, found one";
  }
  return {};
}

PassModeRule::Refusal PassModeRule::refusal(const soccer::Player& player) const {
  const SoccerSettings& s = settings();
  const Side mine = player.side();
  if (game().mode() != PlayMode::playOn) return Refusal::mode;
  if (pitch().now() - team(mine).lastActive < s.passModeRetryWaitTime - kRounding) return Refusal::tooSoon;
  if (ball().touchedBy(mine)) return Refusal::touched;
  if (pitch().ball()->state().linearVelocity.norm() > s.passModeMaxBallSpeed) return Refusal::fast;
  const Vec3 ballPosition = pitch().ballPosition();
  const auto distances = [&](const soccer::Player& p) {
    return std::pair(groundDistance(p.position(), ballPosition), team(p.side()).lastDistance(p.state->unum()));
  };
  const auto [distance, last] = distances(player);
  if (distance > s.passModeMaxBallDist || last < 0 || last > s.passModeMaxBallDist) return Refusal::far;
  for (const soccer::Player& p : pitch().players()) {
    if (p.side() != opponent(mine) || !p.torso) continue;
    const auto [opponents, opponentsLast] = distances(p);
    if (opponents < s.passModeMinOppBallDist || (opponentsLast >= 0 && opponentsLast < s.passModeMinOppBallDist))
      return Refusal::opponents;
  }
  return Refusal::none;
}

void PassModeRule::recordDistances() {
  for (Team& t : teams_) t.ballDistance.fill(Team::kUnknown);
  for (const soccer::Player& p : pitch().players())
    if (p.side() != Side::none && p.torso && p.state->unum() <= GameStateAspect::kTeamSize)
      team(p.side()).ballDistance[p.state->unum()] = groundDistance(p.position(), ball().position());
}

void PassModeRule::saveState(StateWriter& out) const {
  out.write(modeSeen_);
  for (const Team& t : teams_) {
    out.write(t.lastActive);
    for (bool b : {t.cleared, t.ballAway, t.twoTouched}) out.write(b);
    out.write(t.toucher);
    for (int i = 0; i < 3; ++i) out.write(t.position[i]);
    for (double d : t.ballDistance) out.write(d);
  }
}

void PassModeRule::loadState(StateReader& in) {
  modeSeen_ = in.readInteger();
  for (Team& t : teams_) {
    t.lastActive = in.readNumber();
    for (bool* b : {&t.cleared, &t.ballAway, &t.twoTouched}) *b = in.readBool();
    t.toucher = static_cast<int>(in.readInteger());
    for (int i = 0; i < 3; ++i) t.position[i] = in.readNumber();
    for (double& d : t.ballDistance) d = in.readNumber();
  }
}

}  // namespace spark
