#pragma once
/// \file
/// Agents as the middleware SPADES has them: started by the server, told what they sense, timed by how long they think.

#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "agent_database.h"
#include "agent_mind.h"
#include "api/agents.h"
#include "api/credentials.h"
#include "api/inputs.h"
#include "api/net.h"
#include "api/phases.h"
#include "comm_port.h"
#include "spark/describe.h"
#include "think_time.h"
#include "type_latency.h"

namespace spark {

/// At /sys/server/spades; a child is a ThinkTime. Starts the queued agents, passes percepts of its consumer to them as
/// sensations and their acts to the consumer, each at its simulated time, and keeps the world from running ahead of
/// acts that may still come. Simulation thread.
class SpadesServer : public Node, public IInputSource, public IInputGate, public IReturningAgents, public IAgentTimes {
  SPARK_CLASS(SpadesServer, Node)
 public:
  static constexpr const char* kPath = "/sys/server/spades";
  SpadesServer();
  ~SpadesServer() override;
  static void describe(Description<SpadesServer>& d);

  /// Queues `count` agents of a type of the agent database. Throws Error if there is no such type, or the agents are
  /// started already.
  void queueAgents(const std::string& type, int count);

  void poll() override;
  bool wait(double seconds) override;
  bool ready(bool lockstep) override;
  std::optional<AgentTimes> times(const IConnection& connection) const override;

 protected:
  void onUnlink() override;
  /// It has no state: what is on its way between agents and the world is lost, as messages in a network are, and a run
  /// that goes on from a state starts the agents' programs anew.
  void loadState(StateReader& in) override;

 private:
  using Clock = std::chrono::steady_clock;
  class Agent;
  enum class Stage { queued, starting, running };

  bool playing() const { return tape_ && tape_->playing(); }
  spades::Time now() const { return simulation_ ? simulation_->cycle() : 0; }
  void start();
  void startAgent(const std::string& type);
  spades::CommPort::Server* serverFor(const std::string& type);
  void connectAll();
  /// The model of an agent type; `named`: that of its timer.
  spades::ThinkModel modelOf(const std::optional<spades::ThinkModel>& named) const;
  void exchange(Agent& agent);
  void deliver(Agent& agent);
  void feed(Agent& agent);
  void removeLost();
  void put(Input::Kind kind, const Agent& agent, std::string_view text = {});
  void readDatabase();
  void setDatabase(std::string file);
  int agentCount() const { return static_cast<int>(agents_.size()); }
  const std::string& database() const { return database_; }
  int port() const { return comm_ ? comm_->port() : port_; }
  void setToken(Secret token) { token_ = std::move(token.text); }
  void setPort(int port);
  bool thinkTimes() const { return thinkTimes_; }
  void setThinkTimes(bool on);
  void listen();
  const std::string& consumer() const { return consumerPath_; }
  void setConsumer(std::string path);

  int senseLatency_ = 10, actLatency_ = 10;
  std::string database_, logs_, consumerPath_ = "/sys/server/gamecontrol";
  bool thinkTimes_ = false;
  double mostThought_ = 10, shutdown_ = 2, away_ = 30;
  std::string address_ = "127.0.0.1", token_;
  int port_ = -1, commServers_ = 0;
  std::unique_ptr<spades::CommPort> comm_;   ///< nullptr: agents of this machine only
  std::map<std::string, std::size_t> next_;  ///< by type: of the servers that have it, which starts the next agent
  std::map<std::string, int> numbers_;       ///< of the agents that were started last, by type
  std::map<std::string, spades::AgentType> types_;
  std::vector<std::pair<std::string, int>> queue_;
  std::vector<std::unique_ptr<Agent>> agents_;  ///< in order of id
  std::vector<spades::Act> acts_;               ///< used by exchange()
  Stage stage_ = Stage::queued;
  bool heard_ = false;  ///< something happened in this poll()
  int nextId_ = 0, lost_ = 0;

  Link<ThinkTime> thinkTime_;
  Links<TypeLatency> typeLatencies_;
  Link<ISimulation> simulation_;
  Link<IInputTape> tape_;
  Link<IConnectionConsumer> consumer_;
};

}  // namespace spark
