#pragma once
/// \file
/// Convex hulls of meshes.

#include "api/model.h"

namespace spark::mjcf {

/// The convex hull of the vertices of a mesh: those of its vertices that lie on the hull, in their order, and triangles
/// that point outwards. Throws Error if the vertices lie in a plane.
engine::ShapeDescription hullOf(const engine::ShapeDescription& mesh);

}  // namespace spark::mjcf
