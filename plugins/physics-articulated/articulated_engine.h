#pragma once
/// \file
/// The engine as a node.

#include "api/engine.h"
#include "spark/describe.h"
#include "spark/kernel.h"
#include "stepper.h"

namespace spark {

class ArticulatedEngine;

namespace articulated {

/// Steps one world, and has the deferred engine step the islands that are not solved here.
class ArticulatedSolver : public engine::ISolver {
 public:
  /// `engine` owns it.
  explicit ArticulatedSolver(ArticulatedEngine& engine) : engine_(engine) {}
  void compile(const engine::Model& model, const engine::State&) override {
    stepper_.compile(model);
    deferredKnows_ = false;
  }
  void step(engine::Step& step) override;

 private:
  /// Stops the bodies of islands without a solution, when there is no engine below.
  void hold(engine::Step& step, std::span<const std::uint8_t> bodies);
  ArticulatedEngine& engine_;
  Stepper stepper_;
  engine::Attached<engine::IEngine> deferred_;
  bool deferredKnows_ = false;  ///< it has compiled the model as it is now: it is told only when it is needed
};

}  // namespace articulated

/// Solves joints and contacts in time linear in the bodies of each tree of joints. Uses the threads of the kernel's
/// jobs.
class ArticulatedEngine : public Node, public engine::IEngine {
  SPARK_CLASS(ArticulatedEngine, Node)
 public:
  static constexpr engine::Capabilities kCapabilities{.armature = true, .laws = true, .damping = true};
  static void describe(Description<ArticulatedEngine>& d) {
    d.doc(
        "Rigid bodies, solved along the trees that joints make of them. Islands that it does not want are stepped by "
        "an engine below it.");
    engine::describeEngine(d);
    d.link(&ArticulatedEngine::deferred_, Child<engine::IEngine>());
    d.property("mostRows", &ArticulatedEngine::mostRows_)
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
  engine::Capabilities capabilities() const override { return kCapabilities; }
  std::unique_ptr<engine::ISolver> create(const engine::Model&) override {
    return std::make_unique<articulated::ArticulatedSolver>(*this);
  }

 private:
  friend class articulated::ArticulatedSolver;
  /// The engine below, if it can step single islands.
  engine::IEngine* deferred();
  std::int64_t islands() const { return counts_.islands; }
  std::int64_t passes() const { return counts_.passes; }
  std::int64_t exactSolutions() const { return counts_.exactSolutions; }
  std::int64_t deferredIslands() const { return counts_.deferredIslands; }
  Link<engine::IEngine> deferred_;
  int mostRows_ = 600;
  articulated::Stepper::Counts counts_;  ///< of all worlds
  bool unfit_ = false;                   ///< deferred() has said that it is not
  bool held_ = false;                    ///< ArticulatedSolver::hold() was called
};

}  // namespace spark
