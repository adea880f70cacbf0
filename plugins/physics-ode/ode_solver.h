#pragma once
/// \file
/// Dynamics of a world by ODE 0.16 in double precision. ODE's types do not leave this folder.
///
/// What it does differently from plain ODE, and why:
///  - State: poses, velocities and forces are copied from the state before a step and back after it, bit for bit. ODE
///    keeps nothing else of a body from step to step, so a restored world continues with the same bits.
///  - Auto-disable is switched off: the physics server does it, with counters that are part of the state.
///  - Large islands: the time of the direct solver grows with the cube of an island's constraints; thirty robots that
///    are created in one place would take minutes. Islands of more than `directRows` rows are solved by ODE's iterative
///    solver (ode_islands.cpp).
///
///     state -> ODE -> contact joints -> dWorldStep (large islands: dWorldQuickStep) -> state, feedback

#include "ode_world.h"

namespace spark {

class OdeEngine;

namespace ode {

/// Steps one world.
class OdeSolver : public engine::ISolver {
 public:
  /// `engine` owns it.
  OdeSolver(OdeEngine& engine, bool exactReplay);
  void compile(const engine::Model& model, const engine::State& state) override;
  void step(engine::Step& step) override;
  /// ODE's world, for measurements.
  const WorldData& world() const { return world_; }

 private:
  /// Runs ODE's solvers: the direct one, and the iterative one for islands that are too large for it.
  void solveIslands(const engine::Step& step);
  /// The same, and lists the bodies that were moved.
  void solve(const engine::Step& step);
  /// Runs dWorldStep, with the islands distributed over the kernel's threads.
  void solveDirectly(double dt);
  /// Runs dWorldQuickStep, in one thread and always with the same seed.
  void solveApproximately(double dt);
  void listMoved(const engine::Step& step);
  /// After a failure of ODE: solves the islands that it left approximately. Where that fails, too, and with
  /// exactReplay, their bodies have no state.
  void recover(const engine::Step& step, const std::string& failure);
  /// Disables what moved in this step, and lists it in w.excluded; false where that would tear an island.
  bool excludeMoved(const engine::Step& step);
  void solveAgain(const engine::Step& step);

  OdeEngine& engine_;
  WorldData world_;
};

}  // namespace ode
}  // namespace spark
