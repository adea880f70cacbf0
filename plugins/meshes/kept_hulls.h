#pragma once
/// \file
/// Convex hulls that are made once, however often a file is imported.

#include <memory>

#include "api/shape.h"

namespace spark::meshes {

/// The convex hull of a surface's vertices, as hullOf() makes it. The hulls of the surfaces of the last imports are
/// kept, up to 4 million numbers, and found by the numbers of the surface. Any thread may call it. Throws Error as
/// hullOf().
std::shared_ptr<const engine::Mesh> keptHullOf(const std::shared_ptr<const engine::Mesh>& surface);

}  // namespace spark::meshes
