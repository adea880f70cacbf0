#pragma once
/// \file
/// Convex hulls.

#include <vector>

#include "api/shape.h"

namespace spark::meshes {

/// The convex hull of points, x y z of each [m]: those of them that are its corners, in their order, and triangles that
/// point outwards. Throws Error if the points lie in a plane, or are not finite.
engine::Mesh hullOf(std::vector<double> points);

/// True if the triangles of a surface have together an area that something can lie on: 1 mm^2.
bool hasArea(const engine::Mesh& surface);

/// True if a surface encloses as much as its convex hull: their volumes differ by less than one part in a thousand.
bool isConvex(const engine::Mesh& surface, const engine::Mesh& hull);

/// True if a surface encloses a volume, with all triangles seen from outside, or all from inside: each of their edges
/// is one of two triangles, in opposite directions. Vertices at one place are one.
bool isClosed(const engine::Mesh& surface);

}  // namespace spark::meshes
