#pragma once
/// \file
/// Geoms as shapes of Bullet.

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/CollisionShapes/btCollisionShape.h>
#include <BulletCollision/CollisionShapes/btTriangleIndexVertexArray.h>

#include <memory>
#include <vector>

#include "api/model.h"

namespace spark::bullet {

/// A geom as Bullet has it.
struct Solid {
  std::uint64_t id = 0;  ///< of the geom
  bool hasBody = false;  ///< a mesh is its convex hull then
  std::unique_ptr<btTriangleIndexVertexArray> mesh;
  engine::ShapeDescription from;            ///< what the shape was made of; owns the mesh's numbers
  std::unique_ptr<btCollisionShape> shape;  ///< nullptr: it has no contacts, or is a plane
  btCollisionObject object;
};

/// Makes the shape of a geom.
std::unique_ptr<Solid> makeSolid(const engine::Geom& geom);

/// True when the geom has still the shape that the solid was made of.
bool isMadeOf(const Solid& solid, const engine::Geom& geom);

/// A point of a shape below a plane.
struct PlanePoint {
  Vec3 position;  ///< on the shape, world frame
  double depth;   ///< below the plane, 0 or more [m]
};
/// Appends the points in which a shape lies on or below the plane through `origin` with the normal `normal`, of length
/// 1: corners, ends, points of rims.
void pointsBelowPlane(const engine::ShapeDescription& shape, const Pose& pose, const Vec3& normal, const Vec3& origin,
                      std::vector<PlanePoint>& out);

}  // namespace spark::bullet
