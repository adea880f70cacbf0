#pragma once
/// \file
/// The engine as a node.

#include "api/engine.h"
#include "spark/describe.h"
#include "spark/kernel.h"
#include "stepper.h"

namespace spark {

/// Solves joints and contacts in time linear in the bodies of each tree of joints. Uses the threads of the kernel's
/// jobs.
class ArticulatedEngine : public Node, public engine::IEngine {
  SPARK_CLASS(ArticulatedEngine, Node)
 public:
  static void describe(Description<ArticulatedEngine>& d) {
    d.doc(
        "Rigid bodies, solved along the trees that joints make of them. Islands that it does not want are stepped by "
        "an engine below it.");
    d.implements<engine::IEngine>();
    d.link(&ArticulatedEngine::deferred_, Child<engine::IEngine>());
    d.property("mostRows", &ArticulatedEngine::maxCouplingRows, &ArticulatedEngine::setMaxCouplingRows)
        .min(0)
        .doc(
            "Islands with more rows of contacts between bodies and of joints that close loops are deferred to the "
            "engine below; without one they are solved here, in time that grows with the cube of the rows.");
    d.property("islands", &ArticulatedEngine::islands).doc("Number of islands since the node was created.");
    d.property("passes", &ArticulatedEngine::passes)
        .doc("Number of passes to find which bounds are active, at least one for each island.");
    d.property("exactSolutions", &ArticulatedEngine::exactSolutions)
        .doc("Number of searches that ran out of passes and used the exact, slow algorithm.");
    d.property("deferredIslands", &ArticulatedEngine::deferredIslands)
        .doc("Number of islands that were deferred to the engine below.");
  }
  Leaf& leaf() override { return *this; }
  void compile(const engine::Model& model, const engine::State& state) override;
  void step(engine::Step& step) override;
  bool damps() const override { return true; }
  void forget(const engine::Model& model) override;

 private:
  int maxCouplingRows() const { return stepper_.maxCouplingRows; }
  void setMaxCouplingRows(int rows) { stepper_.maxCouplingRows = rows; }
  /// Stops the bodies of islands without a solution, when there is no engine below.
  void hold(engine::Step& step, std::span<const std::uint8_t> bodies);
  std::int64_t islands() const { return stepper_.islands(); }
  std::int64_t passes() const { return stepper_.passes(); }
  std::int64_t exactSolutions() const { return stepper_.exactSolutions(); }
  std::int64_t deferredIslands() const { return stepper_.deferredIslands(); }
  articulated::Stepper stepper_;
  Link<engine::IEngine> deferred_;
  /// The models that `deferred_` has compiled as they are now: it is told only when it is needed.
  std::vector<std::uint64_t> known_;
  Ref<Leaf> knownBy_;
  bool unfit_ = false;
  bool held_ = false;  ///< hold() was called
};

}  // namespace spark
