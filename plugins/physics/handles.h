#pragma once
/// \file
/// Shared ownership of engine worlds and spaces: the tree may drop a world before the bodies in it, and an engine
/// before both.

#include <memory>
#include <string>

#include "api/physics.h"

namespace spark::physics {

/// An engine that may be gone before those who use it.
struct EngineUse {
  Ref<Leaf> leaf;
  engine::IEngine* engine = nullptr;
  /// The engine, nullptr once it died.
  engine::IEngine* get() const { return leaf ? engine : nullptr; }
};

/// An engine's world; lives as long as anything in it, and keeps the engine in the tree.
class WorldHandle {
 public:
  /// `path`: of the world's node.
  WorldHandle(const EngineUse& use, const std::string& path)
      : use_(use),
        why_(path + " and the bodies, colliders and joints in it live in the engine; remove them all first"),
        inUse_(*use_.leaf, why_),
        id_(use_.engine->createWorld()) {}
  ~WorldHandle() {
    if (auto* e = engine()) e->destroyWorld(id_);
  }
  WorldHandle(const WorldHandle&) = delete;
  WorldHandle& operator=(const WorldHandle&) = delete;
  engine::IEngine* engine() const { return use_.get(); }
  engine::World id() const { return id_; }

 private:
  EngineUse use_;
  std::string why_;
  InUse inUse_;
  engine::World id_;
};

/// A collision space; lives as long as anything in it.
class SpaceHandle {
 public:
  /// `parent` empty: a top-level space.
  SpaceHandle(std::shared_ptr<WorldHandle> world, std::shared_ptr<SpaceHandle> parent)
      : world_(std::move(world)),
        parent_(std::move(parent)),
        id_(world_->engine()->createSpace(world_->id(), parent_ ? parent_->id() : engine::Space::none)) {}
  ~SpaceHandle() {
    if (auto* e = world_->engine()) e->destroySpace(id_);
  }
  SpaceHandle(const SpaceHandle&) = delete;
  SpaceHandle& operator=(const SpaceHandle&) = delete;
  engine::Space id() const { return id_; }
  const std::shared_ptr<WorldHandle>& world() const { return world_; }

 private:
  std::shared_ptr<WorldHandle> world_;
  std::shared_ptr<SpaceHandle> parent_;
  engine::Space id_;
};

/// The pose `inner` (in the frame of `outer`), seen from where `outer` is.
inline Pose compose(const Pose& outer, const Pose& inner) {
  return {outer.position + outer.rotation * inner.position, outer.rotation * inner.rotation};
}
/// The pose that `world` is in the frame of `outer`.
inline Pose relative(const Pose& outer, const Pose& world) {
  return {outer.rotation.transpose() * (world.position - outer.position), outer.rotation.transpose() * world.rotation};
}
/// The pose of the nearest transform above a node, computed now.
inline Pose frameOf(const SceneNode& node) { return node.transform() ? toPose(node.transform()->worldNow()) : Pose{}; }
/// A pose from 6 numbers (position, rotation in degrees) or 16 (a column-major matrix); nothing given: identity. Throws
/// Error otherwise.
Pose poseFrom(const std::vector<double>& numbers);

}  // namespace spark::physics
