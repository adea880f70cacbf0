#pragma once
/// \file
/// The phases of one simulated instant, as channels, and the run loop's services. The order within a phase is tree
/// order as stated.

#include "spark/abi/api/phases.h"
#include "spark/event.h"
#include "spark/node.h"

namespace spark::phase {
// Defined by `simulation`, in this order each cycle. Event: time [s] of the simulated clock, step [s], cycle.
inline constexpr ChannelName kAct{"act"};          ///< parents first. Agents' messages are realised.
inline constexpr ChannelName kPrepare{"prepare"};  ///< children first. Deferred actions, controllers, sampling.
inline constexpr ChannelName kPhysics{"physics"};  ///< parents first. Contacts, handlers, joints, one solver step.
inline constexpr ChannelName kPlace{"place"};      ///< parents first. Bodies write transforms; world matrices.
inline constexpr ChannelName kRule{"rule"};        ///< parents first. Control aspects.
inline constexpr ChannelName kSense{"sense"};      ///< parents first. Perceptors.
inline constexpr ChannelName kPublish{"publish"};  ///< parents first. Monitors, recorders.
}  // namespace spark::phase

namespace spark {

/// The run loop, at /sys/server/simulation.
class ISimulation {
 public:
  SPARK_INTERFACE(ISimulation, 2);
  static constexpr const char* kPath = "/sys/server/simulation";
  virtual ~ISimulation() = default;
  /// Runs cycles until the simulation's `duration` is reached, stop() or Kernel::requestStop(). Not to be called from
  /// within a cycle: throws Error.
  virtual void run() = 0;
  /// Runs `count` cycles, fewer after stop() or Kernel::requestStop(); waits for the clock and for agents as run()
  /// does. Not to be called from within a cycle: throws Error.
  virtual void runCycles(std::int64_t count) = 0;
  /// The current run() or runCycles() returns after the cycle it is in. For rules; other threads and signal handlers
  /// use Kernel::requestStop(), which is for good.
  virtual void stop() = 0;
  /// Simulated time [s] since start: sum of executed steps.
  virtual double time() const = 0;
  /// Number of the current cycle, from 1; 0 before the first.
  virtual std::int64_t cycle() const = 0;
  /// Simulated seconds per cycle.
  virtual double step() const = 0;
  /// True when the clock waits for all agents of a cycle.
  virtual bool lockstep() const = 0;
  /// True when cycles are paced to wall time: a long one is seen by everybody.
  virtual bool paced() const = 0;
  /// True: cycles are paced to wall time; false: as fast as it goes.
  virtual void setPaced(bool on) = 0;
};

/// Something the clock waits for: agents that have not answered. Any node in the tree may offer it.
class IInputGate {
 public:
  SPARK_INTERFACE(IInputGate, 1);
  virtual ~IInputGate() = default;
  /// False: the next cycle must not start yet. Asked after every batch of input. `lockstep`: the clock waits for every
  /// agent; otherwise only what holds the very first cycle (agents that are expected) counts.
  virtual bool ready(bool lockstep) = 0;
};

/// Something that brings input: the network. Found by the run loop as children of /sys/server.
class IInputSource {
 public:
  SPARK_INTERFACE(IInputSource, 1);
  virtual ~IInputSource() = default;
  /// Takes all input that is there without waiting: ports in tree order.
  virtual void poll() = 0;
  /// Waits for input until a deadline (s from now) or a stop request, takes what came. Returns false when the time ran
  /// out.
  virtual bool wait(double seconds) = 0;
  /// False: it has no wait worth calling; the run loop waits on another source and polls this one now and then.
  virtual bool canWait() const { return true; }
};

}  // namespace spark
