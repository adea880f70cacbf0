#pragma once
/// \file
/// Dynamics by ODE 0.16 in double precision. ODE's types do not leave this folder.
///
/// What this engine does differently from plain ODE, and why:
///  - State: poses, velocities and forces are copied from the state before a step and back after it, bit for bit. ODE
///    keeps nothing else of a body from step to step, so a restored world continues with the same bits.
///  - Auto-disable is switched off: the physics server does it, with counters that are part of the state.
///  - Large islands: the time of the direct solver grows with the cube of an island's constraints; thirty robots that
///    are created in one place would take minutes. Islands of more than `directRows` rows are solved by ODE's iterative
///    solver (ode_islands.cpp).
///
///     state -> ODE -> contact joints -> dWorldStep (large islands: dWorldQuickStep) -> state, feedback

#include <memory>
#include <vector>

#include "api/engine.h"
#include "ode_process.h"
#include "ode_world.h"
#include "spark/describe.h"
#include "spark/kernel.h"

namespace spark {

/// ODE as the engine of the physics server.
class OdeEngine : public Node, public engine::IEngine {
  SPARK_CLASS(OdeEngine, Node)
 public:
  static void describe(Description<OdeEngine>& d) {
    d.doc("Rigid bodies by the Open Dynamics Engine (direct solver).");
    d.implements<engine::IEngine>();
    d.property("version", &OdeEngine::version).doc("Configuration of the library.");
    d.property("directRows", &OdeEngine::directRows_)
        .min(0)
        .doc(
            "Maximum number of constraint rows (three per contact) of islands for the direct solver; larger islands "
            "are solved iteratively, which is approximate.");
    d.property("approximateSteps", &OdeEngine::approximateSteps)
        .doc("Number of steps with an iteratively solved island.");
    d.property("messages", &OdeEngine::messages).doc("Number of error and warning messages from ODE.");
  }

  Leaf& leaf() override { return *this; }
  void compile(const engine::Model& model, const engine::State& state) override;
  void step(engine::Step& step) override;
  void forget(const engine::Model& model) override;
  /// ODE's world, for measurements; virtual, so that programs reach it. Throws Error for a model that was not compiled.
  virtual ode::WorldData& world(const engine::Model& model);

 private:
  std::string version() const { return dGetConfiguration(); }
  std::int64_t messages() const { return messages_.count; }
  std::int64_t approximateSteps() const { return approximateSteps_; }
  /// Runs ODE's solvers: the direct one, and the iterative one for islands that are too large for it.
  void solveIslands(ode::WorldData& w, const engine::Step& step);
  /// The same, and lists the bodies that were moved.
  void solve(ode::WorldData& w, const engine::Step& step);
  /// Runs dWorldStep, with the islands distributed over the kernel's threads.
  void solveDirectly(ode::WorldData& w, double dt);

  ode::LibraryGuard library_;
  std::vector<std::unique_ptr<ode::WorldData>> worlds_;
  ode::Messages messages_;
  std::int64_t approximateSteps_ = 0;
  int directRows_ = 1200;
  bool armatureSaid_ = false;
};

}  // namespace spark
