#pragma once
/// \file
/// Steps a world by MuJoCo, and compiles it anew when it changes.

#include <future>
#include <memory>
#include <optional>

#include "mujoco_world.h"

namespace spark {

class MujocoEngine;

namespace mujoco {

/// One world. Detection and dynamics are one in MuJoCo.
class MujocoSolver : public engine::ISolver, public engine::IDetector {
 public:
  /// `engine` owns it.
  explicit MujocoSolver(MujocoEngine& engine) : engine_(engine) {}
  void compile(const engine::Model& model, const engine::State& state) override;
  void step(engine::Step& step) override;
  engine::IDetector* detector() override { return this; }
  void compile(const engine::Model&, const engine::State&, std::span<const Index>) override {}
  void detect(const engine::Model& model, const engine::State& state, engine::PairFilter filter, int perPair,
              engine::Contacts& out) override;
  void save(const engine::State& state, StateWriter& out) const override;
  using engine::ISolver::load;
  using engine::ISolver::save;
  void load(const engine::Model& model, const engine::State& state, StateReader& in) override;

 private:
  /// A model that is being compiled in a second thread.
  struct Pending {
    std::future<Compiled> compiled;  ///< not valid: there is none
    std::optional<Trees> trees;
    std::vector<Pose> poses;   ///< of which they were made
    std::uint64_t number = 0;  ///< of all models that the engine compiles aside
    int stepsLeft = 0;         ///< until it takes over
    int waited = 0;            ///< steps since the first change that is not in yet
  };
  /// Makes what MuJoCo needs of the meshes, and logs what of them has no effect.
  void takeMeshes(const engine::Model& model);
  void build(const engine::Model& model, const engine::State& state);
  void buildAside(const engine::Model& model, const engine::State& state);
  void begin(const engine::Model& model, Trees trees, Compiled compiled);
  /// Drops a model that is being compiled.
  void abandon();
  /// After a step: the model that was compiled aside takes over when its time has come.
  void takePending(const engine::Model& model);
  void refuse(const std::string& why, const engine::Model* model = nullptr);
  /// Logs the constraints that are left out and were not before.
  void reportSkipped(const Constraints& constraints);
  /// Logs the first of these bodies that the log does not have yet.
  void reportRaised(std::vector<std::uint64_t> bodies);
  /// Logs the first joint whose law MuJoCo alone could not step.
  void reportStiff(const engine::Model& model);

  LibraryGuard library_;
  MujocoEngine& engine_;
  std::unique_ptr<MujocoWorld> world_;
  MeshPieces pieces_;
  std::uint64_t newestGeom_ = 0;       ///< identity: the log has its mesh
  std::vector<std::uint64_t> raised_;  ///< ascending identities: the log has that their masses are raised
  bool saidStiff_ = false;
  Sizes sizes_;
  double step_ = 0.005;       ///< s
  std::vector<int> skipped_;  ///< constraints that the last model leaves out
  bool full_ = false;         ///< no more room can be had
  std::vector<Pose> poses_;   ///< by body: those with which the world was compiled; empty: it has changed since
  std::string refused_;       ///< why the last model that was refused was
  Pending pending_;
  std::future<void> ending_;                      ///< the world before
  std::vector<std::future<Compiled>> abandoned_;  ///< still compiling, not wanted any more
  engine::PairFilter filter_ = nullptr;           ///< of the last detect()
};

}  // namespace mujoco
}  // namespace spark
