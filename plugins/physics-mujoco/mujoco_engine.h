#pragma once
/// \file
/// MuJoCo as an engine of the physics server.

#include "api/inputs.h"
#include "api/phases.h"
#include "mujoco_actuators.h"
#include "mujoco_mesh.h"
#include "mujoco_nodes.h"
#include "mujoco_solver.h"
#include "spark/describe.h"
#include "spark/kernel.h"
#include "spark/link.h"

namespace spark {

/// Rigid bodies by MuJoCo. It detects its own contacts.
class MujocoEngine : public Leaf, public engine::IEngine {
  SPARK_CLASS(MujocoEngine, Leaf)
 public:
  static constexpr engine::Capabilities kCapabilities{.loops = false,
                                                      .jointForces = false,
                                                      .armature = true,
                                                      .sleeps = false,
                                                      .surfaces = false,
                                                      .stateless = false,
                                                      .parts = false,
                                                      .detects = true,
                                                      .bodyMeshes = false,
                                                      .controls = true,
                                                      .damping = true,
                                                      .springs = true,
                                                      .bodyDamping = true,
                                                      .usualStep = 0.005};
  static void describe(Description<MujocoEngine>& d) {
    d.doc("Rigid bodies and contacts by MuJoCo, in coordinates of joints.");
    engine::describeEngine(d);
    d.link(&MujocoEngine::simulation_, At<ISimulation>());
    d.link(&MujocoEngine::tape_, At<IInputTape>())
        .doc("Records when a new model takes over in real time, or plays it.");
    d.property("version", &MujocoEngine::version).doc("Version of the library.");
    d.property("atOnce", &MujocoEngine::atOnce_)
        .min(0)
        .doc(
            "Number of bodies up to which a changed world is compiled at once. That of more bodies is compiled in a "
            "second thread, while all that is unchanged goes on; what is new stands still meanwhile. In real time that "
            "is until the compiler is ready, otherwise a number of steps that depends on the world alone.");
    d.property("compilations", &MujocoEngine::compilations).doc("Number of models that were compiled.");
  }
  Leaf& leaf() override { return *this; }
  engine::Capabilities capabilities() const override { return kCapabilities; }
  bool reads(std::uint64_t kind) const override {
    using namespace mujoco;
    for (const std::string_view own :
         {SurfaceNumbers::kKind, AxisNumbers::kKind, OptionNumbers::kKind, EqualityNumbers::kKind, TendonNumbers::kKind,
          ActuatorNumbers::kKind, PairNumbers::kKind, FreedomNumbers::kKind, MeshNumbers::kKind})
      if (kind == engine::kindOf(own)) return true;
    return false;
  }
  std::unique_ptr<engine::ISolver> create(const engine::Model&) override {
    return std::make_unique<mujoco::MujocoSolver>(*this);
  }

 private:
  friend class mujoco::MujocoSolver;
  std::string version() const { return mj_versionString(); }
  std::int64_t compilations() const { return compilations_; }
  /// True when cycles keep to wall time and need not be alike from run to run.
  bool isPaced() const { return simulation_ && simulation_->paced() && !simulation_->lockstep(); }
  /// Logs MuJoCo's last message: the 1st, 2nd, 4th, 8th ... time.
  void report(const std::string& message);

  Link<ISimulation> simulation_;
  Link<IInputTape> tape_;
  int atOnce_ = 60;
  std::int64_t compilations_ = 0, compiledAside_ = 0, messages_ = 0;
};

}  // namespace spark
