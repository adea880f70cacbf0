#pragma once
/// \file
/// Agents: the aspect that makes a subtree an agent, its perceptors and effectors, control aspects, parsers, and game
/// control's services.

#include <array>

#include "api/net.h"
#include "api/phases.h"
#include "api/scene.h"
#include "spark/abi/api/agents.h"
#include "spark/predicates.h"

namespace spark {

/// Numbers of messages that parsers write in double precision, all others in single: a clock of single precision stands
/// still for some cycles after 18 hours, and clients end at two messages of one time.
inline constexpr DoubleRange kLateClocks{65536, 1e9};

/// Bytes to predicates and back. Below game control, or below a port to speak another language there.
class IParser {
 public:
  SPARK_INTERFACE(IParser, 1);
  virtual ~IParser() = default;
  /// Appends what the message holds. What was complete before an error stays. Never throws on bad bytes.
  virtual ReadResult parse(std::string_view message, Predicates& out) = 0;
  /// Appends the message for `predicates`. Called by several threads at once in the sense phase.
  virtual void write(const Predicates& predicates, std::string& out) = 0;
};

/// Turns a subtree into an agent. Game control makes one per connection (`/usr/scene/AgentAspect<n>`); robots of the
/// installed base nest a second one. Registered by `gamecontrol`.
class AgentAspect : public Transform {
  SPARK_CLASS(AgentAspect, Transform)
 public:
  static void describe(Description<AgentAspect>& d) {
    d.doc("Root of an agent: collects the perceptors and effectors below it.");
    d.property("number", &AgentAspect::number).doc("Game control's number of the agent; 0 for nested aspects.");
  }
  /// Agents act and are numbered in this order. 0: nested, not an agent of its own.
  int number() const { return number_; }
  void setNumber(int n) { number_ = n; }
  /// The outermost aspect above (or this).
  AgentAspect& outermost() {
    AgentAspect* top = this;
    for (auto* up = ancestor<AgentAspect>(); up; up = up->ancestor<AgentAspect>()) top = up;
    return *top;
  }

 private:
  int number_ = 0;
};

/// Writes what it senses. Called in the sense phase, possibly by several threads, one agent a thread: reads the world,
/// changes only itself. Registered by `gamecontrol`.
class Perceptor : public SceneNode {
  SPARK_CLASS(Perceptor, SceneNode)
 public:
  static void describe(Description<Perceptor>& d) {
    d.doc("A sensor of the agent above it.");
    d.property("interval", &Perceptor::interval_).min(1).doc("Senses in every n-th cycle of its agent.");
    d.property("predicateName", &Perceptor::predicateName_).doc("Name of its percept where the class allows another.");
    d.abstract();
  }
  int interval() const { return interval_; }
  const std::string& predicateName() const { return predicateName_; }
  /// Appends zero or more top-level lists. `event`: the sense phase.
  virtual void sense(Predicates& out, const Event& event) = 0;

 protected:
  int interval_ = 1;
  std::string predicateName_;
};

/// Something that several perceptors look at, as eyes look at one scene: it is brought up to date once, before the
/// first of them senses. Offered by perceptors.
class ISharedView {
 public:
  SPARK_INTERFACE(ISharedView, 1);
  virtual ~ISharedView() = default;
  /// The sense phase, in the simulation's thread: this perceptor will be asked, and none was asked yet. `round` differs
  /// from phase to phase.
  virtual void share(std::uint64_t round) = 0;
};

/// An eye, for those who show what an agent sees beside what is true. Offered by perceptors that tell polar
/// coordinates. Used between two cycles, in the simulation's thread; it looks anew at where things are.
class IEye {
 public:
  SPARK_INTERFACE(IEye, 1);
  virtual ~IEye() = default;
  /// Something that may be seen. Its name is made of its percept's words: "B", "P Red 3", "P Red 3 head".
  struct Sight {
    std::string name;
    Vec3f place;  ///< in the world [m]
  };
  /// Where it is and looks, in the world: x forward, y to the left, z up.
  virtual Matrix view() = 0;
  /// Full horizontal (at most 360) and vertical (at most 180) angle in which it sees [deg].
  virtual std::array<double, 2> cone() = 0;
  /// How far it sees [m]; infinite: no limit.
  virtual double range() = 0;
  /// The place in the world that polar coordinates of its percept mean.
  virtual Vec3f placeOf(double distance, double horizontalDeg, double verticalDeg) = 0;
  /// Appends all there is to be seen in the scene, within its cone or not, and where it truly is.
  virtual void sights(std::vector<Sight>& out) = 0;
};

/// Acts for its agent. Registered by `gamecontrol`.
class Effector : public SceneNode {
  SPARK_CLASS(Effector, SceneNode)
 public:
  static void describe(Description<Effector>& d) {
    d.doc("An actuator of the agent above it, addressed by its predicate.");
    d.property("predicate", &Effector::predicate).doc("The predicate it answers to.");
    d.abstract();
  }
  /// The predicate it answers to: the node's name for joints, a fixed word for others. Asked when the tree changed.
  virtual std::string predicate() const { return name(); }
  /// The act phase: a list `(predicate arguments...)` came. Immediate effectors act now; others keep it and act in
  /// prepare. Returns "" or one line that says what was wrong (expected, found); nothing is thrown.
  virtual std::string act(const Element& action) = 0;

  /// The innermost agent aspect above; nullptr outside of agents.
  AgentAspect* agent() const { return ancestor<AgentAspect>(); }
};

/// A rule of the simulation, child of game control; runs in the rule phase, in child order. Registered by
/// `gamecontrol`.
class ControlAspect : public Node {
  SPARK_CLASS(ControlAspect, Node)
 public:
  static void describe(Description<ControlAspect>& d) {
    d.doc("A rule of the simulation.");
    d.abstract();
    d.property("enabled", &ControlAspect::enabled_).doc("It takes part; false: as if it were not there.");
    d.on<&ControlAspect::run>(phase::kRule);
  }
  virtual void rule(const Event& event) = 0;
  /// Instead of rule() while it is switched off: forgets what must not count when it is switched on again.
  virtual void rest(const Event&) {}
  bool enabled() const { return enabled_; }
  /// Game control tells of agents: after the aspect is linked, before it is removed.
  virtual void agentConnected(AgentAspect&) {}
  virtual void agentLeaving(AgentAspect&) {}

 private:
  void run(const Event& event) { enabled_ ? rule(event) : rest(event); }
  bool enabled_ = true;
};

/// An agent that thinks inside the host: C++ classes or Lua. Below /usr/agent. Registered by `gamecontrol`.
class Behavior : public Node {
  SPARK_CLASS(Behavior, Node)
 public:
  static void describe(Description<Behavior>& d) {
    d.doc("A program that drives an agent from inside the host.");
    d.abstract();
  }
  /// Once, when the agent exists: the first actions, e.g. `(scene ...)`.
  virtual void start(Predicates& actions) = 0;
  /// The percepts of the last cycle came; append the actions for the next.
  virtual void think(const Predicates& percepts, Predicates& actions) = 0;
};

/// Game control, at /sys/server/gamecontrol.
class IGameControl {
 public:
  SPARK_INTERFACE(IGameControl, 1);
  static constexpr const char* kPath = "/sys/server/gamecontrol";
  virtual ~IGameControl() = default;
  /// The agents in order of number. Valid until an agent comes or goes.
  virtual const std::vector<AgentAspect*>& agents() const = 0;
  /// Removes the agent at the start of the next act phase; its connection is closed when `close`.
  virtual void removeAgent(AgentAspect& agent, bool close) = 0;
  /// Number of agents that ever had a robot.
  virtual int agentsSeen() const = 0;
  /// What an agent sensed last; nullptr when that is nothing yet or it is no agent. Valid until the next sense phase,
  /// in which perceptors that are not due say nothing.
  virtual const Predicates* percepts(const AgentAspect& agent) const = 0;
  /// Wall time from the agent's percepts being sent to the next message from it [s], smoothed over some 16 of them; NaN
  /// when not known: it lives inside the host, has not answered yet, or is no agent.
  virtual double latency(const AgentAspect& agent) const = 0;
};

/// Marks an agent as having answered in lockstep. Offered by the `syn` effector.
class ISyncEffector {
 public:
  SPARK_INTERFACE(ISyncEffector, 1);
  virtual ~ISyncEffector() = default;
};

}  // namespace spark
