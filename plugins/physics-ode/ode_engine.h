#pragma once
/// \file
/// ODE as an engine.

#include "api/engine.h"
#include "ode_process.h"
#include "ode_solver.h"
#include "spark/describe.h"
#include "spark/kernel.h"

namespace spark {

/// ODE as the engine of the physics server.
class OdeEngine : public Node, public engine::IEngine {
  SPARK_CLASS(OdeEngine, Node)
 public:
  static constexpr engine::Capabilities kCapabilities{.armature = true, .laws = true};
  static void describe(Description<OdeEngine>& d) {
    d.doc("Rigid bodies by the Open Dynamics Engine (direct solver).");
    engine::describeEngine(d);
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
  engine::Capabilities capabilities() const override { return kCapabilities; }
  std::unique_ptr<engine::ISolver> create(const engine::Model& model) override {
    return std::make_unique<ode::OdeSolver>(*this, model.exactReplay);
  }

 private:
  friend class ode::OdeSolver;
  std::string version() const { return dGetConfiguration(); }
  std::int64_t messages() const { return messages_.count; }
  std::int64_t approximateSteps() const { return approximateSteps_; }

  ode::LibraryGuard library_;  // worlds end after it, and have their own
  ode::Messages messages_;
  std::int64_t approximateSteps_ = 0;
  int directRows_ = 1200;
};

}  // namespace spark
