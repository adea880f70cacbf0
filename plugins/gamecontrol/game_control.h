#pragma once
/// \file
/// Game control: creates agents for connections and behaviors, dispatches their actions to effectors, calls their
/// perceptors.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "api/agents.h"
#include "api/match.h"
#include "api/succession.h"
#include "gamecontrol/agent_list.h"
#include "gamecontrol/hold.h"
#include "gamecontrol/lockstep_gate.h"
#include "gamecontrol/minds.h"
#include "gamecontrol/participant.h"
#include "gamecontrol/questions.h"
#include "gamecontrol/vacancies.h"

namespace spark {

/// At /sys/server/gamecontrol. Its children are a parser, control aspects and perhaps a join policy. Simulation thread
/// only; in the sense phase it distributes agents over the kernel's threads.
class GameControl : public Node,
                    public IGameControl,
                    public IRemarks,
                    public ISuccession,
                    public IConnectionConsumer,
                    public IInputGate {
  SPARK_CLASS(GameControl, Node)
 public:
  /// Name of the effector with which an agent requests its robot, below its aspect.
  static constexpr const char* kCreateEffector = "_CreateEffector";
  static void describe(Description<GameControl>& d);

  const std::vector<AgentAspect*>& agents() const override { return agents_.all(*this); }
  void removeAgent(AgentAspect& agent, bool close) override;
  void disqualify(AgentAspect& agent, std::string_view why) override;
  std::string judgeRequest(AgentAspect& agent, const PartRequest& request) override;
  int agentsSeen() const override { return agentsSeen_; }
  const Predicates* percepts(const AgentAspect& agent) const override;
  double latency(const AgentAspect& agent) const override;
  List senseNow(Node& node) override;
  IConnection* connection(const AgentAspect& agent) const override;
  void withdrawAgents() override;
  void restoreAgent(Node& parent, const std::string& name, int number) override;
  bool remark(const AgentAspect& agent, std::string_view predicate, std::string_view why) override;

  Claim claim(AgentAspect& holder, bool again) override;

  void connected(IConnection& connection) override;
  void received(IConnection& connection, std::string_view message) override;
  void disconnected(IConnection& connection) override;

  /// True if the next cycle may begin: the hold is over, and in lockstep all agents that are waited for have answered.
  bool ready(bool lockstep) override;

  /// True if a robot may be loaded for `agent` in this cycle; otherwise the effector tries again in the next one.
  bool mayLoad(const AgentAspect& agent);
  /// True if the agent takes part only if what it asks for in this act phase is granted (`requireAll`).
  bool requiresWhatItAsks(const AgentAspect& agent) const;
  /// The agent does not take part; `why`: one line without a full stop at its end.
  void reject(AgentAspect& agent, const std::string& why);
  /// Writes a log line that an agent caused; their rate is limited.
  void logError(const std::string& line);

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
  void release(AgentAspect& aspect);
  void joinBehaviors();
  void joinNewcomers();
  bool join(std::unique_ptr<Participant> participant, AgentAspect* ready = nullptr);
  void executeTurn(const Event& event);
  int numberOfNextRule() const;
  List agentPaths() const { return agents_.paths(*this); }
  void disqualifyAgent(const Value& agent, const std::string& why) { disqualify(agents_.at(agent, *this), why); }
  void removeAgentAt(const Value& agent) { removeAgent(agents_.at(agent, *this), true); }
  AgentAspect& createAspect(Node& parent, const std::string& name);
  bool seat(IConnection& connection);
  bool resume(Participant* player, Participant& client);
  template <class F>
  void forEachAspect(F f);
  void resolveParsers();
  void resolveRobots();
  void deliver();
  /// The timing of agents: the child's, otherwise the default.
  const IAgentTiming& timing() const { return timing_ ? *timing_ : plainTiming_; }
  bool full() const;
  void closeWithoutRobot();
  bool realTime() const;
  /// The wall clock, as of the tape.
  Clock::time_point now() const;
  bool holding() const { return expect_ > 0 && !released_; }
  Participant* participantOf(const IConnection& connection) const;
  void agentsChanged();
  void logInfo(const std::string& line);
  gamecontrol::AgentLog& agentLog();
  double joinBudget() const { return joinBudget_; }
  void setJoinBudget(double seconds);
  int agentCount() const { return static_cast<int>(agents().size()); }
  std::int64_t messagesDropped() const { return messagesDropped_; }

  gamecontrol::Participants participants_;  ///< in order of number
  gamecontrol::Participants newcomers_;     ///< in order of arrival
  gamecontrol::AgentList agents_{participants_};
  gamecontrol::Minds minds_{participants_};
  gamecontrol::Questions questions_;
  mutable std::size_t lastHeard_ = 0;  ///< index of the participant that sent the last message
  gamecontrol::Hold hold_;
  Link<IJoinPolicy> joinPolicy_;
  IAgentTiming plainTiming_;
  Link<IInputTape> tape_;
  Link<IAgentTiming> timing_;
  Links<IAgentJudge> judges_;
  gamecontrol::JudgeList activeJudges_;  ///< of this turn
  std::optional<gamecontrol::AgentLog> log_;
  gamecontrol::LockstepGate lockstep_;
  /// Robots that untrusted clients may load in lockstep; capacity: 2 * maxAgents; refilled by robots per second.
  gamecontrol::TokenBucket loadBudget_{0, 4};

  std::string createEffector_ = "SceneEffector", robotFolder_ = "rsg/agent/";
  int expect_ = 0, maxAgents_ = 64, maxPending_ = 262144, loadsPerCycle_ = 4;
  bool sync_ = false, requests_ = false, requireAll_ = true, byArrival_ = false;
  std::uint64_t arrivals_ = 0;               ///< number of the last message
  std::vector<Participant*> byArrivalList_;  ///< participants in the order in which they act, with byArrival
  bool released_ = false;                    ///< the hold is over
  bool restored_ = false;                    ///< a state was loaded since the last act phase
  double joinBudget_ = 30, holdWait_ = 0.5, holdReport_ = 5, joinWait_ = 60, syncTimeout_ = 30, answerWait_ = 1,
         joinPace_ = 0.01, idleLimit_ = 60;

  int nextNumber_ = 1, agentsSeen_ = 0;
  int loads_ = 0;  ///< robots loaded in this cycle
  std::int64_t messagesDropped_ = 0, cycle_ = 0;
  int cyclesToTurn_ = 0;     ///< cycles without agents between now and their next turn
  bool isTurn_ = true;       ///< agents act and sense in this cycle
  std::uint64_t round_ = 0;  ///< number of the sense phase
  TreeWatch parsersTree_, robotsTree_, perceptorsTree_;
  Clock::time_point actedAt_{};   ///< when the last act phase began
  Clock::time_point lookedAt_{};  ///< when ready() or act() began last; input has been read since
};

}  // namespace spark
