#pragma once
/// \file
/// The solver as a node below an engine.

#include "api/solver.h"
#include "spark/describe.h"
#include "spark/kernel.h"
#include "stepper.h"

namespace spark {

/// Steps trees of bodies by elimination, in place of the engine's own solver.
class ArticulatedSolver : public Leaf, public engine::ISolver {
  SPARK_CLASS(ArticulatedSolver, Leaf)
 public:
  static void describe(Description<ArticulatedSolver>& d) {
    d.doc(
        "Solves joints and contacts along the trees that joints make of bodies; stands below an engine as its child "
        "`solver`.");
    d.implements<engine::ISolver>();
    d.property("mostRows", &ArticulatedSolver::mostRows, &ArticulatedSolver::setMostRows)
        .min(0)
        .doc("Islands with more rows of contacts between bodies and of loops of joints are left to the engine.");
    d.property("islands", &ArticulatedSolver::islands).doc("Islands solved since the node was made.");
    d.property("passes", &ArticulatedSolver::passes)
        .doc("Passes that these took to find which bounds hold; one each is the least.");
    d.property("exactSolutions", &ArticulatedSolver::exactSolutions)
        .doc("How often passes ran out, and the bounds were found in the exact, slow way.");
    d.property("deferredIslands", &ArticulatedSolver::deferredIslands).doc("Islands that were left to the engine.");
  }
  std::size_t step(engine::SolverStep& step) override;
  void forget(engine::World world) override { stepper_.forget(world); }

 private:
  int mostRows() const { return stepper_.mostRows; }
  void setMostRows(int rows) { stepper_.mostRows = rows; }
  std::int64_t islands() const { return stepper_.islands(); }
  std::int64_t passes() const { return stepper_.passes(); }
  std::int64_t exactSolutions() const { return stepper_.exactSolutions(); }
  std::int64_t deferredIslands() const { return stepper_.deferredIslands(); }
  articulated::Stepper stepper_;
};

}  // namespace spark
