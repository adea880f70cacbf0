#pragma once
/// \file
/// Rays and overlaps, answered from the arrays of the model and the state. Const: several threads may ask at once,
/// between two steps. Time grows with the number of geoms; most are rejected by a sphere around them. RayScene answers
/// the same, to the last bit, from a tree.

#include <functional>
#include <optional>

#include "api/state.h"

namespace spark::physics {

/// Where a ray meets a geom first.
struct GeomHit {
  engine::Index geom = engine::kNone;
  double distance = 0;         ///< from the ray's origin [m]
  Vec3 normal = Vec3::Zero();  ///< of the surface there, against the ray; length 1
};
/// False for geoms that a query is to ignore.
using Accepts = std::function<bool(const engine::Geom&)>;

/// The first geom on the way from `from` along `direction` (length 1), at most `length` far [m]. A geom that contains
/// the origin is met where the ray leaves it. Geoms that do not collide, and rays, are not met.
std::optional<GeomHit> castRay(const engine::Model& model, const engine::State& state, const Vec3& from,
                               const Vec3& direction, double length, const Accepts& accepts);

/// Appends the geoms that a sphere touches, in the order of the model.
void findOverlaps(const engine::Model& model, const engine::State& state, const Vec3& center, double radius,
                  std::vector<engine::Index>& out);

/// True if a sphere touches a shape at `position`, whose frame `toShape` rotates to from the world frame.
bool touches(const engine::ShapeDescription& shape, const Vec3& position, const Mat3& toShape, const Vec3& center,
             double radius);

/// Distance from a point to a shape, both in the shape's frame [m]; 0 or less inside. Of a mesh and of a height field:
/// to its surface.
double distanceTo(const engine::ShapeDescription& shape, const Vec3& point);
/// Distance from a point to a triangle [m].
double distanceToTriangle(const Vec3& point, const Vec3& a, const Vec3& b, const Vec3& c);

/// True for geoms that rays and overlaps meet: those that collide, but not rays.
bool isQueried(const engine::Geom& geom);

/// World pose of a geom.
Pose poseOf(const engine::Model& model, const engine::State& state, engine::Index geom);

}  // namespace spark::physics
