#pragma once
/// \file
/// The solver that is tested, beside ODE: both step the same world from the same state, and what comes out is compared.

#include <functional>
#include <string>
#include <vector>

#include "api/solver.h"
#include "spark/describe.h"
#include "spark/kernel.h"

namespace spark::oracle {

/// How far two steps from one state are apart, at worst, over many steps. Errors are parts of the greatest value in the
/// world; what is slower than ODE's threshold of sleep (0.01 m/s, 0.01 rad/s) counts as that, and a force below 1 N or
/// Nm as that.
struct Agreement {
  std::size_t steps = 0, compared = 0;  ///< compared: bodies, once for each step
  std::size_t deferred = 0;             ///< bodies that were deferred to ODE
  std::size_t feedbacks = 0;            ///< forces of joints and contacts
  std::size_t disagreedOnSleep = 0;
  double speed = 0, spin = 0, place = 0, force = 0;
  std::size_t worstStep = 0;
};

/// A solver that asks the solver below it (its child `tested`), notes the answer, puts the world back as it was and
/// defers it all to ODE. So the world goes on as ODE says, and no step inherits another's error. Compares in the phase
/// after the engine's step where the house has phases; else somebody calls compare().
class ShadowSolver : public Node, public engine::ISolver {
  SPARK_CLASS(ShadowSolver, Node)
 public:
  static void describe(Description<ShadowSolver>& d);
  std::size_t step(engine::SolverStep& step) override;
  void forget(engine::World world) override;
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

/// Puts a shadow below the engine at `path`, and below that the solver that is tested.
ShadowSolver& watch(Kernel& kernel, const std::string& path = "/sys/server/physics/engine");

}  // namespace spark::oracle
