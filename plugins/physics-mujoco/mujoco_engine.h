#pragma once
/// \file
/// MuJoCo as engine and collision detection of the physics server.

#include <future>
#include <memory>
#include <optional>

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
    d.property("atOnce", &MujocoEngine::atOnce_)
        .min(0)
        .doc(
            "Number of bodies up to which a changed world is compiled at once. That of more bodies is compiled in a "
            "second thread, while all that is unchanged goes on; what is new stands still for some tenths of a "
            "second.");
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
  bool springs() const override { return true; }
  bool dampsBodies() const override { return true; }
  double usualStep() const override { return 0.005; }
  void forget(const engine::Model& model) override;

 private:
  /// A model that is being compiled in a second thread.
  struct Pending {
    std::optional<mujoco::Trees> trees;  ///< nullopt: there is none
    std::future<mujoco::Compiled> compiled;
    int stepsLeft = 0;  ///< until it takes over
    int waited = 0;     ///< steps since the first change that is not in yet
  };
  /// What is kept of a model.
  struct Known {
    std::uint64_t id = 0, structure = 0, collision = 0, dynamics = 0;
    std::unique_ptr<mujoco::MujocoWorld> world;
    mujoco::Sizes sizes;
    double step = 0.005;  ///< s
    bool full = false;    ///< no more room can be had
    std::string refused;  ///< why the last model that was refused was
    Pending pending;
    engine::PairFilter filter = nullptr;  ///< of the last detect()
  };
  std::string version() const { return mj_versionString(); }
  std::int64_t compilations() const { return compilations_; }
  Known& of(const engine::Model& model);
  void build(Known& known, const engine::Model& model, const engine::State& state);
  void buildAside(Known& known, const engine::Model& model, const engine::State& state);
  void begin(Known& known, const engine::Model& model, const engine::State& state, mujoco::Trees trees,
             mujoco::Compiled compiled);
  /// Drops a model that is being compiled.
  void abandon(Known& known);
  /// After a step: the model that was compiled aside takes over when its time has come.
  void takePending(Known& known, const engine::Model& model, const engine::State& state);
  void refuse(Known& known, const std::string& why);
  /// Logs MuJoCo's last message: the 1st, 2nd, 4th, 8th ... time.
  void report(mujoco::MujocoWorld& world);

  mujoco::LibraryGuard library_;
  std::vector<Known> worlds_;
  std::vector<std::future<mujoco::Compiled>> abandoned_;  ///< still compiling, not wanted any more
  int atOnce_ = 60;
  std::int64_t compilations_ = 0, messages_ = 0;
  bool warned_ = false;
};

}  // namespace spark
