#pragma once
/// \file
/// Geoms as shapes of Bullet.

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/CollisionShapes/btCollisionShape.h>

#include <memory>
#include <vector>

#include "api/model.h"

namespace spark::bullet {

/// Shapes of Bullet that geoms share, and what their numbers are in.
struct BulletMesh;
struct BulletHull;
struct BulletHeights;

/// Those of a world.
struct MadeShapes {
  engine::MadeOf<engine::Mesh, BulletMesh> meshes;
  engine::MadeOf<engine::Mesh, BulletHull> hulls;
  engine::MadeOf<engine::HeightField, BulletHeights> heights;
};

/// A geom as Bullet has it.
struct Solid {
  std::uint64_t id = 0;                     ///< of the geom
  bool hasBody = false;                     ///< a mesh is its convex hull then
  engine::ShapeDescription from;            ///< what the shape was made of
  std::shared_ptr<btCollisionShape> shape;  ///< nullptr: it has no contacts, or is a plane
  Vec3 origin = Vec3::Zero();               ///< of Bullet's shape, in the frame of `from` [m]
  btCollisionObject object;
};

/// Makes the shape of a geom.
std::unique_ptr<Solid> makeSolid(const engine::Geom& geom, MadeShapes& made);

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
