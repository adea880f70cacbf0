#pragma once
/// \file
/// Compares an engine with ODE: both step the same world from the same state.

#include <string>
#include <vector>

#include "api/engine.h"
#include "spark/describe.h"
#include "spark/kernel.h"
#include "spark/link.h"

namespace spark::oracle {

/// The largest differences between the two engines' steps from the same state, over many steps. Errors of velocities
/// and forces are relative to the largest value in the world, but at least to ODE's sleep thresholds (0.01 m/s, 0.01
/// rad/s) and to 1 N or 1 Nm. Errors of positions are in m.
struct Agreement {
  std::size_t steps = 0, compared = 0;                  ///< compared: number of compared bodies, summed over all steps
  std::size_t deferred = 0;                             ///< bodies that were deferred
  std::size_t feedbacks = 0;                            ///< forces of joints and contacts that were compared
  std::size_t disagreedOnSleep = 0;                     ///< bodies that were awake after only one of the two steps
  std::size_t disagreedOnMoved = 0;                     ///< bodies that only one of the two steps marked as moved
  double speed = 0, spin = 0, position = 0, force = 0;  ///< linear and angular velocity, position, forces and torques
  std::size_t worstStep = 0;                            ///< step with the last new maximum
};

/// The engine to which a tested one defers. It records which bodies were deferred, and leaves them unchanged.
class DeferralRecorder : public Leaf, public engine::IEngine {
  SPARK_CLASS(DeferralRecorder, Leaf)
 public:
  static void describe(Description<DeferralRecorder>& d);
  Leaf& leaf() override { return *this; }
  engine::Capabilities capabilities() const override { return {}; }
  std::unique_ptr<engine::ISolver> create(const engine::Model&) override;
  /// Forgets the last step.
  void clear() { deferred_.clear(); }
  /// True if the body was deferred since clear().
  bool deferred(engine::Index body) const { return body < deferred_.size() && deferred_[body]; }

 private:
  struct Solver;
  std::vector<bool> deferred_;  ///< by body; empty: none
};

/// An engine that lets its child `tested` step the world, keeps the result, restores the world and lets its child
/// `judge` step it. The world continues as with the judge alone, so errors do not accumulate over steps.
class ShadowEngine : public Node, public engine::IEngine {
  SPARK_CLASS(ShadowEngine, Node)
 public:
  static void describe(Description<ShadowEngine>& d);
  Leaf& leaf() override { return *this; }
  engine::Capabilities capabilities() const override { return tested_->capabilities(); }
  std::unique_ptr<engine::ISolver> create(const engine::Model&) override;
  const Agreement& agreement() const { return agreement_; }

 private:
  struct Solver;
  /// The results of a step.
  struct Result {
    engine::State state;
    std::vector<Vec3> contactForces;
    static Result of(const engine::Step& step);
    void restore(engine::Step& step) const;
  };
  void compare(const Result& tested, const engine::Step& judged);
  void compareForces(const Result& tested, const engine::Step& judged);
  /// Updates the largest error. NaN counts as the largest of all.
  void record(double error, double& worst);

  Link<engine::IEngine> tested_, judge_;
  Link<DeferralRecorder> recorder_;
  Agreement agreement_;
};

/// Replaces the engine at `path` by a ShadowEngine with an ArticulatedEngine as `tested` and an OdeEngine as `judge`.
ShadowEngine& watch(Kernel& kernel, const std::string& path = "/sys/server/physics/engine");

}  // namespace spark::oracle
