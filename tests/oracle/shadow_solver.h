#pragma once
/// \file
/// Compares a solver with ODE: both step the same world from the same state.

#include <functional>
#include <string>
#include <vector>

#include "api/solver.h"
#include "spark/describe.h"
#include "spark/kernel.h"

namespace spark::oracle {

/// Largest differences between the two steps from the same state, over many steps. Errors of velocities and forces are
/// relative to the largest in the world, but at least to ODE's thresholds of sleep (0.01 m/s, 0.01 rad/s) and to 1 N or
/// 1 Nm; errors of positions are in m.
struct Agreement {
  std::size_t steps = 0, compared = 0;               ///< compared: sum over all steps of the bodies that were compared
  std::size_t deferred = 0;                          ///< bodies that were deferred to ODE
  std::size_t feedbacks = 0;                         ///< forces of joints and contacts that were compared
  std::size_t disagreedOnSleep = 0;                  ///< bodies that were awake after one of the steps only
  double speed = 0, spin = 0, place = 0, force = 0;  ///< linear and angular velocity, position, forces and torques
  std::size_t worstStep = 0;                         ///< in which the last of the maxima was found
};

/// A solver that lets its child `tested` step the world, keeps the result, restores the world and defers all of it to
/// ODE. So the world continues as with ODE alone, and no step inherits another's error. In a simulation with phases it
/// compares in the phase `place`, which follows the engine's step; elsewhere the test calls compare().
class ShadowSolver : public Node, public engine::ISolver {
  SPARK_CLASS(ShadowSolver, Node)
 public:
  static void describe(Description<ShadowSolver>& d);
  std::size_t step(engine::SolverStep& step) override;
  void forget(engine::World world) override;
  /// Compares the last step of `tested` with the present state, once.
  void compare();
  const Agreement& agreement() const { return agreement_; }
  /// The joints of the last step, in order of creation.
  const std::vector<engine::SolverJoint*>& joints() const { return joints_; }

 private:
  struct State {
    double position[3], quaternion[4], rotation[12], linearVelocity[3], angularVelocity[3], force[3], torque[3];
    bool awake;
  };
  struct Answer {
    Vec3 velocity, spin, position;
    bool awake, deferred;
  };
  static State stateOf(const engine::SolverBody& b);
  static void restore(const State& from, engine::SolverBody& to);
  void placed(const Event&) { compare(); }
  void compareForces();

  std::vector<engine::SolverBody*> bodies_;
  std::vector<engine::SolverJoint*> joints_;
  std::vector<State> before_;
  std::vector<Answer> answers_;
  std::vector<std::array<Vec3, 4>> jointForces_;
  std::vector<Vec3> contactForces_;
  std::span<engine::Contact> contacts_;
  std::span<const engine::SolverPair> pairs_;
  bool waiting_ = false;
  Agreement agreement_;
};

/// Creates a ShadowSolver below the engine at `path`, with an ArticulatedSolver as `tested`.
ShadowSolver& watch(Kernel& kernel, const std::string& path = "/sys/server/physics/engine");

}  // namespace spark::oracle
