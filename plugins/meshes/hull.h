#pragma once
/// \file
/// Convex hulls.

#include <vector>

#include "api/shape.h"

namespace spark::meshes {

/// The convex hull of points, x y z of each [m]: those of them that are its corners, in their order, and triangles that
/// point outwards. Throws Error if the points lie in a plane, or are not finite.
engine::Mesh hullOf(std::vector<double> points);

}  // namespace spark::meshes
