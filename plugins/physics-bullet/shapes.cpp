#include "shapes.h"

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>

#include <algorithm>

#include "convert.h"

namespace spark::bullet {

using engine::Shape;
using engine::ShapeDescription;

namespace {

/// Margin of a mesh, which lies around it [m].
constexpr double kMeshMargin = 0.0005;

std::unique_ptr<btCollisionShape> hullOf(const ShapeDescription& s) {
  auto hull = std::make_unique<btConvexHullShape>();
  for (std::size_t i = 0; i + 2 < s.vertices.size(); i += 3)
    hull->addPoint({s.vertices[i], s.vertices[i + 1], s.vertices[i + 2]}, false);
  hull->recalcLocalAabb();
  hull->setMargin(kMeshMargin);
  return hull;
}

std::unique_ptr<btCollisionShape> meshOf(Solid& solid) {
  static_assert(sizeof(int) == sizeof(std::uint32_t));
  ShapeDescription& s = solid.from;
  solid.mesh = std::make_unique<btTriangleIndexVertexArray>(
      static_cast<int>(s.triangles.size() / 3), reinterpret_cast<int*>(s.triangles.data()),
      static_cast<int>(3 * sizeof(int)), static_cast<int>(s.vertices.size() / 3), s.vertices.data(),
      static_cast<int>(3 * sizeof(double)));
  auto mesh = std::make_unique<btBvhTriangleMeshShape>(solid.mesh.get(), true);
  mesh->setMargin(kMeshMargin);
  return mesh;
}

std::unique_ptr<btCollisionShape> shapeOf(Solid& solid) {
  const ShapeDescription& s = solid.from;
  switch (s.shape) {
    case Shape::box:
      return std::make_unique<btBoxShape>(toBullet(Vec3(s.lengths / 2)));
    case Shape::sphere:
      return std::make_unique<btSphereShape>(s.radius);
    case Shape::capsule:
      return std::make_unique<btCapsuleShapeZ>(s.radius, s.length);
    case Shape::cylinder:
      return std::make_unique<btCylinderShapeZ>(btVector3(s.radius, s.radius, s.length / 2));
    case Shape::mesh:
      if (s.vertices.empty() || s.triangles.empty()) return nullptr;
      return solid.hasBody ? hullOf(s) : meshOf(solid);
    default:
      return nullptr;
  }
}

}  // namespace

std::unique_ptr<Solid> makeSolid(const engine::Geom& geom) {
  auto solid = std::make_unique<Solid>();
  solid->id = geom.id;
  solid->hasBody = geom.body != engine::kNone;
  solid->from = geom.shape;
  solid->shape = shapeOf(*solid);
  if (solid->shape) solid->object.setCollisionShape(solid->shape.get());
  return solid;
}

bool isMadeOf(const Solid& solid, const engine::Geom& geom) {
  const ShapeDescription &a = solid.from, &b = geom.shape;
  return solid.hasBody == (geom.body != engine::kNone) && a.shape == b.shape && a.lengths == b.lengths &&
         a.radius == b.radius && a.length == b.length && a.vertices == b.vertices && a.triangles == b.triangles;
}

void pointsBelowPlane(const ShapeDescription& shape, const Pose& pose, const Vec3& normal, const Vec3& origin,
                      std::vector<PlanePoint>& out) {
  const auto add = [&](const Vec3& p) {
    if (const double depth = normal.dot(origin - p); depth >= 0) out.push_back({p, depth});
  };
  const Vec3 z = pose.rotation.col(2);
  switch (shape.shape) {
    case Shape::box:
      for (int corner = 0; corner < 8; ++corner) {
        const Vec3 signs(corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5, corner & 4 ? 0.5 : -0.5);
        add(pose.position + pose.rotation * shape.lengths.cwiseProduct(signs));
      }
      break;
    case Shape::sphere:
      add(pose.position - shape.radius * normal);
      break;
    case Shape::capsule:
      for (const double end : {-0.5, 0.5}) add(pose.position + end * shape.length * z - shape.radius * normal);
      break;
    case Shape::cylinder: {
      // Of each rim the lowest point, that opposite to it, and those between.
      Vec3 down = -normal + normal.dot(z) * z;
      down = down.norm() > 1e-6 ? Vec3(down.normalized()) : Vec3(pose.rotation.col(0));
      const Vec3 side = z.cross(down);
      for (const double end : {-0.5, 0.5})
        for (const Vec3& d : {down, side, Vec3(-down), Vec3(-side)})
          add(pose.position + end * shape.length * z + shape.radius * d);
      break;
    }
    case Shape::mesh:
      for (std::size_t i = 0; i + 2 < shape.vertices.size(); i += 3)
        add(pose.position + pose.rotation * Vec3(shape.vertices[i], shape.vertices[i + 1], shape.vertices[i + 2]));
      break;
    default:
      break;
  }
}

}  // namespace spark::bullet
