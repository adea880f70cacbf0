#include "gamecontrol/game_control.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "gamecontrol/scene_effector.h"
#include "spark/error.h"
#include "spark/state.h"

namespace spark {

namespace {
/// So many messages to an agent that has not sent (syn) yet leave no faster than joinPace, others waiting or not.
constexpr std::int64_t kPacedMessages = 50;
/// Who keeps a cycle waiting for longer is slow [s].
constexpr double kSlow = 1;

/// The participant so many places on, or nullptr.
template <class Participants>
auto* next(const Participants& all, std::size_t i, std::size_t places) {
  return i + places < all.size() ? all[i + places].get() : nullptr;
}

double seconds(std::chrono::steady_clock::duration d) { return std::chrono::duration<double>(d).count(); }
}  // namespace

void GameControl::describe(Description<GameControl>& d) {
  d.doc("Makes agents of connections and behaviours, dispatches their actions, asks their perceptors.");
  d.link(&GameControl::joinPolicy_, Child<IJoinPolicy>()).doc("Reads who joins; without it agents have no names.");
  d.property("createEffector", &GameControl::createEffector_)
      .doc("Class of the effector with which an agent asks for its robot.");
  d.property("expect", &GameControl::expect_)
      .range(0, 1000)
      .doc(
          "Holds the clock at cycle 0 until so many agents have named their robot and, where a game has names for "
          "them, "
          "themselves, and have sent syn; they are numbered by team and number.");
  d.property("maxAgents", &GameControl::maxAgents_)
      .range(0, 1000)
      .doc("Further agents are closed; clients that never said anything do not count.");
  d.property("maxPending", &GameControl::maxPending_)
      .unit("bytes")
      .range(1024, 1 << 28)
      .doc("A client that sends more within one cycle is closed.");
  d.property("loadsPerCycle", &GameControl::loadsPerCycle_)
      .min(1)
      .doc(
          "In real time so many robots are loaded in one cycle at most, the others in the next ones; elsewhere all at "
          "once.");
  d.property("perceptDelay", &GameControl::perceptDelay_)
      .range(0, 1)
      .doc("Cycles between sensing and sending; the installed base has 1.");
  d.property("agentStep", &GameControl::agentStep_)
      .unit("s")
      .min(0)
      .doc(
          "Simulated time between two turns of the agents, in which they act and sense; no more than one turn a "
          "cycle.");
  d.property("sync", &GameControl::sync_).doc("Waits for the agents' (syn) although the run loop is not in lockstep.");
  d.property("robotFolder", &GameControl::robotFolder_)
      .doc("Agents' robots are scene files below this folder, e.g. rsg/agent/; empty: anywhere.");
  d.property("holdWait", &GameControl::holdWait_)
      .unit("s")
      .min(0)
      .doc("Expected agents that named a robot and are silent for so long get a first message (wall clock).");
  d.property("syncTimeout", &GameControl::syncTimeout_)
      .unit("s")
      .min(0)
      .doc("Lockstep: an agent that does not answer for so long is closed (wall clock); 0: never.");
  d.property("holdReport", &GameControl::holdReport_)
      .unit("s")
      .min(0)
      .doc("While expected agents are waited for: time between two lines on who they are (wall clock).");
  d.property("joinWait", &GameControl::joinWait_)
      .unit("s")
      .min(0)
      .doc(
          "When expected agents are waited for and nothing more came from any for so long, the match starts with those "
          "that named a robot (wall clock); 0: never.");
  d.property("joinBudget", &GameControl::joinBudget, &GameControl::setJoinBudget)
      .unit("s")
      .min(0)
      .doc(
          "Lockstep: what agents that were not expected and are new, or slow, may keep all others waiting in sum (wall "
          "clock); it grows back by a tenth of the time.");
  d.property("answerWait", &GameControl::answerWait_)
      .unit("s")
      .min(0)
      .doc(
          "Lockstep: until an agent that joins has its first percepts, others are waited for no longer than this in a "
          "cycle (wall clock).");
  d.property("joinPace", &GameControl::joinPace_)
      .unit("s")
      .min(0)
      .doc(
          "Lockstep: cycles take at least so long while an agent that is new, or all there are, have not sent (syn) "
          "yet (wall clock).");
  d.property("idleLimit", &GameControl::idleLimit_)
      .unit("s")
      .min(0)
      .doc("A client that has no robot after so long is closed (wall clock); 0: never.");
  d.property("agentCount", &GameControl::agentCount).doc("Agents now.");
  d.property("agentsSeen", &GameControl::agentsSeen).doc("Agents that ever had a robot.");
  d.property("messagesDropped", &GameControl::messagesDropped)
      .doc("Percepts not sent because the client had not taken earlier ones.");
  d.implements<IGameControl>();
  d.implements<IConnectionConsumer>();
  d.implements<IInputGate>();
  d.on<&GameControl::act>(phase::kAct);
  d.on<&GameControl::sense>(phase::kSense);
}

void GameControl::onUnlink() {
  newcomers_.clear();
  participants_.clear();
  agents_.clear();
}

void GameControl::note(const std::string& line) { lines().write(Level::info, line); }

void GameControl::complain(const std::string& line) { lines().write(Level::error, line); }

gamecontrol::AgentLines& GameControl::lines() {
  if (!lines_) lines_.emplace(kernel().log());
  return *lines_;
}

void GameControl::setJoinBudget(double seconds) {
  joinBudget_ = seconds;
  waits_.setMost(seconds);
}

/// Messages come in the order of participants, or nearly so: the search begins where the last one ended.
GameControl::Participant* GameControl::participantOf(const IConnection& connection) const {
  for (std::size_t n = participants_.size(), i = 0; i < n; ++i)
    if (const auto& p = participants_[(lastHeard_ + i) % n]; p->connection() == &connection) {
      lastHeard_ = (lastHeard_ + i) % n;
      return p.get();
    }
  for (const auto& p : newcomers_)
    if (p->connection() == &connection) return p.get();
  return nullptr;
}

bool GameControl::full() const {
  const auto counts = [](const auto& p) { return p->heardFrom(); };
  return std::count_if(participants_.begin(), participants_.end(), counts) +
             std::count_if(newcomers_.begin(), newcomers_.end(), counts) >=
         maxAgents_;
}

void GameControl::connected(IConnection& connection) {
  if (full()) return connection.close(fmt::format("there are {} agents already (maxAgents)", maxAgents_));
  newcomers_.push_back(std::make_unique<Participant>(connection));
  newcomers_.back()->resolveParser(*this);
}

void GameControl::received(IConnection& connection, std::string_view message) {
  Participant* p = participantOf(connection);
  if (!p || p->leaving()) return;
  resolveParsers();
  const std::string why = !p->heardFrom() && full()
                              ? fmt::format("there are {} agents already (maxAgents)", maxAgents_)
                              : p->receive(message, static_cast<std::size_t>(maxPending_), lines(), cycle_);
  if (why.empty()) {
    if (holding()) gamecontrol::Hold::note(*p, joinPolicy_.get());
    return;
  }
  connection.close(why);
  p->leave();
}

void GameControl::disconnected(IConnection& connection) {
  Participant* p = participantOf(connection);
  if (!p) return;
  p->disconnect();
  if (p->number() == 0) std::erase_if(newcomers_, [p](const auto& n) { return n.get() == p; });
}

void GameControl::removeAgent(AgentAspect& agent, bool close) {
  for (const auto& p : participants_) {
    if (p->aspect() != &agent) continue;
    if (close && p->connection()) p->connection()->close("its agent was removed");
    p->leave();
  }
}

bool GameControl::ready(bool lockstep) {
  resolveParsers();
  if (holding())
    return hold_.over(newcomers_, {expect_, holdWait_, joinWait_, holdReport_, joinPolicy_.get()}, kernel().log());
  if ((!lockstep && !sync_) || cyclesToTurn_ > 0) return true;
  const auto now = Clock::now();
  if (!std::exchange(waiting_, true)) waitingSince_ = now;
  const auto joins = [](const auto& p) { return p->joining(); };
  const bool somebodyJoins = std::any_of(participants_.begin(), participants_.end(), joins) ||
                             std::any_of(newcomers_.begin(), newcomers_.end(), joins);
  bool strangers = false;
  for (const auto& p : participants_) {
    if (answered(*p, now, somebodyJoins)) continue;
    if (!isStranger(*p, now)) return false;
    strangers = true;
  }
  if (!strangers && !tooSoon(now)) return true;
  return !indulge(now);
}

/// What it keeps others waiting is counted: until it has proved that it answers, and when it is slow. Expected agents
/// never are.
bool GameControl::isStranger(const Participant& p, Clock::time_point now) const {
  return !p.trusted() || (!p.expected() && syncTimeout_ > 0 && seconds(now - waitingSince_) > kSlow);
}

/// All trusted agents have answered, and others have not, or are new and shall see what comes. True when the cycle
/// waits for these. Without trusted agents nobody is kept waiting; where there are some, it lasts as long as the
/// budget, so that a stranger who joins again and again, or answers now and then, costs a match a tenth of its time.
bool GameControl::indulge(Clock::time_point now) {
  const auto leads = [](const auto& p) { return !p->leaving() && p->mustSync() && p->trusted(); };
  if (std::none_of(participants_.begin(), participants_.end(), leads)) return true;
  waits_.refill(now);
  waits_.refill(actedAt_);
  if (indulgedAt_ != Clock::time_point())
    waits_.spend(seconds(now - indulgedAt_));
  else if (seconds(now - waitingSince_) > kSlow)
    waits_.spend(kSlow);  // which it had for nothing
  indulgedAt_ = now;
  if (waits_.left()) return true;
  for (const auto& p : participants_)
    if (p->mustSync() && !p->synced() && !p->expected()) p->distrust();
  return false;
}

/// Who is waited for in lockstep: agents that sent (syn) once and were sent percepts since, until syncTimeout. All
/// others only watch: an idle connection, or a client that says (syn) when all of its team have joined, must not stop
/// the match. One program may lead many agents and read each in turn: while one is about to get its first percepts, the
/// others are not waited for so long.
bool GameControl::answered(Participant& p, Clock::time_point now, bool somebodyJoins) {
  if (p.leaving() || !p.mustSync() || p.synced()) return true;
  const double waited = seconds(now - waitingSince_);
  if (somebodyJoins && !p.expected() && waited >= answerWait_) return true;
  if (syncTimeout_ <= 0 || waited <= syncTimeout_) return false;
  p.connection()->close(fmt::format("{} did not answer for {} s, all others wait", p.label(), syncTimeout_));
  p.leave();
  return true;
}

/// Some clients read until nothing is there before they go on: a match that runs as fast as it can would never let
/// those join.
bool GameControl::tooSoon(Clock::time_point now) const {
  if (seconds(now - actedAt_) >= joinPace_) return false;
  bool watched = false, led = false;
  for (const auto& p : participants_) {
    if (p->leaving()) continue;
    if (p->watches() && p->sent() <= kPacedMessages) return true;
    watched |= p->watches();
    led |= p->mustSync();
  }
  return watched && !led;
}

void GameControl::closeIdle() {
  if (idleLimit_ <= 0) return;
  for (const auto& p : participants_) {
    if (p->hasRobot() || p->leaving() || p->inside() || seconds(actedAt_ - p->joinedAt()) <= idleLimit_) continue;
    p->connection()->close(fmt::format("it has no robot after {} s", idleLimit_));
    p->leave();
  }
}

/// The clock must not stand still while a whole team comes in. Where it waits for agents, or nobody watches it, what
/// happens in which cycle must not depend on such a limit; but a stranger that joins again and again must not spend the
/// match's time on building robots.
bool GameControl::mayLoad(const AgentAspect& agent) {
  if (realTime()) return loads_++ < loadsPerCycle_;
  const Participant* p = participantOf(agent);
  loading_.setMost(2 * maxAgents_);
  return !p || p->inside() || p->expected() || loading_.take(Clock::now());
}

bool GameControl::realTime() const {
  const auto* simulation = kernel().root().find<ISimulation>();
  return !sync_ && simulation && simulation->paced() && !simulation->lockstep();
}

void GameControl::act(const Event& event) {
  const InUse acting(*this, "agents act just now");
  cycle_ = event.cycle;
  waiting_ = false;
  actedAt_ = Clock::now();
  if (indulgedAt_ != Clock::time_point()) waits_.spend(seconds(actedAt_ - std::exchange(indulgedAt_, {})));
  loads_ = 0;
  closeIdle();
  removeLeaving();
  joinBehaviors();
  joinNewcomers();
  resolveParsers();
  isTurn_ = cyclesToTurn_ == 0;
  if (isTurn_)
    takeTurn(event);
  else
    --cyclesToTurn_;
  resolveRobots();
}

void GameControl::takeTurn(const Event& event) {
  // the installed base takes a turn that is due in less than 5 ms
  constexpr double kEarly = 0.005;
  const double cycles = event.step > 0 ? std::ceil((agentStep_ - kEarly) / event.step - 1e-9) : 1;
  cyclesToTurn_ = static_cast<int>(std::clamp(cycles, 1.0, 1e6)) - 1;
  if (perceptDelay_ > 0)
    deliver();
  else
    for (const auto& p : participants_) p->promote();
  for (std::size_t i = 0; i < participants_.size(); ++i) {
    if (auto* p = next(participants_, i, 2)) p->approachActing();
    if (waits_.left()) participants_[i]->countAnswer();
    participants_[i]->realise(lines(), cycle_);
    if (perceptDelay_ > 0) participants_[i]->promote();
  }
}

void GameControl::sense(const Event& event) {
  if (!isTurn_) return;
  if (perceptorsTree_.changed(*this))
    for (const auto& p : participants_) p->forgetTheDead();
  ++round_;
  for (std::size_t i = 0; i < participants_.size(); ++i) {
    if (auto* p = next(participants_, i, 2)) p->approachSharing();
    participants_[i]->share(round_);
  }
  std::atomic<bool> faults = false;
  const auto one = [&](std::size_t i) {
    for (std::size_t ahead = Participant::kStages; ahead > 0; --ahead)
      if (auto* p = next(participants_, i, ahead)) p->approachSensing(ahead);
    if (!participants_[i]->sense(event)) faults = true;
  };
  kernel().jobs().run(participants_.size(), std::ref(one));  // a copy would take memory
  if (faults)
    for (const auto& p : participants_) p->reportFaults(lines());
  if (perceptDelay_ == 0) deliver();
}

void GameControl::deliver() {
  const auto now = Clock::now();
  for (const auto& p : participants_)
    if (!p->deliver(lines(), cycle_, now)) ++messagesDropped_;
}

void GameControl::removeLeaving() {
  const auto stays =
      std::stable_partition(participants_.begin(), participants_.end(), [](const auto& p) { return !p->leaving(); });
  if (stays == participants_.end()) return;
  for (auto it = stays; it != participants_.end(); ++it) {
    Participant& p = **it;
    note(fmt::format("{} leaves.", p.label()));
    if (AgentAspect* aspect = p.aspect()) {
      for (const auto& child : children())
        if (auto rule = child->as<ControlAspect>()) rule->agentLeaving(*aspect);
      aspect->parent()->remove(*aspect);
    } else if (p.connection()) {
      p.connection()->close("its agent was removed from the scene");
    }
  }
  participants_.erase(stays, participants_.end());
  agentsChanged();
}

void GameControl::joinBehaviors() {
  if (!behaviorsTree_.isStale(*this)) return;
  std::vector<Behavior*> behaviors;
  if (auto* home = kernel().root().find<Node>("/usr/agent")) home->collect(behaviors);
  const auto known = [this](Behavior* b) {
    return std::any_of(participants_.begin(), participants_.end(), [b](const auto& p) { return p->behavior() == b; }) ||
           std::find(refusedBehaviors_.begin(), refusedBehaviors_.end(), b->id()) != refusedBehaviors_.end();
  };
  for (Behavior* b : behaviors)
    if (!known(b) && !join(std::make_unique<Participant>(*b))) refusedBehaviors_.push_back(b->id());
  behaviorsTree_.changed(*this);  // what joining made does not count
}

void GameControl::joinNewcomers() {
  if (holding()) hold_.order(newcomers_, expect_, joinPolicy_.get());
  released_ = true;
  auto joining = std::move(newcomers_);
  newcomers_.clear();
  for (auto& p : joining)
    if (!p->leaving()) join(std::move(p));
}

bool GameControl::join(std::unique_ptr<Participant> participant) {
  const int number = nextNumber_++;
  Participant& p = *participant;
  participants_.push_back(std::move(participant));
  AgentAspect* aspect = nullptr;
  try {
    auto* server = kernel().root().find<ISceneServer>();
    Node& scene = server ? server->scene() : kernel().root().require<Node>("/usr/scene");
    aspect = &scene.create<AgentAspect>("AgentAspect", fmt::format("AgentAspect{}", number));
    aspect->setNumber(number);
    if (auto scene = aspect->create(createEffector_, "_CreateEffector").as<SceneEffector>())
      scene->setFolder(robotFolder_);
    p.join(number, *aspect);
  } catch (const std::exception& e) {
    kernel().log().error("{} cannot be made: {}", p.label(), e.what());
    if (p.connection()) p.connection()->close("no agent could be made for it");
    if (aspect) aspect->parent()->remove(*aspect);
    participants_.pop_back();
    return false;
  }
  agentsChanged();
  note(fmt::format("{} joins.", p.label()));
  for (const auto& child : children())
    if (auto rule = child->as<ControlAspect>()) rule->agentConnected(*aspect);
  return true;
}

/// Anybody may remove an aspect at any time: it must not be found here until the next act notices.
const std::vector<AgentAspect*>& GameControl::agents() const {
  if (!agentsTree_.changed(*this)) return agents_;
  agents_.clear();
  for (const auto& p : participants_)
    if (AgentAspect* a = p->aspect(); a && a->isLinked()) agents_.push_back(a);
  return agents_;
}

const GameControl::Participant* GameControl::participantOf(const AgentAspect& agent) const {
  for (const auto& p : participants_)
    if (p->aspect() == &agent) return p.get();
  return nullptr;
}

const Predicates* GameControl::percepts(const AgentAspect& agent) const {
  const Participant* p = participantOf(agent);
  return p && !p->percepts().empty() ? &p->percepts() : nullptr;
}

double GameControl::latency(const AgentAspect& agent) const {
  const Participant* p = participantOf(agent);
  return p ? p->latency() : std::numeric_limits<double>::quiet_NaN();
}

void GameControl::agentsChanged() {
  agentsTree_.lookAgain();
  if (auto* server = kernel().root().find<ISceneServer>()) server->markModified();
}

void GameControl::resolveParsers() {
  if (!parsersTree_.changed(*this)) return;
  for (const auto* list : {&participants_, &newcomers_})
    for (const auto& p : *list) p->resolveParser(*this);
}

/// After the cycle's actions: what a scene brought in the last cycle answers and senses from here on.
void GameControl::resolveRobots() {
  if (!robotsTree_.changed(*this)) return;
  for (const auto& p : participants_)
    if (p->resolveRobot()) {
      ++agentsSeen_;
      note(fmt::format("{} has its robot.", p->label()));
    }
}

void GameControl::saveState(StateWriter& out) const {
  out.write(nextNumber_);
  out.write(agentsSeen_);
  out.write(cyclesToTurn_);
  out.write(static_cast<std::int64_t>(participants_.size()));
  for (const auto& p : participants_) {
    out.write(p->number());
    p->save(out);
  }
}

void GameControl::loadState(StateReader& in) {
  nextNumber_ = static_cast<int>(in.readInteger());
  agentsSeen_ = static_cast<int>(in.readInteger());
  cyclesToTurn_ = static_cast<int>(in.readInteger());
  const auto n = in.readInteger();
  if (n != static_cast<std::int64_t>(participants_.size()))
    throw Error(fmt::format("{}: the state has {} agents, here are {}. Connect the same agents first.", path(), n,
                            participants_.size()));
  for (const auto& p : participants_) {
    if (const auto number = in.readInteger(); number != p->number())
      throw Error(fmt::format("{}: the state has agent {} where agent {} is.", path(), number, p->number()));
    p->load(in);
  }
}

}  // namespace spark
