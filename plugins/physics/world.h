#pragma once
/// \file
/// The world of a scene and its collision spaces.

#include "api/extension.h"
#include "handles.h"
#include "stepper.h"

namespace spark {

/// Base of all physics nodes of a scene.
class PhysicsObject : public SceneNode {
  SPARK_CLASS(PhysicsObject, SceneNode)
 public:
  static void describe(Description<PhysicsObject>& d) {
    d.doc("Base of all physics nodes of a scene.");
    d.abstract();
  }

 protected:
  /// Path and class, for messages: "/usr/scene/box/body (RigidBody)".
  std::string where() const { return fmt::format("{} ({})", path(), classObject()->name()); }
};

/// The physical world of a scene, its child `world`: gravity and the solver's parameters.
class World : public PhysicsObject, public engine::IExtended, public engine::IExtendedWorld {
  SPARK_CLASS(World, PhysicsObject)
 public:
  static void describe(Description<World>& d);

  /// Model and state; made when the node is linked.
  const std::shared_ptr<physics::WorldModel>& model() const { return model_; }
  /// What steps it.
  const std::shared_ptr<physics::Stepper>& stepper() const { return stepper_; }
  /// The space of colliders without a Space above them: the scene's first Space, else one that the world owns.
  const std::shared_ptr<physics::SharedSpace>& space();
  /// The world of a node: a child of its nearest ancestor that has one. Throws Error when there is none.
  static World& of(const Leaf& node);

  /// Marks that the origin of a body moved to its centre of mass: the next physics phase shifts the transforms and
  /// colliders around it.
  void markRecentred() { recentred_ = true; }
  /// Returns and clears that mark.
  bool takeRecentred() { return std::exchange(recentred_, false); }
  void setBlock(const engine::Block& block) override;
  void removeBlock(std::uint64_t kind) override;
  engine::IExtended& blocks() override { return *this; }
  void setInput(std::uint64_t kind, double value) override;

 protected:
  void onLink() override;
  void saveState(StateWriter& out) const override;
  void loadState(StateReader& in) override;

 private:
  Vec3 gravity() const { return parameters_.gravity; }
  void setGravity(const Vec3& g);
  double erp() const { return parameters_.erp; }
  void setErp(double v) { parameters_.erp = v, apply(); }
  double cfm() const { return parameters_.cfm; }
  void setCfm(double v) { parameters_.cfm = v, apply(); }
  bool autoDisable() const { return parameters_.autoDisable; }
  void setAutoDisable(bool on) { parameters_.autoDisable = on, apply(); }
  bool joinedCollide() const { return parameters_.joinedCollide; }
  void setJoinedCollide(bool on) { parameters_.joinedCollide = on, apply(); }
  double surfaceLayer() const { return parameters_.contactSurfaceLayer; }
  void setSurfaceLayer(double v) { parameters_.contactSurfaceLayer = v, apply(); }
  double timestep() const { return parameters_.timestep; }
  void setTimestep(double v) { parameters_.timestep = v, apply(); }
  std::int64_t meshes() const { return model_ ? static_cast<std::int64_t>(model_->meshes().count()) : 0; }
  std::int64_t meshLoads() const { return model_ ? model_->meshes().loads() : 0; }
  void apply();

  engine::WorldParameters parameters_;
  engine::Blocks blocks_;
  std::shared_ptr<physics::WorldModel> model_;
  std::shared_ptr<physics::Stepper> stepper_;
  std::shared_ptr<physics::SharedSpace> ownSpace_;
  bool recentred_ = false;
};

/// A collision space: it holds the colliders below it.
class Space : public PhysicsObject {
  SPARK_CLASS(Space, PhysicsObject)
 public:
  static void describe(Description<Space>& d);
  /// The space in the model; created when the node is linked.
  const std::shared_ptr<physics::SharedSpace>& shared() const { return shared_; }

 protected:
  void onLink() override;

 private:
  void disableInnerCollision(bool off);
  bool innerOff() const { return innerOff_; }
  std::shared_ptr<physics::SharedSpace> shared_;
  bool innerOff_ = false;
};

}  // namespace spark
