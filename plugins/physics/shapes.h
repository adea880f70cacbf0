#pragma once
/// \file
/// Collision shapes: which can be.

#include "api/model.h"

namespace spark::physics {

/// Most numbers of a mesh (of its vertices and triangles), and points along an edge of a height field.
inline constexpr std::size_t kMostMeshNumbers = 6'000'000;
inline constexpr int kMostHeightEdge = 2048;
/// Largest coordinate of a mesh or a height field [m].
inline constexpr double kFarthest = 1e6;

/// Throws Error for a shape that no engine can represent.
void checkShape(const engine::ShapeDescription& shape);

}  // namespace spark::physics
