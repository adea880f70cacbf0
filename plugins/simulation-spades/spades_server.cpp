#include "spades_server.h"

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <deque>
#include <filesystem>

#include "agent_process.h"
#include "spark/error.h"
#include "spark/output_file.h"

namespace spark {

using spades::AgentMind;
using spades::Time;

namespace {
constexpr int kMostWait = 25;  // ms, so that a request to stop is seen
}  // namespace

/// An agent: its program, its time, and its side of the connection to the consumer.
class SpadesServer::Agent final : public IConnection {
 public:
  Agent(SpadesServer& server, int id, const std::string& type, const std::optional<spades::ThinkModel>& model,
        std::unique_ptr<spades::AgentLink> way)
      : mind(latencies),
        link(std::move(way)),
        model(model),
        server_(server),
        id_(id),
        name_(fmt::format("agent {} ({})", id, type)) {
    for (const auto& own : server.typeLatencies_)
      if (own->type() == type) ownLatencies_ = own;
    updateLatencies();
  }

  std::uint64_t id() const override { return static_cast<std::uint64_t>(id_) + 1; }
  const std::string& peer() const override { return name_; }
  Node& port() override { return server_; }
  /// A message of the consumer is what the agent senses now.
  bool send(std::string_view message) override {
    mind.sense(server_.now(), std::string(message));
    return true;
  }
  bool idle() const override { return true; }
  double stalledSeconds() const override { return 0; }
  /// The consumer decides it within a cycle, so it is the same in every run: it takes effect at once.
  void close(std::string_view reason) override {
    lose(reason);
    closed = true;
  }
  /// The agent takes part no longer.
  void lose(std::string_view why) {
    if (!lost.empty()) return;
    lost = why;
    link->send("X");
  }

  /// Those that it has now.
  void updateLatencies() {
    const TypeLatency* const own = ownLatencies_.get();
    latencies = own ? own->latencies() : spades::Latencies{server_.senseLatency_, server_.actLatency_};
  }
  /// Another state is loaded: nothing is on its way.
  void forget() {
    mind.forget();
    acts.clear();
  }

  spades::Latencies latencies;
  AgentMind mind;
  std::unique_ptr<spades::AgentLink> link;
  std::optional<spades::ThinkModel> model;  ///< nullopt: the server's
  std::deque<spades::Act> acts;             ///< on their way, in the order of their time
  std::string lost;                         ///< why; "": it takes part
  bool connected = false, closed = false;
  Clock::time_point began{};

 private:
  SpadesServer& server_;
  const int id_;
  std::string name_;
  Ref<TypeLatency> ownLatencies_;  ///< empty: those of all
};

SpadesServer::SpadesServer() = default;
SpadesServer::~SpadesServer() = default;

void SpadesServer::describe(Description<SpadesServer>& d) {
  using S = SpadesServer;
  d.doc("Starts agents and exchanges messages with them in simulated time: latencies, think times, causality.");
  d.implements<IInputSource>();
  d.implements<IInputGate>();
  d.implements<IReturningAgents>();
  d.implements<IAgentTimes>();
  d.link(&S::thinkTime_, Child<ThinkTime>());
  d.link(&S::typeLatencies_, Child<TypeLatency>()).doc("Agent types with latencies of their own.");
  d.link(&S::simulation_, At<ISimulation>());
  d.link(&S::tape_, At<IInputTape>());
  d.link(&S::consumer_, At<IConnectionConsumer>(&S::consumerPath_));
  d.property("consumer", &S::consumer, &S::setConsumer)
      .doc("Path of the node that gets the agents and their acts, and whose messages they sense.");
  d.property("database", &S::database, &S::setDatabase)
      .ofProcess()
      .doc("File of the agent database, which is read at once.");
  d.property("logs", &S::logs_)
      .ofProcess()
      .doc("Folder for what agents print: agent<n>-stdout.log and -stderr.log; empty: it is dropped.");
  describeLatencies(d, &S::senseLatency_, &S::actLatency_);
  d.property("thinkTimes", &S::thinkTimes, &S::setThinkTimes)
      .doc(
          "After each cycle the agent gets K<steps>, how long it has thought. It must answer D, as agents of the time "
          "do. Set it before agents are started.");
  d.property("mostThought", &S::mostThought_)
      .unit("s")
      .min(0.01)
      .doc("An agent that thinks for longer is lost (wall time).");
  d.property("shutdown", &S::shutdown_)
      .unit("s")
      .min(0)
      .doc("How long agents may take to end when they are told to (wall time).");
  d.property("port", &S::port, &S::setPort)
      .range(-1, 65535)
      .ofProcess()
      .doc("TCP port for communication servers; 0: a free one, -1: none.");
  d.property("address", &S::address_).ofProcess().doc("IPv4 address at which it listens for them.");
  d.property("commServers", &S::commServers_)
      .range(0, 1000)
      .ofProcess()
      .doc("Number of communication servers that the start of the agents waits for.");
  d.property("away", &S::away_)
      .unit("s")
      .min(0)
      .doc("How long a communication server may be away before its agents are lost (wall time).");
  d.method("setToken", &S::setToken)
      .parameters({"token"})
      .doc("What communication servers must know; without one, any may join.");
  d.method("listen", &S::listen).doc("Opens the port for communication servers; otherwise the first poll does.");
  d.property("agents", &S::agentCount).doc("Number of agents now.");
  d.property("lost", &S::lost_).readOnly().doc("Number of agents that were lost.");
  d.method("queueAgents", &S::queueAgents)
      .parameters({"type", "count"})
      .doc("Queues agents of a type of the database; all are started before the first cycle.");
}

void SpadesServer::setConsumer(std::string path) {
  consumerPath_ = std::move(path);
  consumer_.lookAgain();
}

void SpadesServer::setThinkTimes(bool on) {
  if (on != thinkTimes_ && stage_ != Stage::queued)
    throw Error(fmt::format("{}.thinkTimes: its agents are started already; set it in the config", path()));
  thinkTimes_ = on;
}

void SpadesServer::setDatabase(std::string file) {
  // Where a recording is played, no agents are started. One that goes on starts those that the user names.
  if (!file.empty() && !playing() && !outputs::permitted(file))
    throw Error(
        fmt::format("{}.database: a recording names the programs of {}, and programs that a recording names are not "
                    "started. Name it yourself to start them: --set agentDatabase={}",
                    path(), file, file));
  types_ = file.empty() || playing() ? std::map<std::string, spades::AgentType>() : spades::readAgentDatabase(file);
  database_ = std::move(file);
}

void SpadesServer::queueAgents(const std::string& type, int count) {
  if (playing()) return;
  if (stage_ != Stage::queued) throw Error(fmt::format("{}: its agents are started already", path()));
  if (!types_.contains(type) && port_ < 0) {
    std::string names;
    for (const auto& [name, unused] : types_) names += (names.empty() ? "" : ", ") + name;
    throw Error(fmt::format("{}: expected an agent type of the database '{}' ({}), found '{}'", path(), database_,
                            names, type));
  }
  if (const auto known = types_.find(type);
      known != types_.end() && modelOf(spades::readTimer(known->second.timer)).instructions)
    if (const std::string lacks = spades::InstructionCounter::lacks(); !lacks.empty())
      throw Error(fmt::format("{}: no agents of type '{}': {}", path(), type, lacks));
  if (count < 0 || count > 1000) throw Error(fmt::format("expected 0 to 1000 agents, found {}", count));
  queue_.emplace_back(type, count);
}

// ---- start and end ----

void SpadesServer::setPort(int port) {
  if (comm_ && port != comm_->port())
    throw Error(fmt::format("{}.port: it listens on {} already", path(), comm_->port()));
  port_ = port;
}

void SpadesServer::listen() {
  if (comm_ || port_ < 0 || playing()) return;
  comm_ = std::make_unique<spades::CommPort>(address_, port_, token_, kernel().log());
  kernel().log().info("{}: communication servers may join at {}:{}.", path(), address_, comm_->port());
}

void SpadesServer::start() {
  stage_ = Stage::starting;
  if (!logs_.empty()) std::filesystem::create_directories(logs_);
  for (const auto& [type, count] : queue_) {
    const int next = nextId_ + count;  // also without those that cannot be started: agents come back by their ids
    try {
      for (int i = 0; i < count; ++i) startAgent(type);
    } catch (const std::exception& e) {
      kernel().log().error("{}: no more agents of type '{}' are started: {}", path(), type, e.what());
    }
    nextId_ = next;
  }
}

/// The communication servers that have a type start its agents in turns.
spades::CommPort::Server* SpadesServer::serverFor(const std::string& type) {
  std::vector<spades::CommPort::Server*> able;
  for (spades::CommPort::Server* server : comm_ ? comm_->servers() : std::vector<spades::CommPort::Server*>())
    if (server->timerOf(type)) able.push_back(server);
  return able.empty() ? nullptr : able[next_[type]++ % able.size()];
}

void SpadesServer::startAgent(const std::string& type) {
  std::unique_ptr<spades::AgentLink> link;
  std::string timer;
  const int number = ++numbers_[type];
  if (spades::CommPort::Server* const server = serverFor(type)) {
    link = comm_->start(*server, nextId_, type, number);
    timer = *server->timerOf(type);
  } else if (const auto known = types_.find(type); known != types_.end()) {
    const std::string log = logs_.empty() ? std::string() : fmt::format("{}/agent{}", logs_, nextId_);
    link = spades::startAgent(known->second, number, log);
    timer = known->second.timer;
  } else {
    throw Error("no communication server has this type, nor the database of the host");
  }
  const auto model = spades::readTimer(timer);
  if (modelOf(model).instructions)
    if (const std::string lacks = link->countInstructions(); !lacks.empty()) {
      link->send("X");
      throw Error(lacks);
    }
  agents_.push_back(std::make_unique<Agent>(*this, nextId_, type, model, std::move(link)));
  ++nextId_;
  agents_.back()->link->send("D");
  agents_.back()->began = Clock::now();
}

/// All agents are there, or lost: they join in the order of their ids.
void SpadesServer::connectAll() {
  const auto waits = [](const auto& a) { return a->lost.empty() && !a->mind.ready(); };
  if (std::any_of(agents_.begin(), agents_.end(), waits)) return;
  stage_ = Stage::running;
  kernel().log().info("{}: {} agents take part.", path(),
                      std::count_if(agents_.begin(), agents_.end(), [](const auto& a) { return a->lost.empty(); }));
  for (const auto& a : agents_) {
    if (!a->lost.empty() || !consumer_) continue;
    a->connected = true;
    put(Input::Kind::connect, *a, a->peer());
    consumer_->connected(*a);
  }
}

void SpadesServer::onUnlink() {
  for (const auto& a : agents_) a->link->send("X");
  if (comm_) comm_->end();
  const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(shutdown_));
  while (true) {
    std::vector<pollfd> waiting;
    for (const auto& a : agents_) a->link->addEnd(waiting);
    if (comm_ && comm_->hasServers()) comm_->addDescriptors(waiting);
    if (waiting.empty() || !spades::waitUntil(end, waiting)) break;
    if (comm_) comm_->poll(away_, false);
  }
  agents_.clear();
  comm_.reset();
}

void SpadesServer::loadState(StateReader&) {
  for (const auto& a : agents_) a->forget();
}

/// Writes an input to the tape.
void SpadesServer::put(Input::Kind kind, const Agent& agent, std::string_view text) {
  if (tape_) tape_->put({.kind = kind, .place = path(), .key = agent.id(), .text = text});
}

// ---- between cycles ----

void SpadesServer::poll() {
  if (playing()) return;
  if (comm_) comm_->poll(away_, stage_ == Stage::queued);
  if (stage_ == Stage::queued) {
    listen();
    const auto servers = comm_ ? comm_->servers().size() : 0;
    if (servers < static_cast<std::size_t>(commServers_)) return;
    start();
  }
  heard_ = false;
  for (const auto& a : agents_) {
    a->updateLatencies();
    exchange(*a);
  }
  if (stage_ == Stage::starting) connectAll();
  if (stage_ == Stage::running)
    for (const auto& a : agents_) deliver(*a);
  // All acts of this step are known: they take effect in the order of agents, not of their messages.
  const auto settled = [this](const auto& a) { return !a->lost.empty() || a->mind.horizon() > now(); };
  if (!std::all_of(agents_.begin(), agents_.end(), settled)) return;
  for (const auto& a : agents_) feed(*a);
  removeLost();
}

spades::ThinkModel SpadesServer::modelOf(const std::optional<spades::ThinkModel>& named) const {
  return named ? *named : thinkTime_ ? thinkTime_->model() : spades::ThinkModel();
}

/// Reads the agent's messages.
void SpadesServer::exchange(Agent& a) {
  a.link->poll();
  while (a.lost.empty()) {
    const auto message = a.link->receive();
    if (!message) break;
    heard_ = true;
    const Time thought = a.mind.model().thought(message->cpuSeconds, message->instructions);
    switch (a.mind.take(message->text)) {
      case AgentMind::Result::question:
        a.link->send(fmt::format("C{}", thought));
        break;
      case AgentMind::Result::done:
        acts_.clear();
        a.mind.end(thought, acts_);
        for (spades::Act& act : acts_) a.acts.push_back(std::move(act));
        if (thinkTimes_) {
          a.began = Clock::now();
          a.link->send(a.mind.inform());
        }
        break;
      case AgentMind::Result::exit:
        a.lose("it leaves");
        break;
      case AgentMind::Result::flood:
        a.lose(fmt::format("it sends more than {} bytes of acts in one thought", AgentMind::kMostActs));
        break;
      case AgentMind::Result::ready:
      case AgentMind::Result::nothing:
        break;
    }
  }
  if (!a.link->lost().empty()) a.lose(a.link->lost());
  if (!a.link->reachable()) a.began = Clock::now();  // it may have answered
  const char* const waits = !a.mind.ready()     ? "says nothing"
                            : a.mind.thinking() ? "thinks"
                            : a.mind.informed() ? "does not answer K"
                                                : nullptr;
  if (waits && std::chrono::duration<double>(Clock::now() - a.began).count() > mostThought_)
    a.lose(fmt::format("it {} for more than {} s", waits, mostThought_));
}

/// Passes the next message to the agent that is due.
void SpadesServer::deliver(Agent& a) {
  if (a.closed) return;
  const auto message = a.mind.next(now(), modelOf(a.model));
  if (!message) return;
  if (a.mind.model().instructions)  // its think time may be another one since it was started
    if (const std::string lacks = a.link->countInstructions(); !lacks.empty()) a.lose(lacks);
  a.began = Clock::now();
  if (a.lost.empty()) a.link->send(*message);
}

/// Passes the acts that take effect now to the consumer.
void SpadesServer::feed(Agent& a) {
  for (; a.connected && !a.closed && consumer_ && !a.acts.empty() && a.acts.front().due <= now(); a.acts.pop_front()) {
    put(Input::Kind::message, a, a.acts.front().data);
    consumer_->received(a, a.acts.front().data);
  }
}

void SpadesServer::removeLost() {
  for (std::size_t i = 0; i < agents_.size();) {
    Agent& a = *agents_[i];
    // When a program ends is not the same in every run. It is missed at the step to which the world can run without its
    // answer to the next message, which is; until then its acts take effect.
    const bool missed = a.closed || !a.connected || a.mind.horizon() <= now();
    if (a.lost.empty() || !missed) {
      ++i;
      continue;
    }
    kernel().log().warning("{}: {} is lost at step {}: {}.", path(), a.peer(), now(), a.lost);
    ++lost_;
    if (a.connected && consumer_) {
      put(Input::Kind::leave, a);
      consumer_->disconnected(a);
    }
    agents_.erase(agents_.begin() + static_cast<std::ptrdiff_t>(i));
    if (!agents_.empty()) continue;
    kernel().log().error("{}: all agents are lost, the simulation goes on without any.", path());
    kernel().countFault();
  }
}

bool SpadesServer::ready(bool) {
  if (playing() || (stage_ == Stage::queued && queue_.empty())) return true;  // without agents it holds nothing
  return stage_ == Stage::running &&
         std::all_of(agents_.begin(), agents_.end(), [this](const auto& a) { return a->mind.horizon() > now(); });
}

std::optional<AgentTimes> SpadesServer::times(const IConnection& connection) const {
  const auto is = [&connection](const auto& a) { return a.get() == &connection; };
  const auto agent = std::find_if(agents_.begin(), agents_.end(), is);
  if (agent == agents_.end()) return std::nullopt;
  const AgentMind& mind = (*agent)->mind;
  const spades::Latencies& latencies = (*agent)->latencies;
  return AgentTimes{mind.thoughts().last(), mind.thoughts().mean(), static_cast<double>(latencies.sense),
                    static_cast<double>(latencies.act), mind.dropped()};
}

bool SpadesServer::wait(double seconds) {
  std::vector<pollfd> waiting;
  for (const auto& a : agents_) a->link->addDescriptors(waiting);
  if (comm_) comm_->addDescriptors(waiting);
  ::poll(waiting.data(), waiting.size(), std::clamp(static_cast<int>(seconds * 1000), 0, kMostWait));
  poll();
  return heard_;
}

}  // namespace spark
