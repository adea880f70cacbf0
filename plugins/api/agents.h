#pragma once
/// \file
/// Agents: the aspect that turns a subtree into an agent, its perceptors and effectors, control aspects, parsers, and
/// the services of game control.

#include <array>
#include <cstdint>
#include <optional>

#include "api/net.h"
#include "api/phases.h"
#include "api/scene.h"
#include "spark/abi/api/agents.h"
#include "spark/predicates.h"

namespace spark {

/// The range of numbers that parsers write in double precision; all others are written in single precision. After 18
/// hours a single-precision clock would not advance in some cycles, and some clients exit if two messages have the same
/// time.
inline constexpr DoubleRange kLateClocks{65536, 1e9};

/// Converts between message bytes and predicates. A child of game control, or of a port that speaks another language.
class IParser {
 public:
  SPARK_INTERFACE(IParser, 1);
  virtual ~IParser() = default;
  /// Appends the predicates of `message` to `out`. Lists that were complete before an error stay in `out`. Does not
  /// throw on malformed bytes: the result says where and why.
  virtual ReadResult parse(std::string_view message, Predicates& out) = 0;
  /// Appends the message for `predicates` to `out`. Called by several threads at once in the sense phase.
  virtual void write(const Predicates& predicates, std::string& out) = 0;
};

/// Turns a subtree into an agent. Game control creates one per connection (`/usr/scene/AgentAspect<n>`); robots of the
/// installed base nest a second one in it. One that a config or a script makes below an object, with a Behavior below
/// it, makes the object an agent; when it is removed, the object is an object again. Registered by `gamecontrol`.
class AgentAspect : public Transform {
  SPARK_CLASS(AgentAspect, Transform)
 public:
  static void describe(Description<AgentAspect>& d) {
    d.doc("Root of an agent: collects the perceptors and effectors below it.");
    d.property("number", &AgentAspect::number)
        .doc("Game control's number of the agent; 0 for nested aspects and for rules.");
    d.method("sense", &AgentAspect::senseNow)
        .doc("Asks all perceptors below it and returns what they sense now: nested lists, as a mind gets them.");
  }
  /// The agent's number, from 1; agents act in this order. 0: a nested aspect or a rule, no agent of its own.
  int number() const { return number_; }
  /// Called once by game control.
  void setNumber(int n) { number_ = n; }
  /// The agent's own part of the scene: the outermost aspect, or the object that it makes an agent, which is the
  /// transform that it is a child of. Aspects of robots are children of the scene.
  Node& object() {
    AgentAspect& top = outermost();
    Transform* const above = top.parent() ? top.parent()->as<Transform>() : nullptr;
    return above ? static_cast<Node&>(*above) : top;
  }
  /// The outermost aspect above, or this one.
  AgentAspect& outermost() {
    AgentAspect* top = this;
    for (auto* up = ancestor<AgentAspect>(); up; up = up->ancestor<AgentAspect>()) top = up;
    return *top;
  }

 private:
  List senseNow();
  int number_ = 0;
};

/// Writes a percept. It runs in the sense phase, where several threads may each handle one agent: it may read the world
/// and change only itself. Registered by `gamecontrol`.
class Perceptor : public SceneNode {
  SPARK_CLASS(Perceptor, SceneNode)
 public:
  static void describe(Description<Perceptor>& d) {
    d.doc("A sensor of the agent above it.");
    d.property("interval", &Perceptor::interval_).min(1).doc("Senses in every n-th cycle of its agent.");
    d.property("predicateName", &Perceptor::predicateName_).doc("Name of the percept, where the class allows another.");
    d.property("messageName", &Perceptor::messageName, &Perceptor::setMessageName)
        .doc("The sensor's name in messages: the node's unless another is set.");
    d.method("sense", &Perceptor::senseNow)
        .doc("Returns what it senses now, its modifiers included: nested lists. What it senses later is not changed.");
    d.abstract();
  }
  /// Cycles of the agent from one percept to the next, at least 1.
  int interval() const { return interval_; }
  /// Name of the percept; "": the class's own.
  const std::string& predicateName() const { return predicateName_; }
  /// The sensor's name in messages: that of the node, unless another was set, such as one that no node can have.
  const std::string& messageName() const { return messageName_.empty() ? name() : messageName_; }
  /// Sets that name; "": the node's.
  void setMessageName(std::string name) { messageName_ = std::move(name); }
  /// Appends zero or more top-level lists to `out`. `event` is that of the sense phase. Must not throw.
  virtual void sense(Predicates& out, const Event& event) = 0;

 protected:
  int interval_ = 1;
  std::string predicateName_;

 private:
  List senseNow();
  std::string messageName_;
};

/// Data that several perceptors share, such as the visible objects of the scene: it is updated once, before the first
/// of them senses. Offered by perceptors.
class ISharedView {
 public:
  SPARK_INTERFACE(ISharedView, 1);
  virtual ~ISharedView() = default;
  /// Updates the shared data. Called at the start of the sense phase, in the simulation's thread, for each perceptor
  /// that will sense, before any of them does. `round` differs from one sense phase to the next: the first call with a
  /// new `round` updates, later ones return at once.
  virtual void share(std::uint64_t round) = 0;
};

/// A vision sensor, for viewers that show what an agent sees beside the ground truth. Offered by perceptors that report
/// polar coordinates. Used between two cycles, in the simulation's thread; poses are those of the moment of the call.
class IEye {
 public:
  SPARK_INTERFACE(IEye, 1);
  virtual ~IEye() = default;
  /// An object that can be seen.
  struct Sight {
    std::string name;  ///< the words of its percept: "B", "P Red 3", "P Red 3 head"
    Vec3f place;       ///< true position, world frame [m]
  };
  /// Pose of the sensor, world frame: x forward, y to the left, z up.
  virtual Matrix view() = 0;
  /// Full horizontal (at most 360) and vertical (at most 180) field of view [deg].
  virtual std::array<double, 2> cone() = 0;
  /// Largest distance that it sees [m]; infinite: no limit.
  virtual double range() = 0;
  /// Position in the world frame [m] of a point given in the percept's polar coordinates [m, deg, deg].
  virtual Vec3f placeOf(double distance, double horizontalDeg, double verticalDeg) = 0;
  /// Appends all objects of the scene that can be seen, inside the field of view or not.
  virtual void sights(std::vector<Sight>& out) = 0;
};

/// How long messages between an agent and the world are under way [cycles].
struct AgentLatencies {
  /// From sensing to the arrival of the percepts; 0: they arrive in the cycle in which they were sensed.
  int sense = 1;
  /// From the turn that receives an action to the one in which it takes effect; 0: it takes effect at once.
  int act = 0;
};

/// Decides when agents sense, when their percepts arrive, and when their actions take effect. A child of game control;
/// without one, agents have what these functions return here. Simulation thread.
class IAgentTiming {
 public:
  SPARK_INTERFACE(IAgentTiming, 1);
  virtual ~IAgentTiming() = default;
  /// Cycles from the turn of the agents that begins now to the next one, at least 1. Agents act and sense in their
  /// turns only. `step`: simulated time of a cycle [s]. Act phase.
  virtual int cyclesToNextTurn([[maybe_unused]] double step) const { return 1; }
  /// True if the agent senses in this cycle, which is a turn. Sense phase.
  virtual bool senses(const AgentAspect&, [[maybe_unused]] std::int64_t cycle) const { return true; }
  /// True: an agent that has sensed nothing gets a message without percepts.
  virtual bool sendsEmpty() const { return false; }
  /// The agent's latencies, neither of them negative; called once in each turn. Messages that are under way keep their
  /// time, and a later one never arrives before them. Act phase.
  virtual AgentLatencies latencies(const AgentAspect&) const { return {}; }
};

/// A port that starts its agents itself: in a run that goes on from a saved state each comes back with the id that its
/// connection had then.
class IReturningAgents {
 public:
  SPARK_INTERFACE(IReturningAgents, 1);
  virtual ~IReturningAgents() = default;
};

/// How long an agent thinks in simulated time, and its latencies.
struct AgentTimes {
  double last = 0;           ///< its last thought [steps]; NaN before the first
  double mean = 0;           ///< mean of its recent thoughts [steps]; NaN before the first
  double senseLatency = 0;   ///< from sensing to the arrival of the sensation [steps]
  double actLatency = 0;     ///< from the end of a thought until its acts take effect [steps]
  std::int64_t dropped = 0;  ///< sensations that it did not get because it thought for too long
};

/// Lets agents think in simulated time. Offered by the port of their connections.
class IAgentTimes {
 public:
  SPARK_INTERFACE(IAgentTimes, 1);
  virtual ~IAgentTimes() = default;
  /// The times of the agent behind a connection; nullopt: the connection is not one of this port. Simulation thread,
  /// between cycles.
  virtual std::optional<AgentTimes> times(const IConnection& connection) const = 0;
};

/// Logs the mistakes of agents. Offered by game control.
class IRemarks {
 public:
  SPARK_INTERFACE(IRemarks, 1);
  virtual ~IRemarks() = default;
  /// Logs that an action of the agent had no effect, or another than it says; `why`: one line with what was expected
  /// and what was found. Each kind of mistake of an agent is logged once: lines that differ only in numbers and in what
  /// they quote ('...') are of one kind. False if the line was dropped because there were too many. Simulation thread.
  virtual bool remark(const AgentAspect& agent, std::string_view predicate, std::string_view why) = 0;
};

/// Executes the actions of its agent that carry its predicate. Registered by `gamecontrol`.
class Effector : public SceneNode {
  SPARK_CLASS(Effector, SceneNode)
 public:
  static void describe(Description<Effector>& d) {
    d.doc("An actuator of the agent above it, addressed by its predicate.");
    d.property("predicate", &Effector::predicate).doc("The predicate it answers to.");
    d.property("messageName", &Effector::messageName, &Effector::setMessageName)
        .doc("The effector's name in messages: the node's unless another is set.");
    d.abstract();
  }
  /// The predicate it answers to: messageName() for joints, a fixed word for others. Read again when the tree changed.
  virtual std::string predicate() const { return messageName(); }
  /// The effector's name in messages: that of the node, unless another was set, such as one that no node can have.
  const std::string& messageName() const { return messageName_.empty() ? name() : messageName_; }
  /// Sets that name, before the agent's effectors are listed; "": the node's.
  void setMessageName(std::string name) { messageName_ = std::move(name); }
  /// Executes `(predicate arguments...)`, in the act phase. Immediate effectors act now; others store the command and
  /// act in the prepare phase. Returns "" or one line that says what was wrong (expected, found); the log names the
  /// agent and the predicate, too, and has one line for each kind of mistake (IRemarks). Must not throw.
  virtual std::string act(const Element& action) = 0;

  /// The innermost agent aspect above; nullptr outside of agents.
  AgentAspect* agent() const { return ancestor<AgentAspect>(); }

 protected:
  /// As the return value of act(), for reasons that appear later, such as in the prepare phase. `kind`: 0 to 31; one
  /// line is logged for each, and only then `why()` is called, which returns it. Simulation thread.
  template <class Why>
  void refuse(int kind, Why&& why);

 private:
  std::uint32_t refused_ = 0;  ///< a bit for each kind
  std::string messageName_;
};

/// A rule of the simulation; a child of game control. Rules run in the rule phase, in child order. Like any agent
/// aspect it may have perceptors, effectors and a Behavior below it. It is not listed among the agents, has the number
/// 0, and is not judged. Registered by `gamecontrol`.
class ControlAspect : public AgentAspect {
  SPARK_CLASS(ControlAspect, AgentAspect)
 public:
  static void describe(Description<ControlAspect>& d) {
    d.doc("A rule of the simulation.");
    d.abstract();
    d.property("enabled", &ControlAspect::enabled_).doc("False: the rule has no effect, as if it were not there.");
    d.property("localTransform", &ControlAspect::local).doc("A rule is at the origin of the world.");
    d.property("localPos", &ControlAspect::localPos).unit("m").doc("A rule is at the origin of the world.");
    d.property("worldTransform", &ControlAspect::worldNow).doc("World 4x4 matrix: that of what the rule is below.");
    d.on<&ControlAspect::run>(phase::kRule);
  }
  /// Applies the rule, once in each cycle while it is enabled.
  virtual void rule(const Event& event) = 0;
  /// Called instead of rule() while the rule is disabled: clears what must not count when it is enabled again.
  virtual void rest(const Event&) {}
  /// False: rule() is not called.
  bool enabled() const { return enabled_; }
  /// Called by game control after an agent's aspect was linked.
  virtual void agentConnected(AgentAspect&) {}
  /// Called by game control before an agent's aspect is removed.
  virtual void agentLeaving(AgentAspect&) {}

 protected:
  /// A rule cannot be moved: its place is no state.
  void saveState(StateWriter&) const override {}
  void loadState(StateReader&) override {}

 private:
  void run(const Event& event) { enabled_ ? rule(event) : rest(event); }
  bool enabled_ = true;
};

/// What an agent asks for while it runs: a perceptor, an effector, or a scene file with some of them.
struct PartRequest {
  enum class Kind { perceptor, effector, scene } kind;
  std::string_view type;  ///< name of the class; of a scene: of the file
  std::string_view name;  ///< of the new node; "" for a scene
  Node& parent;           ///< where the new node is to be: the agent's aspect or a node below it
  /// Of a part that comes with a scene file: that file; "": the agent asks for the part itself.
  std::string_view file{};
};

/// Sees what agents ask for and what they do, and may refuse it. Offered by control aspects; one that is disabled sees
/// nothing. It may also call IGameControl::disqualify(). Simulation thread.
class IAgentJudge {
 public:
  SPARK_INTERFACE(IAgentJudge, 1);
  virtual ~IAgentJudge() = default;
  /// Judges a request before the node is made, in the prepare phase. Returns "" or one line that says why it is
  /// refused; the agent gets this line. Of a scene file, also that of its robot, it judges the file first, and then
  /// each perceptor and effector that it brings (`request.file`), which are there already: if one is refused, all are
  /// removed again. Must not throw.
  virtual std::string judgeRequest(AgentAspect&, const PartRequest&) { return {}; }
  /// Judges an action before the effector executes it, in the act phase, in the order of the agent's message. Returns
  /// "" or one line that says why it is refused; the log gets this line. Must not throw.
  virtual std::string judgeAction(AgentAspect&, const Effector&, const Element&) { return {}; }
};

/// The program of an agent that runs inside the host: a C++ class or Lua. Below /usr/agent, or below the AgentAspect of
/// an object or a rule. Registered by `gamecontrol`.
class Behavior : public Node {
  SPARK_CLASS(Behavior, Node)
 public:
  static void describe(Description<Behavior>& d) {
    d.doc("A program that drives an agent from inside the host.");
    d.abstract();
  }
  /// Appends the first actions, such as `(scene ...)`. Called once, when the agent exists.
  virtual void start(Predicates& actions) = 0;
  /// Appends the actions for the next cycle. `percepts` are those of the last cycle, valid during the call.
  virtual void think(const Predicates& percepts, Predicates& actions) = 0;
};

/// Game control: connects agents to the simulation. At /sys/server/gamecontrol.
class IGameControl {
 public:
  SPARK_INTERFACE(IGameControl, 5);
  static constexpr const char* kPath = "/sys/server/gamecontrol";
  virtual ~IGameControl() = default;
  /// The agents, sorted by number. Valid until an agent is added or removed.
  virtual const std::vector<AgentAspect*>& agents() const = 0;
  /// Removes the agent at the start of the next act phase; `close`: closes its connection, too.
  virtual void removeAgent(AgentAspect& agent, bool close) = 0;
  /// Removes the agent like removeAgent(), closes its connection, and logs why: one line without a full stop at its
  /// end.
  virtual void disqualify(AgentAspect& agent, std::string_view why) = 0;
  /// Asks all judges (IAgentJudge) about a request. Returns "" if none of them refuses it, otherwise the reason.
  virtual std::string judgeRequest(AgentAspect& agent, const PartRequest& request) = 0;
  /// Number of agents that ever had a robot.
  virtual int agentsSeen() const = 0;
  /// The agent's last percepts; nullptr before the first and for an aspect that is no agent. Valid until the next sense
  /// phase. Perceptors that were not due in the last one are missing.
  virtual const Predicates* percepts(const AgentAspect& agent) const = 0;
  /// Wall time from sending percepts to the agent's next message [s], smoothed over some 16 messages. NaN when it is
  /// not known: the agent runs inside the host, has not answered yet, or is no agent.
  virtual double latency(const AgentAspect& agent) const = 0;
  /// What the perceptors at and below a node sense now, as nested lists: for minds and rules that ask when they want to
  /// know. Modifiers act. Nothing changes by it: what the perceptors sense later is the same as without the question.
  /// Throws Error if a perceptor fails, or in the middle of another question. Simulation thread.
  virtual List senseNow(Node& node) = 0;
  /// The agent's connection; nullptr: it runs inside the host, its client has left, or it is no agent. Valid until the
  /// next cycle.
  virtual IConnection* connection(const AgentAspect& agent) const = 0;
  /// For a snapshot that is restored: all agents leave the scene at once, as control aspects see it. Clients
  /// stay connected until the state of game control is loaded.
  virtual void withdrawAgents() = 0;
  /// For a snapshot that is restored: an agent joins again as it did, below `parent`; control aspects make what they
  /// made then.
  virtual void restoreAgent(Node& parent, const std::string& name, int number) = 0;
};

inline List AgentAspect::senseNow() { return require<IGameControl>(IGameControl::kPath).senseNow(*this); }
inline List Perceptor::senseNow() { return require<IGameControl>(IGameControl::kPath).senseNow(*this); }

template <class Why>
void Effector::refuse(int kind, Why&& why) {
  if (refused_ >> kind & 1) return;
  AgentAspect* const aspect = agent();
  auto* const remarks = kernel().root().find<IRemarks>(IGameControl::kPath);
  if (!aspect || !remarks)
    kernel().log().warning("{}: {}", path(), why());
  else if (!remarks->remark(aspect->outermost(), predicate(), why()))
    return;
  refused_ |= std::uint32_t(1) << kind;
}

/// Marks the effector whose command says that the agent has finished its cycle in lockstep. Offered by the `syn`
/// effector.
class ISyncEffector {
 public:
  SPARK_INTERFACE(ISyncEffector, 1);
  virtual ~ISyncEffector() = default;
};

}  // namespace spark
