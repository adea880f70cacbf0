#include "game_state_aspect.h"

#include <algorithm>
#include <utility>

#include "api/succession.h"
#include "init_action.h"
#include "team_material.h"

namespace spark {

using soccer::PlayMode;
using soccer::Side;

namespace {
constexpr double kQuitAfter = 10;  // after the match [s]
}

void GameStateAspect::describe(Description<GameStateAspect>& d) {
  using G = GameStateAspect;
  d.doc("Clock, half, play mode, score, teams and uniform numbers.");
  d.implements<IStatus>();
  d.implements<IJoinPolicy>();
  d.property("playMode", &G::modeText, &G::setModeText)
      .choices({soccer::kPlayModeNames.begin(), soccer::kPlayModeNames.end()})
      .state()
      .doc("The play mode. Setting it does not move the ball.");
  d.property("time", &G::time, &G::setTime)
      .unit("s")
      .min(0)
      .state()
      .doc("Time of play; stopped before kick-offs and after the match.");
  d.property("modeTime", &G::modeTime).unit("s").doc("Time since the play mode changed.");
  d.property("half", &G::half).doc("1 or 2.");
  d.property("score", &G::scoreList).doc("Goals of the left and of the right team.");
  d.property("teamLeft", &G::leftName).doc("Name of the team that defends the left goal, \"\" while it is unknown.");
  d.property("teamRight", &G::rightName).doc("Name of the team that defends the right goal, \"\" while it is unknown.");
  d.property("random", &G::random_).state().doc("The stream for coin tosses and shuffles.");
  d.method("kickOff", &G::kickOffDueSide).doc("Kick-off for the team that is due.");
  d.method("setScores", &G::setScores).parameters({"left", "right"}).doc("Sets the score.");
}

void GameStateAspect::setModeText(const std::string& name) {
  PlayMode mode = mode_;
  soccer::playModeFromName(name, mode);
  setMode(mode);
}

void GameStateAspect::setMode(PlayMode mode) {
  if (mode == mode_) return;
  // Log lines are limited: trainers can change the mode thousands of times in a cycle.
  if (modeLinesLeft_ > 0)
    --modeLinesLeft_, kernel().log().info("soccer: {:.2f} s, {} after {}", time_, soccer::playModeName(mode),
                                          soccer::playModeName(mode_));
  mode_ = mode;
  modeStart_ = time_;
  stoppedTime_ = 0;
  ++modeChanges_;
}

bool GameStateAspect::mayLogJoin() {
  const auto now = std::chrono::steady_clock::now();
  const std::chrono::duration<double> elapsed = now - std::exchange(joinLinesUpdated_, now);
  joinLinesLeft_ = std::min(kJoinLines, joinLinesLeft_ + elapsed.count());
  if (joinLinesLeft_ < 1) return false;
  --joinLinesLeft_;
  return true;
}

void GameStateAspect::report(std::vector<StatusEntry>& out) const {
  out.push_back({"playMode", modeText(), {}});
  out.push_back({"score", List{teams_[0].score, teams_[1].score}, {"Left", "Right"}});
  out.push_back({"teams", List{teams_[0].name, teams_[1].name}, {"Left", "Right"}});
}

std::string_view GameStateAspect::predicate() const { return soccer::kInit; }
IJoinPolicy::Name GameStateAspect::read(const Element& action) const { return soccer::readInit(action); }

void GameStateAspect::setScores(int left, int right) {
  teams_[0].score = std::max(0, left);
  teams_[1].score = std::max(0, right);
}

void GameStateAspect::rule(const Event& event) {
  modeLinesLeft_ = kModeLinesPerCycle;
  advance_ = 0;
  soccer::Pitch& p = pitch();
  if (!p.ready()) return;
  advanceHalf();
  advanceClock(event.step);
  if (mode_ == PlayMode::beforeKickOff && p.settings().automaticKickOff && modeReached(p.settings().waitBeforeKickOff))
    kickOff(Side::none);
  if (mode_ == PlayMode::gameOver && p.settings().automaticQuit && modeReached(kQuitAfter)) kernel().requestStop();
}

void GameStateAspect::advanceClock(double step) {
  if (clockRuns()) {
    const double before = time_;
    time_ = time_ < kSinglePrecisionUntil ? static_cast<float>(time_) + static_cast<float>(step) : time_ + step;
    advance_ = time_ - before;
  } else if (mode_ == PlayMode::gameOver || !pitch_.gameControl()->agents().empty()) {
    stoppedTime_ += step;
  }
}

void GameStateAspect::advanceHalf() {
  const SoccerSettings& s = pitch_.settings();
  const bool last = half_ == 2 || s.singleHalfTime;
  if (time_ < s.ruleHalfTime * (half_ == 2 ? 2 : 1) - kRounding) return;
  if (last) return setMode(PlayMode::gameOver);
  half_ = 2;
  kickedOffInHalf_ = false;
  setMode(PlayMode::beforeKickOff);
  if (s.changeSidesInSecondHalf) swapSides();
  for (const soccer::Player& p : pitch_.players()) p.state->setBattery(AgentState::kFullBattery);
}

void GameStateAspect::swapSides() {
  ++sideSwaps_;
  std::swap(teams_[0], teams_[1]);
  for (const soccer::Player& p : pitch_.players()) {
    if (p.side() == Side::none) continue;
    p.state->assign(soccer::opponent(p.side()), p.state->unum(), p.state->team(), pitch_.settings().announceSides);
    soccer::setTeamMaterials(*p.agent, p.side(), p.state->unum());
  }
  if (auto* scene = pitch_.scene()) scene->markModified();
}

Side GameStateAspect::halfKickOff() const {
  const Side first = firstKickOff_ == Side::none ? Side::left : firstKickOff_;
  // The other team kicks off the second half. If the teams have swapped sides, it is now on the first one's side.
  return half_ == 1 || pitch_.settings().changeSidesInSecondHalf ? first : soccer::opponent(first);
}

void GameStateAspect::kickOff(Side side) {
  soccer::Pitch& p = pitch();
  if (!p.ready()) return;
  if (side == Side::none) side = dueSide();
  kickedOffInHalf_ = true;
  p.placeBall(p.centre());
  setMode(forSide(PlayMode::kickOffLeft, side));
}

Side GameStateAspect::dueSide() {
  const auto coin = [this] { return random_.below(2) == 0 ? Side::left : Side::right; };
  if (kickedOffInHalf_) return coin();
  if (firstKickOff_ == Side::none) firstKickOff_ = pitch_.settings().coinTossForKickOff ? coin() : Side::left;
  return halfKickOff();
}

/// Team names are sent unquoted to all agents and monitors. A name with brackets could inject any percept.
static bool isPlainWord(std::string_view name) {
  return std::all_of(name.begin(), name.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte > 0x20 && byte != 0x7f && std::string_view("()\"';\\").find(c) == std::string_view::npos;
  });
}

Side GameStateAspect::sideFor(const std::string& name) const {
  for (Side s : {Side::left, Side::right})
    if (team(s).name == name) return s;
  for (Side s : {Side::left, Side::right})
    if (team(s).name.empty()) return s;
  for (Side s : {Side::left, Side::right})
    if (team(s).hasLeft()) return s;
  return Side::none;
}

bool GameStateAspect::vacate(Side side, soccer::Application& application, bool again) {
  const soccer::Player* holder = pitch_.player(side, static_cast<int>(application.unum));
  auto* succession = kernel().root().find<ISuccession>(IGameControl::kPath);
  if (!holder || !succession) return false;
  const auto outcome = succession->claim(*holder->agent, again);
  application.waiting = outcome == ISuccession::Claim::waiting;
  if (outcome != ISuccession::Claim::granted) return false;
  team(side).taken[application.unum] = false;
  holder->state->assign(Side::none, 0, {}, false);
  return true;
}

std::string GameStateAspect::join(AgentState& state, soccer::Application& application) {
  pitch();
  const bool again = std::exchange(application.waiting, false);
  const std::string& name = application.team;
  if (name.empty()) return "expected (teamname <name>) with a name, found none";
  if (!isPlainWord(name)) return "the team name holds a blank, a control character, or one of ( ) \" ' ; \\";
  // See contains the name up to 22 times, and clients read messages of at most 8 KiB.
  constexpr std::size_t kMaxNameBytes = 32;
  if (name.size() > kMaxNameBytes)
    return fmt::format("the team name has {} bytes, at most {} are allowed", name.size(), kMaxNameBytes);

  const Side side = sideFor(name);
  if (side == Side::none)
    return fmt::format("there are two teams already, '{}' and '{}': a third, '{}', cannot play", teams_[0].name,
                       teams_[1].name, name);

  // The number.
  const int maxUnum = pitch_.settings().teamSize;
  std::int64_t unum = application.unum;
  if (unum < 0 || unum > maxUnum) return fmt::format("number {} is not one of 1..{}", unum, maxUnum);
  Team& wanted = team(side);
  if (unum == 0)
    for (int n = maxUnum; n >= 1; --n)
      if (!wanted.has(n)) unum = n;
  if (unum == 0) return fmt::format("team '{}' has {} players already", name, maxUnum);
  if (wanted.has(static_cast<int>(unum)) && !vacate(side, application, again))
    return fmt::format("number {} of team '{}' is taken", unum, name);
  if (std::string problem = robotTypeProblem(side, state); !problem.empty()) return problem;

  // A team that comes in place of another one begins without goals.
  if (wanted.name != name && !wanted.name.empty()) {
    kernel().log().info("soccer: team '{}' plays in place of '{}', which has left", name, wanted.name);
    wanted = Team();
  }

  // An earlier number of the agent becomes free.
  if (state.side() != Side::none) team(state.side()).taken[state.unum()] = false;
  const bool first = state.side() == Side::none;
  wanted.name = name;
  if (wanted.taken.size() <= std::size_t(unum)) wanted.taken.resize(maxUnum + 1);
  wanted.taken[unum] = true;
  state.assign(side, static_cast<int>(unum), name, first);
  return {};
}

int GameStateAspect::teamSize() const {
  const auto* settings = kernel().root().find<SoccerSettings>();
  return settings ? settings->teamSize : kTeamSize;
}

std::string GameStateAspect::robotTypeProblem(Side side, const AgentState& joining) const {
  const SoccerSettings& s = pitch_.settings();
  // Count the team's robots by type; types from kMaxType on count as one.
  constexpr int kMaxType = 63;
  std::array<int, kMaxType + 1> count{};
  int types = 0, registered = 0, maxOtherType = 0;
  const int type = std::min(joining.robotType(), kMaxType);
  for (const soccer::Player& p : pitch_.players()) {
    if (p.state == &joining || p.side() != side) continue;
    ++registered;
    if (count[std::min(p.state->robotType(), kMaxType)]++ == 0) ++types;
  }
  for (int t = 0; t <= kMaxType; ++t)
    if (t != type) maxOtherType = std::max(maxOtherType, count[t]);

  if (count[type] >= s.maxRobotTypeCount)
    return fmt::format("the team has {} robots of type {} already", count[type], type);
  if (count[type] + maxOtherType + 1 > s.maxSumTwoRobotTypes)
    return fmt::format("more than {} robots of two types (type {} is one) are not allowed", s.maxSumTwoRobotTypes,
                       type);
  // The free places are needed for other types.
  if (count[type] > 0 && s.teamSize - registered <= s.minRobotTypesCount - types)
    return fmt::format("the team needs robots of {} types: type {} is there already", s.minRobotTypesCount, type);
  return {};
}

Vec3 GameStateAspect::nextStartPosition(Side side) {
  // The grid of the installed base: columns along y from the left touch line, spacing 3 r in y and 2 r in x.
  const SoccerSettings& s = pitch().settings();
  const double r = s.agentRadius, firstY = s.fieldWidth / 2 - 2 * r;
  const double spacingX = s.startDistance > 0 ? s.startDistance : 2 * r,
               spacingY = s.startDistance > 0 ? s.startDistance : 3 * r;
  const int perColumn = static_cast<int>((firstY + s.fieldWidth / 2) / spacingY) + 1;
  const int columns = std::max(1, static_cast<int>((s.fieldLength / 2 - 2 * r) / spacingX));
  const int n = team(side).starts++ % (perColumn * columns);
  const double firstX = -direction(side) * (s.fieldLength / 2 - 2 * r);
  const int column = n / perColumn;
  return {firstX + direction(side) * spacingX * column, firstY - spacingY * (n % perColumn), r};
}

void GameStateAspect::agentLeaving(AgentAspect& agent) {
  std::vector<AgentState*> states;
  agent.collect(states);
  for (const AgentState* s : states)
    if (s->side() != Side::none) team(s->side()).taken[s->unum()] = false;
}

void GameStateAspect::saveState(StateWriter& out) const {
  out.write(static_cast<int>(mode_));
  for (double v : {time_, modeStart_, stoppedTime_}) out.write(v);
  out.write(modeChanges_);
  out.write(sideSwaps_);
  out.write(half_);
  out.write(kickedOffInHalf_);
  out.write(static_cast<int>(firstKickOff_));
  for (const Team& t : teams_) {
    out.write(std::string_view(t.name));
    out.write(t.score);
    for (int n = 0; n <= teamSize(); ++n) out.write(t.has(n));
    out.write(t.starts);
  }
}

void GameStateAspect::loadState(StateReader& in) {
  mode_ = static_cast<PlayMode>(in.readInteger());
  for (double* v : {&time_, &modeStart_, &stoppedTime_}) *v = in.readNumber();
  modeChanges_ = in.readInteger();
  sideSwaps_ = in.readInteger();
  half_ = static_cast<int>(in.readInteger());
  kickedOffInHalf_ = in.readBool();
  firstKickOff_ = static_cast<Side>(in.readInteger());
  for (Team& t : teams_) {
    t.name = in.readString();
    t.score = static_cast<int>(in.readInteger());
    t.taken.assign(teamSize() + 1, 0);
    for (char& taken : t.taken) taken = in.readBool();
    t.starts = static_cast<int>(in.readInteger());
  }
}

}  // namespace spark
