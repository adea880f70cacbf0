#pragma once
/// \file
/// Primitive shapes that are fitted to meshes.

#include "robot/model.h"

namespace spark::mjcf {

/// A box with the inertia of a solid.
struct EquivalentBox {
  Pose pose;       ///< in the frame of the mesh
  Vec3 halfEdges;  ///< m, in rising order
};
/// The box with the inertia of a mesh of that mass distribution.
EquivalentBox equivalentBox(const engine::Mass& mass);
/// The `size` of a geom of a type that is fitted to a mesh with that box (MuJoCo's documentation, "geom/mesh").
Vec3 fittedSize(const std::string& type, const Vec3& halfEdges);

}  // namespace spark::mjcf
