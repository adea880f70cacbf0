#pragma once
/// \file
/// The solver as a node below an engine.

#include "api/solver.h"
#include "spark/describe.h"
#include "spark/kernel.h"
#include "stepper.h"

namespace spark {

/// Solves joints and contacts in place of the engine's own solver, in time linear in the bodies of each tree of joints.
/// Uses the threads of the kernel's jobs.
class ArticulatedSolver : public Leaf, public engine::ISolver {
  SPARK_CLASS(ArticulatedSolver, Leaf)
 public:
  static void describe(Description<ArticulatedSolver>& d) {
    d.doc(
        "Solves joints and contacts along the trees that joints make of bodies, in place of the engine's own solver. "
        "Created below an engine as its child `solver`.");
    d.implements<engine::ISolver>();
    d.property("mostRows", &ArticulatedSolver::maxCouplingRows, &ArticulatedSolver::setMaxCouplingRows)
        .min(0)
        .doc(
            "Islands with more rows of contacts between bodies and of joints that close loops are deferred to the "
            "engine.");
    d.property("islands", &ArticulatedSolver::islands).doc("Number of islands since the node was created.");
    d.property("passes", &ArticulatedSolver::passes)
        .doc("Number of passes to find which bounds are active, at least one for each island.");
    d.property("exactSolutions", &ArticulatedSolver::exactSolutions)
        .doc("Number of searches that ran out of passes and used the exact, slow algorithm.");
    d.property("deferredIslands", &ArticulatedSolver::deferredIslands)
        .doc("Number of islands that were deferred to the engine.");
  }
  std::size_t step(engine::SolverStep& step) override;
  void forget(engine::World world) override { stepper_.forget(world); }

 private:
  int maxCouplingRows() const { return stepper_.maxCouplingRows; }
  void setMaxCouplingRows(int rows) { stepper_.maxCouplingRows = rows; }
  std::int64_t islands() const { return stepper_.islands(); }
  std::int64_t passes() const { return stepper_.passes(); }
  std::int64_t exactSolutions() const { return stepper_.exactSolutions(); }
  std::int64_t deferredIslands() const { return stepper_.deferredIslands(); }
  articulated::Stepper stepper_;
};

}  // namespace spark
