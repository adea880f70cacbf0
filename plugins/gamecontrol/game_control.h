#pragma once
/// \file
/// Game control: makes agents of connections and behaviours, dispatches their actions to effectors, asks their
/// perceptors.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "api/agents.h"
#include "gamecontrol/hold.h"
#include "gamecontrol/participant.h"

namespace spark {

/// At /sys/server/gamecontrol. Children: a parser, control aspects.
class GameControl : public Node, public IGameControl, public IConnectionConsumer, public IInputGate {
  SPARK_CLASS(GameControl, Node)
 public:
  static void describe(Description<GameControl>& d);

  const std::vector<AgentAspect*>& agents() const override;
  void removeAgent(AgentAspect& agent, bool close) override;
  int agentsSeen() const override { return agentsSeen_; }
  const Predicates* percepts(const AgentAspect& agent) const override;
  double latency(const AgentAspect& agent) const override;

  void connected(IConnection& connection) override;
  void received(IConnection& connection, std::string_view message) override;
  void disconnected(IConnection& connection) override;

  bool ready(bool lockstep) override;

  /// Asked by an effector that is about to load a robot for `agent`. False: not in this cycle, ask again in the next.
  bool mayLoad(const AgentAspect& agent);
  /// A line that an agent caused; they are limited.
  void complain(const std::string& line);

 protected:
  void onUnlink() override;
  void saveState(StateWriter& out) const override;
  void loadState(StateReader& in) override;

 private:
  using Participant = gamecontrol::Participant;
  using Clock = gamecontrol::Clock;

  void act(const Event& event);
  void takeTurn(const Event& event);
  void sense(const Event& event);

  void removeLeaving();
  void joinBehaviors();
  void joinNewcomers();
  bool join(std::unique_ptr<Participant> participant);
  void resolveParsers();
  void resolveRobots();
  void deliver();
  bool answered(Participant& p, Clock::time_point now, bool somebodyJoins);
  bool isStranger(const Participant& p, Clock::time_point now) const;
  bool indulge(Clock::time_point now);
  bool tooSoon(Clock::time_point now) const;
  bool full() const;
  void closeIdle();
  bool realTime() const;
  bool holding() const { return expect_ > 0 && !released_; }
  Participant* participantOf(const IConnection& connection) const;
  const Participant* participantOf(const AgentAspect& agent) const;
  void agentsChanged();
  void note(const std::string& line);
  gamecontrol::AgentLines& lines();
  double joinBudget() const { return joinBudget_; }
  void setJoinBudget(double seconds);
  int agentCount() const { return static_cast<int>(agents().size()); }
  std::int64_t messagesDropped() const { return messagesDropped_; }

  std::vector<std::unique_ptr<Participant>> participants_;  ///< in order of number
  std::vector<std::unique_ptr<Participant>> newcomers_;     ///< in order of arrival
  std::vector<std::uint64_t> refusedBehaviors_;  ///< ids of those that could not be made an agent; not tried again
  mutable std::vector<AgentAspect*> agents_;     ///< of participants_; asked in the simulation's thread only
  mutable TreeWatch agentsTree_;
  mutable std::size_t lastHeard_ = 0;  ///< index of the participant that sent the last message
  gamecontrol::Hold hold_;
  Link<IJoinPolicy> joinPolicy_;
  std::optional<gamecontrol::AgentLines> lines_;
  // What clients that are not trusted yet may take of a match in lockstep.
  gamecontrol::Allowance waits_{30, 0.1};  ///< s, and s a second
  gamecontrol::Allowance loading_{0, 4};   ///< robots, twice as many as there may be agents, and robots a second
  Clock::time_point indulgedAt_{};         ///< when this cycle was last kept waiting for them; zero: it was not

  std::string createEffector_ = "SceneEffector", robotFolder_ = "rsg/agent/";
  int expect_ = 0, maxAgents_ = 64, maxPending_ = 262144, perceptDelay_ = 1, loadsPerCycle_ = 4;
  bool sync_ = false, released_ = false;
  double joinBudget_ = 30, agentStep_ = 0, holdWait_ = 0.5, holdReport_ = 5, joinWait_ = 60, syncTimeout_ = 30,
         answerWait_ = 1, joinPace_ = 0.01, idleLimit_ = 60;

  int nextNumber_ = 1, agentsSeen_ = 0, loads_ = 0;
  std::int64_t messagesDropped_ = 0, cycle_ = 0;
  int cyclesToTurn_ = 0;     ///< between the next cycle and the agents' next turn
  bool isTurn_ = true;       ///< they have it in this cycle
  std::uint64_t round_ = 0;  ///< of sensing
  TreeWatch parsersTree_, robotsTree_, perceptorsTree_, behaviorsTree_;
  bool waiting_ = false;
  Clock::time_point waitingSince_{}, actedAt_{};
};

}  // namespace spark
