#include "gamecontrol/game_control.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <limits>
#include <utility>

#include "gamecontrol/request_effector.h"
#include "gamecontrol/scene_effector.h"
#include "gamecontrol/script_event.h"
#include "spark/error.h"
#include "spark/state.h"

namespace spark {

void GameControl::describe(Description<GameControl>& d) {
  d.doc("Creates agents for connections and behaviours, dispatches their actions, calls their perceptors.");
  d.link(&GameControl::joinPolicy_, Child<IJoinPolicy>())
      .doc("Reads the identity of agents that join; without it they have none.");
  d.link(&GameControl::tape_, At<IInputTape>()).doc("Records the wall clock where it decides, or plays it.");
  d.link(&GameControl::timing_, Child<IAgentTiming>())
      .doc("Decides when agents act and sense and how long messages are under way; without it as in SimSpark.");
  d.link(&GameControl::judges_, Child<IAgentJudge>()).doc("Judge what agents ask for and do.");
  d.property("requests", &GameControl::requests_)
      .doc(
          "Agents that join from now on may ask for perceptors and effectors while they run: (request (perceptor "
          "<class>) (name <name>)). Control aspects decide what they get.");
  d.property("requireAll", &GameControl::requireAll_)
      .doc(
          "An agent takes part only when all that it has asked for before its first percepts is granted; false: "
          "it takes part with what it got.");
  d.property("byArrival", &GameControl::byArrival_)
      .doc(
          "Agents act in the order in which their messages arrived, as in the plain loop of the papers; false: in "
          "order of their numbers, which repeats.");
  d.property("createEffector", &GameControl::createEffector_)
      .doc("Class of the effector with which an agent requests its robot.");
  d.property("expect", &GameControl::expect_)
      .range(0, 1000)
      .doc(
          "Holds the clock at cycle 0 until this number of agents have named their robot and, if the game has a join "
          "policy, themselves, and have sent syn; they are numbered by team and number.");
  d.property("maxAgents", &GameControl::maxAgents_)
      .range(0, 1000)
      .doc("Further agents are disconnected; clients that never sent anything do not count.");
  d.property("maxPending", &GameControl::maxPending_)
      .unit("bytes")
      .range(1024, 1 << 28)
      .doc("A client that sends more within one cycle is disconnected.");
  d.property("loadsPerCycle", &GameControl::loadsPerCycle_)
      .min(1)
      .doc(
          "Maximum number of robots that are loaded in one cycle in real time, the others in the next ones; in other "
          "modes all are loaded at once.");
  d.property("sync", &GameControl::sync_).doc("Waits for the agents' (syn) even if the run loop is not in lockstep.");
  d.property("robotFolder", &GameControl::robotFolder_)
      .doc("Agents' robots are scene files below this folder, e.g. rsg/agent/; empty: any folder.");
  d.property("holdWait", &GameControl::holdWait_)
      .unit("s")
      .min(0)
      .doc("Expected agents that named a robot and are silent for this time get a first message (wall time).");
  d.property("syncTimeout", &GameControl::syncTimeout_)
      .unit("s")
      .min(0)
      .doc("Lockstep: an agent that does not answer for this time is disconnected (wall time); 0: never.");
  d.property("holdReport", &GameControl::holdReport_)
      .unit("s")
      .min(0)
      .doc("While waiting for expected agents: time between two log lines about those that are missing (wall time).");
  d.property("joinWait", &GameControl::joinWait_)
      .unit("s")
      .min(0)
      .doc(
          "While waiting for expected agents: if none makes progress for this time, the match starts with those that "
          "named a robot (wall time); 0: never.");
  d.property("joinBudget", &GameControl::joinBudget, &GameControl::setJoinBudget)
      .unit("s")
      .min(0)
      .doc(
          "Lockstep: total time that agents which were not expected, and are new or slow, may delay all others (wall "
          "time); it refills by a tenth of the time.");
  d.property("answerWait", &GameControl::answerWait_)
      .unit("s")
      .min(0)
      .doc(
          "Lockstep: until an agent that joins has its first percepts, a cycle waits for others no longer than this; "
          "an "
          "agent that has not sent (syn) yet is waited for as long, and once more for each of its answers (wall "
          "time).");
  d.property("joinPace", &GameControl::joinPace_)
      .unit("s")
      .min(0)
      .doc(
          "Lockstep: silence after which the answer of an agent that has not sent (syn) yet is complete, and minimum "
          "duration of a cycle for one that does not answer (wall time).");
  d.property("idleLimit", &GameControl::idleLimit_)
      .unit("s")
      .min(0)
      .doc("A client that has no robot after this time is disconnected (wall time); 0: never.");
  d.property("agentCount", &GameControl::agentCount).doc("Number of agents now.");
  d.property("agentsSeen", &GameControl::agentsSeen).doc("Number of agents that ever had a robot.");
  d.property("messagesDropped", &GameControl::messagesDropped)
      .doc("Messages with percepts that were not sent because the client had not read earlier ones.");
  d.method("agents", &GameControl::agentPaths).doc("The paths of all agents' aspects, in order of their numbers.");
  d.method("disqualify", &GameControl::disqualifyAgent)
      .parameters({"agent", "why"})
      .doc("Removes an agent, given by its number or its path, closes its connection and logs why.");
  d.method("removeAgent", &GameControl::removeAgentAt)
      .parameters({"agent"})
      .doc("Removes an agent, given by its number or its path, and closes its connection.");
  d.implements<IGameControl>();
  d.implements<IRemarks>();
  d.implements<ISuccession>();
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

void GameControl::logInfo(const std::string& line) { agentLog().write(Level::info, line); }

void GameControl::logError(const std::string& line) { agentLog().write(Level::error, line); }

gamecontrol::AgentLog& GameControl::agentLog() {
  if (!log_) log_.emplace(kernel().log());
  return *log_;
}

void GameControl::setJoinBudget(double seconds) {
  joinBudget_ = seconds;
  lockstep_.setBudget(seconds);
}

/// Messages usually come in the order of participants: the search begins where the last one ended.
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

/// True if there are maxAgents. Clients that never sent anything do not count, nor robots that wait for theirs.
bool GameControl::full() const {
  const auto counts = [](const auto& p) { return p->heardFrom() && !p->vacant(); };
  return std::count_if(participants_.begin(), participants_.end(), counts) +
             std::count_if(newcomers_.begin(), newcomers_.end(), counts) >=
         maxAgents_;
}

void GameControl::connected(IConnection& connection) {
  if (full()) return connection.close(fmt::format("there are {} agents already (maxAgents)", maxAgents_));
  newcomers_.push_back(std::make_unique<Participant>(connection, now()));
  newcomers_.back()->resolveParser(*this);
}

void GameControl::received(IConnection& connection, std::string_view message) {
  Participant* p = participantOf(connection);
  if (!p || p->leaving()) return;
  resolveParsers();
  const std::string why = !p->heardFrom() && full()
                              ? fmt::format("there are {} agents already (maxAgents)", maxAgents_)
                              : p->receive(message, static_cast<std::size_t>(maxPending_), agentLog(), cycle_, now());
  if (why.empty()) {
    p->setArrival(++arrivals_);
    if (holding()) gamecontrol::Hold::onMessage(*p, joinPolicy_.get());
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
    p->exclude();
  }
}

void GameControl::disqualify(AgentAspect& agent, std::string_view why) {
  for (const auto& p : participants_) {
    if (p->aspect() != &agent || p->leaving()) continue;
    logInfo(fmt::format("Agent {} is disqualified: {}.", agent.number(), why));
    if (p->connection()) p->connection()->close(fmt::format("it was disqualified: {}", why));
    p->exclude();
  }
}

ISuccession::Claim GameControl::claim(AgentAspect& holder, bool again) {
  for (const auto& p : participants_) {
    if (p->aspect() != &holder) continue;
    if (p->leaving()) return Claim::granted;
    IConnection* const connection = p->connection();
    if (!connection || !p->claim(again)) return Claim::refused;
    const bool hangs = p->hangs(now());
    if (!(tape_ ? tape_->decide("hangs", static_cast<std::uint64_t>(p->number()), hangs, false) : hangs))
      return Claim::waiting;
    connection->close(fmt::format("{} neither reads nor answers, and gives way to its successor", p->label()));
    p->leave();
    return Claim::granted;
  }
  return Claim::refused;
}

std::string GameControl::judgeRequest(AgentAspect& agent, const PartRequest& request) {
  gamecontrol::JudgeList judges;
  judges.update(judges_);
  return judges.judgeRequest(agent, request);
}

bool GameControl::ready(bool lockstep) {
  resolveParsers();
  const bool waits = (lockstep || sync_) && cyclesToTurn_ == 0;
  if (!holding() && !waits) return true;
  const auto at = now();
  const auto last = lookedAt_ == Clock::time_point() ? at : lookedAt_;
  lookedAt_ = at;
  if (holding())
    return hold_.isOver(newcomers_, {expect_, holdWait_, joinWait_, holdReport_, joinPolicy_.get(), last},
                        kernel().log());
  return lockstep_.isOpen(participants_, newcomers_, {syncTimeout_, answerWait_, joinPace_, joinPolicy_.get()},
                          {at, last}, agentLog());
}

void GameControl::closeWithoutRobot() {
  if (idleLimit_ <= 0) return;
  for (const auto& p : participants_) {
    if (p->joinedAt() == Clock::time_point()) p->joinedSince(actedAt_);  // after a state was loaded
    if (p->hasRobot() || p->leaving() || p->inside() || p->vacant() ||
        std::chrono::duration<double>(actedAt_ - p->joinedAt()).count() <= idleLimit_)
      continue;
    p->connection()->close(fmt::format("it has no robot after {} s", idleLimit_));
    p->leave();
  }
}

/// In real time the number per cycle is limited, so that the clock does not stop while a whole team joins. In lockstep
/// and at maximum speed such a limit would decide in which cycle a robot appears; there only a bucket limits the robots
/// of untrusted clients, which might join again and again to slow the match down.
bool GameControl::mayLoad(const AgentAspect& agent) {
  if (realTime()) return loads_++ < loadsPerCycle_;
  const Participant* p = agents_.of(agent);
  loadBudget_.setCapacity(2 * maxAgents_);
  return !p || p->inside() || p->expected() || loadBudget_.take(now());
}

GameControl::Clock::time_point GameControl::now() const {
  const auto live = Clock::now();
  return tape_ ? tape_->time(live) : live;
}

bool GameControl::realTime() const {
  const auto* simulation = kernel().root().find<ISimulation>();
  return !sync_ && simulation && simulation->paced() && !simulation->lockstep();
}

void GameControl::act(const Event& event) {
  const InUse acting(*this, "agents act just now");
  cycle_ = event.cycle;
  lookedAt_ = actedAt_ = now();
  lockstep_.beginCycle(actedAt_);
  loads_ = 0;
  closeWithoutRobot();
  const bool restored = std::exchange(restored_, false);
  if (restored && joinPolicy_)
    gamecontrol::dropNameless(participants_);  // now, as names are part of the state of what follows in the tree
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
  if (restored && gamecontrol::hasVacant(participants_) && !(tape_ && tape_->playing()))
    logInfo(gamecontrol::reportOfVacant(participants_));
}

void GameControl::takeTurn(const Event& event) {
  cyclesToTurn_ = std::max(timing().cyclesToNextTurn(event.step), 1) - 1;
  if (joinPolicy_ && gamecontrol::hasVacant(participants_))  // without names they went on when they joined
    for (const auto& p : participants_)
      if (p->connection() && !p->leaving()) resume(gamecontrol::vacantNamed(participants_, *p, *joinPolicy_), *p);

  // Actions that came since the last turn depart, percepts arrive, then actions take effect.
  for (const auto& p : participants_) {
    p->countAnswer(lockstep_.hasBudget());
    p->depart(cycle_, p->aspect() ? timing().latencies(*p->aspect()) : AgentLatencies());
  }
  deliver();
  activeJudges_.update(judges_);
  executeTurn(event);
}

/// Agents act in order of number, or in that of their last messages. What has no connection acts first then.
void GameControl::executeTurn(const Event& event) {
  if (!byArrival_) {
    for (std::size_t i = 0; i < participants_.size(); ++i) participants_[i]->execute(agentLog(), event, activeJudges_);
    return;
  }
  byArrivalList_.clear();
  for (const auto& p : participants_) byArrivalList_.push_back(p.get());
  std::sort(byArrivalList_.begin(), byArrivalList_.end(), [](const Participant* a, const Participant* b) {
    return std::pair(a->arrival(), a->number()) < std::pair(b->arrival(), b->number());
  });
  for (Participant* const p : byArrivalList_) p->execute(agentLog(), event, activeJudges_);
}

void GameControl::sense(const Event& event) {
  if (!isTurn_) return;
  const InUse sensing(*this, "agents sense just now");
  const auto dropRemoved = [this] {
    if (perceptorsTree_.changed(*this))
      for (const auto& p : participants_) p->dropRemovedPerceptors();
  };
  dropRemoved();

  for (const auto& p : participants_)
    p->setTurn(!p->aspect() || timing().senses(*p->aspect(), event.cycle), timing().sendsEmpty());

  // Update what several agents' perceptors share. Perceptors that are scripts may change the tree here.
  ++round_;
  for (const auto& p : participants_) p->share(round_);
  dropRemoved();

  // Sense, agents in parallel.
  std::atomic<bool> faults = false;
  const auto one = [&](std::size_t i) {
    if (!participants_[i]->sense(event)) faults = true;
  };
  kernel().jobs().run(participants_.size(), std::ref(one));  // std::ref: a copy would allocate
  if (faults)
    for (const auto& p : participants_) p->reportFaults(agentLog());
  deliver();
}

/// Percepts arrive whose time has come.
void GameControl::deliver() {
  const auto arrives = [this](const auto& p) { return p->hasArrivals(cycle_); };
  if (std::none_of(participants_.begin(), participants_.end(), arrives)) return;
  const auto at = now();
  for (const auto& p : participants_) messagesDropped_ += p->deliver(agentLog(), cycle_, at, tape_.get());
}

void GameControl::removeLeaving() {
  const auto removed =
      std::stable_partition(participants_.begin(), participants_.end(), [](const auto& p) { return !p->leaving(); });
  if (removed == participants_.end()) return;
  for (auto it = removed; it != participants_.end(); ++it) {
    Participant& p = **it;
    logInfo(fmt::format("{} leaves.", p.label()));
    if (p.excluded() && p.behavior()) minds_.exclude(*p.behavior());
    if (p.isRule()) continue;
    if (AgentAspect* aspect = p.aspect()) {
      forEachAspect([&p](ControlAspect& rule) {
        if (AgentAspect* going = p.aspect()) rule.agentLeaving(*going);
      });
      if ((aspect = p.aspect())) p.lostMind() ? release(*aspect) : aspect->parent()->remove(*aspect);
    } else if (p.connection()) {
      p.connection()->close("its agent was removed from the scene");
    }
  }
  participants_.erase(removed, participants_.end());
  agentsChanged();
}

/// The aspect of an object whose mind was removed stays, without what game control gave it: another mind may come.
void GameControl::release(AgentAspect& aspect) {
  aspect.setNumber(0);
  for (const char* given : {RequestEffector::kName, RequestPerceptor::kName})
    if (Leaf* const part = aspect.child(given)) aspect.remove(*part);
}

void GameControl::joinBehaviors() {
  minds_.join(*this, [this](Behavior& mind, AgentAspect* aspect) {
    return join(std::make_unique<Participant>(mind, actedAt_), aspect);
  });
}

void GameControl::joinNewcomers() {
  if (holding()) hold_.orderNewcomers(newcomers_, expect_, joinPolicy_.get());
  released_ = true;
  // One after the other: a script that hears of an agent may close the connections of the others.
  while (!newcomers_.empty()) {
    std::unique_ptr<Participant> p = std::move(newcomers_.front());
    newcomers_.erase(newcomers_.begin());
    if (p->leaving()) continue;
    if (!resume(gamecontrol::vacantFor(participants_, *p, joinPolicy_.get()), *p)) join(std::move(p));
  }
}

AgentAspect& GameControl::createAspect(Node& parent, const std::string& name) {
  auto& aspect = parent.create<AgentAspect>("AgentAspect", name);
  if (auto scene = aspect.create(createEffector_, kCreateEffector).as<SceneEffector>()) scene->setFolder(robotFolder_);
  return aspect;
}

void GameControl::withdrawAgents() {
  for (const auto& p : participants_) {
    if (p->isRule()) continue;
    forEachAspect([&p](ControlAspect& rule) {
      if (AgentAspect* going = p->aspect()) rule.agentLeaving(*going);
    });
    if (AgentAspect* const aspect = p->aspect()) aspect->setNumber(0);
  }
  agentsChanged();
}

void GameControl::restoreAgent(Node& parent, const std::string& name, int number) {
  Leaf* const there = parent.child(name);
  const Ref<AgentAspect> aspect = there ? Ref<AgentAspect>(there->as<AgentAspect>()) : Ref(&createAspect(parent, name));
  if (!aspect) throw Error(fmt::format("{}: expected room for {}, found another object", parent.path(), name));
  aspect->setNumber(number);
  if (requests_ && !aspect->child(RequestEffector::kName)) RequestEffector::addTo(*aspect, robotFolder_);
  forEachAspect([&aspect](ControlAspect& rule) {
    if (AgentAspect* made = aspect.get()) rule.agentConnected(*made);
  });
}

/// Creates the agent's aspect, unless it is `ready`. False if that fails; the participant is removed then.
bool GameControl::join(std::unique_ptr<Participant> participant, AgentAspect* ready) {
  const bool rule = ready && ready->as<ControlAspect>();
  const int number = rule ? numberOfNextRule() : nextNumber_++;
  Participant& p = *participant;
  participants_.push_back(std::move(participant));
  Ref<AgentAspect> aspect(ready);
  try {
    if (!ready) {
      auto* server = kernel().root().find<ISceneServer>();
      Node& scene = server ? server->scene() : require<Node>(ISceneServer::kDefaultScene);
      aspect = &createAspect(scene, fmt::format("AgentAspect{}", number));
    }
    if (!rule) aspect->setNumber(number);
    const bool asks = requests_ && !rule;
    if (asks) RequestEffector::addTo(*aspect, robotFolder_);
    p.join(number, *aspect, {std::size_t{!ready} + asks, asks}, actedAt_);
  } catch (const std::exception& e) {
    kernel().log().error("{} cannot be made: {}", p.label(), e.what());
    kernel().countFault();
    if (p.connection()) p.connection()->close("no agent could be made for it");
    if (aspect && ready)
      aspect->setNumber(0);
    else if (aspect)
      aspect->parent()->remove(*aspect);
    participants_.pop_back();
    return false;
  }
  agentsChanged();
  if (rule) return logInfo(fmt::format("{} has a mind.", p.label())), true;
  logInfo(fmt::format("{} joins.", p.label()));
  forEachAspect([&p](ControlAspect& rule) {
    if (AgentAspect* made = p.aspect()) rule.agentConnected(*made);
  });
  return true;
}

/// Calls `f` for the control aspects of now, in child order. They may be scripts, which change the tree.
template <class F>
void GameControl::forEachAspect(F f) {
  std::vector<Ref<ControlAspect>> aspects;
  for (const auto& child : children())
    if (auto aspect = child->as<ControlAspect>()) aspects.emplace_back(aspect);
  for (const Ref<ControlAspect>& aspect : aspects)
    if (ControlAspect* rule = aspect.get()) f(*rule);
}

/// Numbers of rules with minds are apart from those of agents, and above them.
int GameControl::numberOfNextRule() const {
  constexpr int kFirst = 1'000'000'000;
  int next = kFirst;
  for (const auto& p : participants_) next = std::max(next, p->number() + 1);
  return next;
}

bool GameControl::remark(const AgentAspect& agent, std::string_view predicate, std::string_view why) {
  Participant* const p = agents_.of(agent);
  return !p || p->remark(agentLog(), cycle_, predicate, why);
}

const Predicates* GameControl::percepts(const AgentAspect& agent) const {
  const Participant* p = agents_.of(agent);
  return p && !p->percepts().empty() ? &p->percepts() : nullptr;
}

double GameControl::latency(const AgentAspect& agent) const {
  const Participant* p = agents_.of(agent);
  return p ? p->latency() : std::numeric_limits<double>::quiet_NaN();
}

bool GameControl::requiresWhatItAsks(const AgentAspect& agent) const {
  const Participant* const p = agents_.of(agent);
  return requireAll_ && p && p->requiresNow(cycle_);
}

void GameControl::reject(AgentAspect& agent, const std::string& why) {
  Participant* const p = agents_.of(agent);
  if (!p || p->rejected()) return;
  logInfo(fmt::format("{} does not take part: {}.", p->label(), why));
  p->reject(why);
}

List GameControl::senseNow(Node& node) {
  return questions_.ask(node, ++round_, [this](const Perceptor& perceptor) {
    return std::any_of(participants_.begin(), participants_.end(), [&perceptor](const auto& p) {
      return p->aspect() && !p->leaving() && isBelow(perceptor, *p->aspect());
    });
  });
}

IConnection* GameControl::connection(const AgentAspect& agent) const {
  const Participant* p = agents_.of(agent);
  return p ? p->connection() : nullptr;
}

void GameControl::agentsChanged() {
  agents_.lookAgain();
  if (auto* server = kernel().root().find<ISceneServer>()) server->markModified();
}

void GameControl::resolveParsers() {
  if (!parsersTree_.changed(*this)) return;
  for (const auto* list : {&participants_, &newcomers_})
    for (const auto& p : *list) p->resolveParser(*this);
}

/// Called after the actions of a cycle: effectors and perceptors that a scene file brought in the last cycle are used
/// from now on.
void GameControl::resolveRobots() {
  if (!robotsTree_.changed(*this)) return;
  for (const auto& p : participants_)
    if (p->resolveRobot()) {
      ++agentsSeen_;
      logInfo(fmt::format("{} has its robot.", p->label()));
    }
}

void GameControl::saveState(StateWriter& out) const {
  out.write(nextNumber_);
  out.write(agentsSeen_);
  out.write(cyclesToTurn_);
  out.aside(released_ ? "released" : "");
  if (out.keeps()) out.aside(std::to_string(arrivals_));
  if (out.keeps()) out.aside(minds_.excluded(kernel().root()));
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
  released_ = in.readString() == "released";
  arrivals_ = std::strtoull(in.readString().c_str(), nullptr, 10);
  minds_.setExcluded(in.readString(), kernel().root());
  std::vector<std::unique_ptr<Participant>> restored;
  for (std::size_t n = in.readCount(); n > 0; --n) {
    const auto number = static_cast<int>(in.readInteger());
    restored.push_back(Participant::load(in, number, kernel().root()));
    restored.back()->resolveParser(*this);
  }
  std::swap(participants_, restored);
  for (const auto& old : restored)
    if (IConnection* const connection = old->connection()) {
      old->disconnect();
      if (!seat(*connection)) connection->close("the simulation went back to a time without its agent");
    }
  if (tape_ && tape_->playing())
    for (const auto& p : participants_)
      if (auto* const port = p->vacant() && p->wasConnected() ? kernel().root().find<Node>(p->seat().port) : nullptr)
        if (IConnection* const client = tape_->connection(*port, p->seat().key)) seat(*client);
  restored_ = true;
  // The clock waits for agents that are to come back.
  if (gamecontrol::hasVacant(participants_) && !(tape_ && tape_->playing())) released_ = false;
  agentsChanged();
  robotsTree_.lookAgain();
}

/// A connection of the time when the state was saved goes on with its agent. False if there is none for it.
bool GameControl::seat(IConnection& connection) {
  Participant* const player = gamecontrol::vacantAt(participants_, connection);
  if (!player) return false;
  player->connect(connection, actedAt_);
  player->resolveParser(*this);
  return true;
}

/// `client` goes on as `player`, which is vacant; nullptr: it does not, and the result is false.
bool GameControl::resume(Participant* player, Participant& client) {
  if (!player) return false;
  player->takeOver(client, now());
  logInfo(fmt::format("{} is back.", player->label()));
  return true;
}

}  // namespace spark
