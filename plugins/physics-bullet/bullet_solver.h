#pragma once
/// \file
/// Steps a world by Bullet.

#include "api/laws_by_joint.h"
#include "api/scene_joint.h"
#include "bullet_detector.h"
#include "islands.h"
#include "joint_forces.h"
#include "row_solver.h"
#include "tree_body.h"

namespace spark::bullet {

/// One world. It keeps nothing from step to step but what follows from the model.
class BulletSolver : public engine::ISolver, private RowSource {
 public:
  /// The numbers are those of the engine: see RowSolver::Options.
  BulletSolver(const int& direct, const int& iterations, const double& tolerance)
      : direct_(direct), iterations_(iterations), tolerance_(tolerance) {}
  void compile(const engine::Model& model, const engine::State& state) override;
  void step(engine::Step& step) override;
  engine::IDetector* detector() override { return &detector_; }

 private:
  /// The rows of a contact.
  struct ContactRows {
    Index contact = 0;
    int normal = 0;
    std::array<int, 2> friction{-1, -1};  ///< -1: none
    bool bounded = false;                 ///< friction is bounded by a force: its rows are among those of joints
    std::array<Vec3, 2> tangents;
  };
  /// The rows of a joint in no tree, that is measured or acts on a measured tree.
  struct LoopRows {
    Index joint = 0;
    int first = 0, last = 0;
  };
  void stepIsland(engine::Step& step, std::size_t island);
  int partsOf(const engine::Step& step, std::size_t island) const;
  /// Steps the island by a part of the step; `first`: the first one.
  void stepPart(engine::Step& part, bool first);
  void write(RowSolver& rows) override;
  void writeContact(RowSolver& rows, Index index);
  // The means over the parts of a step.
  void readContactForces(engine::Step& step, bool first);
  void readLoopForces(engine::Step& step, bool first);
  Side sideOf(Index body);

  const int& direct_;
  const int& iterations_;
  const double& tolerance_;
  BulletDetector detector_;
  RowSolver rows_;
  Scratch scratch_;
  std::vector<std::unique_ptr<TreeBody>> trees_;
  std::vector<Index> treeOf_, linkOf_;           ///< by body
  std::vector<engine::JointSoftness> softness_;  ///< by joint
  std::vector<Index> leftOver_;                  ///< joints in no tree
  std::vector<std::uint8_t> measured_;           ///< by tree: a joint's force is wanted
  bool anyMeasured_ = false;                     ///< of the joints in trees and of the others
  engine::LawsByJoint laws_;
  JointForces forces_;
  Islands islands_;
  // While a step runs.
  const engine::Step* step_ = nullptr;
  std::size_t island_ = 0;
  double fullStep_ = 0;  ///< s; that of `step_` is a part of it
  std::vector<ContactRows> contactRows_;
  std::vector<LoopRows> loopRows_;
};

}  // namespace spark::bullet
