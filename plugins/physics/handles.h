#pragma once
/// \file
/// Shared ownership of engine worlds and spaces. The tree may remove a world node before the bodies in it, and the
/// engine before both.

#include <memory>
#include <string>

#include "api/physics.h"

namespace spark::physics {

/// A reference to an engine that may be removed earlier than its users.
struct EngineUse {
  Ref<Leaf> leaf;  ///< the engine's node
  engine::IEngine* engine = nullptr;
  /// The engine; nullptr after it was removed.
  engine::IEngine* get() const { return leaf ? engine : nullptr; }
};

/// A world of the engine. Shared by all that is in it, and destroyed with the last of them. While it lives, the engine
/// cannot be removed from the tree.
class WorldHandle {
 public:
  /// Creates the world. `path` is that of the world's node, for messages.
  WorldHandle(const EngineUse& use, const std::string& path)
      : use_(use),
        why_(fmt::format("{} and the bodies, colliders and joints in it live in the engine; remove them all first",
                         path)),
        inUse_(*use_.leaf, why_),
        id_(use_.engine->createWorld()) {}
  ~WorldHandle() {
    if (auto* e = engine()) e->destroyWorld(id_);
  }
  WorldHandle(const WorldHandle&) = delete;
  WorldHandle& operator=(const WorldHandle&) = delete;
  /// The engine; nullptr after it was removed.
  engine::IEngine* engine() const { return use_.get(); }
  engine::World id() const { return id_; }

 private:
  EngineUse use_;
  std::string why_;
  InUse inUse_;
  engine::World id_;
};

/// A collision space of the engine. Shared by all that is in it, and destroyed with the last of them.
class SpaceHandle {
 public:
  /// Creates the space. `parent` nullptr: a top-level space.
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

/// The composition outer * inner: `inner` is given in the frame of `outer`, the result in that of which `outer` is
/// given.
inline Pose compose(const Pose& outer, const Pose& inner) {
  return {outer.position + outer.rotation * inner.position, outer.rotation * inner.rotation};
}
/// The pose `world` in the frame of `outer`: outer^-1 * world.
inline Pose relative(const Pose& outer, const Pose& world) {
  return {outer.rotation.transpose() * (world.position - outer.position), outer.rotation.transpose() * world.rotation};
}
/// The current world pose of the nearest transform above a node; identity without one.
inline Pose frameOf(const SceneNode& node) { return node.transform() ? toPose(node.transform()->worldNow()) : Pose{}; }
/// A pose from 6 numbers (position [m], rotation [deg]) or 16 (a column-major matrix); identity from none. Throws Error
/// for another number of numbers, or when one is not finite.
Pose poseFrom(const std::vector<double>& numbers);

}  // namespace spark::physics
