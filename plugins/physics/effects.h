#pragma once
/// \file
/// Says what of a world has no effect with its engine.

#include <array>
#include <vector>

#include "collider.h"
#include "joint.h"

namespace spark::physics {

/// Logs once for each kind, with the path of the first node that has it: "/usr/scene/...: bounce has no effect with
/// <its class>".
class Effects {
 public:
  /// The joints, handlers and colliders of the world, in tree order; valid until the tree changes.
  std::vector<Joint*> joints;
  std::vector<CollisionHandler*> handlers;
  std::vector<engine::IExtension*> extensions;
  std::vector<Collider*> colliders;
  void clear() { joints.clear(), handlers.clear(), extensions.clear(), colliders.clear(), seen_ = {}; }
  /// Checks a world that changed since the last call; another engine says its own.
  void check(engine::IEngine& engine, const engine::Model& model);

 private:
  enum Kind {
    kJoints,
    kAngularMotors,
    kLoops,
    kJointForces,
    kArmature,
    kBounce,
    kSlip,
    kForceFriction,
    kFriction,
    kMeshes,
    kHeightFields,
    kKinds
  };
  void checkJoints(const engine::Capabilities& can, const engine::Model& model);
  void checkLoops(const engine::Model& model);
  void checkSurfaces(const engine::IEngine& engine);
  void checkShapes(const engine::Capabilities& can);
  void checkExtensions(const engine::IEngine& engine);
  void say(Kind kind, const Leaf& node, const char* what);
  Ref<Leaf> engine_;                     ///< whose kinds were said
  std::string engineName_;               ///< its class
  std::array<std::uint64_t, 3> seen_{};  ///< Model::structure, dynamics and collision at the last check
  std::array<bool, kKinds> said_{};
  std::vector<std::uint64_t> saidOf_;  ///< kinds of extensions
};

}  // namespace spark::physics
