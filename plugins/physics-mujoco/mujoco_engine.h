#pragma once
/// \file
/// MuJoCo as engine and collision detection of the physics server.

#include <memory>

#include "mujoco_world.h"
#include "spark/describe.h"
#include "spark/kernel.h"

namespace spark {

/// Rigid bodies by MuJoCo. It detects its own contacts.
class MujocoEngine : public Leaf, public engine::IEngine, public engine::ICollision {
  SPARK_CLASS(MujocoEngine, Leaf)
 public:
  static void describe(Description<MujocoEngine>& d) {
    d.doc("Rigid bodies and contacts by MuJoCo, in coordinates of joints.");
    d.implements<engine::IEngine>();
    d.implements<engine::ICollision>();
    d.property("version", &MujocoEngine::version).doc("Version of the library.");
    d.property("compilations", &MujocoEngine::compilations).doc("Number of models that were compiled.");
  }
  Leaf& leaf() override { return *this; }
  void compile(const engine::Model& model, const engine::State& state) override;
  void detect(const engine::Model& model, const engine::State& state, engine::PairFilter filter, int perPair,
              engine::Contacts& out) override;
  void step(engine::Step& step) override;
  bool sleeps() const override { return false; }
  bool stepsParts() const override { return false; }
  bool controls() const override { return true; }
  double usualStep() const override { return 0.005; }
  void forget(const engine::Model& model) override;

 private:
  /// What is kept of a model.
  struct Known {
    std::uint64_t id = 0, structure = 0, collision = 0, dynamics = 0;
    std::unique_ptr<mujoco::MujocoWorld> world;
    mujoco::Sizes sizes;
    double step = 0.005;  ///< s
    bool full = false;    ///< no more room can be had
    std::string refused;  ///< why the last model that was refused was
  };
  std::string version() const { return mj_versionString(); }
  std::int64_t compilations() const { return compilations_; }
  Known& of(const engine::Model& model);
  void build(Known& known, const engine::Model& model, const engine::State& state);
  void refuse(Known& known, const std::string& why);
  /// Logs MuJoCo's last message: the 1st, 2nd, 4th, 8th ... time.
  void report(mujoco::MujocoWorld& world);

  mujoco::LibraryGuard library_;
  std::vector<Known> worlds_;
  std::int64_t compilations_ = 0, messages_ = 0;
  bool warned_ = false;
};

}  // namespace spark
