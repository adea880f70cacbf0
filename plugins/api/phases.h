#pragma once
/// \file
/// The phases of a cycle, as event channels, and the interfaces of the run loop. Within a phase listeners run in tree
/// order, parents or children first as stated below.

#include "spark/abi/api/phases.h"
#include "spark/event.h"
#include "spark/node.h"

namespace spark::phase {
// Defined by `simulation`; a cycle runs them in this order. The event carries the simulated time [s], the step [s] and
// the number of the cycle.

/// Parents first. Agents' messages are executed.
inline constexpr ChannelName kAct{"act"};
/// Children first. Deferred actions, controllers, sampling before the step.
inline constexpr ChannelName kPrepare{"prepare"};
/// Parents first. Contacts, collision handlers, joints, one solver step.
inline constexpr ChannelName kPhysics{"physics"};
/// Parents first. Bodies write transforms; world matrices are updated.
inline constexpr ChannelName kPlace{"place"};
/// Parents first. Control aspects.
inline constexpr ChannelName kRule{"rule"};
/// Parents first. Perceptors.
inline constexpr ChannelName kSense{"sense"};
/// Parents first. Monitors, recorders.
inline constexpr ChannelName kPublish{"publish"};
}  // namespace spark::phase

namespace spark {

/// The run loop, at /sys/server/simulation.
class ISimulation {
 public:
  SPARK_INTERFACE(ISimulation, 2);
  static constexpr const char* kPath = "/sys/server/simulation";
  virtual ~ISimulation() = default;
  /// Runs cycles until the property `duration` is reached, stop() or Kernel::requestStop(). Throws Error when called
  /// within a cycle.
  virtual void run() = 0;
  /// Runs `count` cycles, fewer after stop() or Kernel::requestStop(); waits for the clock and for agents as run()
  /// does. Throws Error when called within a cycle.
  virtual void runCycles(std::int64_t count) = 0;
  /// Makes the current run() or runCycles() return after the current cycle; a later one runs again. For rules, in the
  /// simulation's thread; other threads and signal handlers use Kernel::requestStop(), which is permanent.
  virtual void stop() = 0;
  /// Simulated time since the start [s]: the sum of the executed steps.
  virtual double time() const = 0;
  /// Number of the current cycle, from 1; 0 before the first.
  virtual std::int64_t cycle() const = 0;
  /// Simulated time of one cycle [s].
  virtual double step() const = 0;
  /// True when each cycle waits for the answers of all agents.
  virtual bool lockstep() const = 0;
  /// True when cycles are paced to wall time.
  virtual bool paced() const = 0;
  /// True: paces cycles to wall time; false: runs them as fast as possible.
  virtual void setPaced(bool on) = 0;
};

/// Holds the start of a cycle, for instance until all agents have answered. Any node in the tree may offer it.
class IInputGate {
 public:
  SPARK_INTERFACE(IInputGate, 1);
  virtual ~IInputGate() = default;
  /// False: the next cycle must not start yet. Called after every batch of input. `lockstep` true: the cycle waits for
  /// every agent; false: only conditions on the first cycle count, such as agents that are expected.
  virtual bool ready(bool lockstep) = 0;
};

/// A source of input, such as the network. The run loop finds it among the children of /sys/server.
class IInputSource {
 public:
  SPARK_INTERFACE(IInputSource, 1);
  virtual ~IInputSource() = default;
  /// Processes all input that has arrived, ports in tree order. Does not wait.
  virtual void poll() = 0;
  /// Waits at most `seconds` for input, or until a stop is requested, and processes it. Returns false when the time ran
  /// out.
  virtual bool wait(double seconds) = 0;
  /// False: wait() cannot wait for this source; the run loop waits on another one and polls this one regularly.
  virtual bool canWait() const { return true; }
};

}  // namespace spark
