#pragma once
/// \file
/// The point of a shape that is nearest to the apex of a cone, of all that are in the cone.

#include <functional>
#include <optional>
#include <vector>

#include "api/model.h"

namespace spark::physics {

/// A cone in the frame of a shape.
struct Cone {
  Vec3 apex, axis;      ///< m; length 1
  double cosine, sine;  ///< of the angle between axis and side, 0 to pi
  double range;         ///< m
  /// True if the direction `v`, of any length, is in it.
  bool contains(const Vec3& v) const { return v.dot(axis) >= (cosine - 1e-12) * v.norm(); }
  /// The direction in the cone that is nearest to `v`, length 1.
  Vec3 nearestTo(const Vec3& v) const;
};

/// Calls `visit` for triangles of a mesh, by their numbers: all that are within `radius` of `center`, and maybe others.
using NearTriangles =
    std::function<void(const Vec3& center, double radius, const std::function<void(std::uint32_t)>& visit)>;

/// The nearest point in the cone within its range, relative to the apex; zero where the shape contains the apex;
/// nullopt where there is none. Round sides are taken as prisms of 64 sides, one edge of which is next to the apex.
std::optional<Vec3> nearestInCone(const engine::ShapeDescription& shape, const Cone& cone, const NearTriangles& near);

/// Appends points that are spread over a shape, in its frame, for rays that look for a visible part of it.
void spreadPoints(const engine::ShapeDescription& shape, std::vector<Vec3>& out);

}  // namespace spark::physics
