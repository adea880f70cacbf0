#include "shapes.h"

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/CollisionShapes/btTriangleIndexVertexArray.h>

#include <algorithm>

#include "convert.h"

namespace spark::bullet {

using engine::Shape;
using engine::ShapeDescription;

namespace {

/// Margin of a mesh, which lies around it [m].
constexpr double kMeshMargin = 0.0005;

}  // namespace

struct BulletHull {
  explicit BulletHull(std::shared_ptr<const engine::Mesh> from) : mesh(std::move(from)) {
    for (std::size_t i = 0; i < mesh->vertices.size() / 3; ++i) shape.addPoint(toBullet(mesh->vertex(i)), false);
    shape.recalcLocalAabb();
    shape.setMargin(kMeshMargin);
  }
  std::shared_ptr<const engine::Mesh> mesh;
  btConvexHullShape shape;
};

struct BulletMesh {
  explicit BulletMesh(std::shared_ptr<const engine::Mesh> from)
      : mesh(std::move(from)),
        // Bullet only reads the numbers.
        array(static_cast<int>(mesh->triangles.size() / 3),
              reinterpret_cast<int*>(const_cast<std::uint32_t*>(mesh->triangles.data())),
              static_cast<int>(3 * sizeof(int)), static_cast<int>(mesh->vertices.size() / 3),
              const_cast<double*>(mesh->vertices.data()), static_cast<int>(3 * sizeof(double))),
        shape(&array, true) {
    static_assert(sizeof(int) == sizeof(std::uint32_t));
    shape.setMargin(kMeshMargin);
  }
  std::shared_ptr<const engine::Mesh> mesh;
  btTriangleIndexVertexArray array;
  btBvhTriangleMeshShape shape;
};

struct BulletHeights {
  explicit BulletHeights(std::shared_ptr<const engine::HeightField> from)
      : field(std::move(from)),
        shape(field->columns, field->rows, field->heights.data(), field->low, field->high, 2, true) {
    shape.setLocalScaling({field->cellWidth(), field->cellDepth(), 1});
    shape.setMargin(kMeshMargin);
  }
  std::shared_ptr<const engine::HeightField> field;
  btHeightfieldTerrainShape shape;
};

namespace {

/// The shape in what was made for it, which lives as long.
template <class Made>
std::shared_ptr<btCollisionShape> shapeIn(const std::shared_ptr<Made>& made) {
  return {made, &made->shape};
}

template <class Made, class From>
std::shared_ptr<btCollisionShape> sharedShape(engine::MadeOf<From, Made>& made,
                                              const std::shared_ptr<const From>& from) {
  return shapeIn(made.get(from, [](const auto& one) { return std::make_shared<Made>(one); }));
}

std::shared_ptr<btCollisionShape> shapeOf(const ShapeDescription& s, bool hasBody, MadeShapes& made) {
  switch (s.shape) {
    case Shape::box:
      return std::make_shared<btBoxShape>(toBullet(Vec3(s.lengths / 2)));
    case Shape::sphere:
      return std::make_shared<btSphereShape>(s.radius);
    case Shape::capsule:
      return std::make_shared<btCapsuleShapeZ>(s.radius, s.length);
    case Shape::cylinder:
      return std::make_shared<btCylinderShapeZ>(btVector3(s.radius, s.radius, s.length / 2));
    case Shape::mesh:
      return hasBody ? sharedShape(made.hulls, s.mesh) : sharedShape(made.meshes, s.mesh);
    case Shape::convex:
      return sharedShape(made.hulls, s.mesh);
    case Shape::heightField:
      return sharedShape(made.heights, s.heightField);
    default:
      return nullptr;
  }
}

}  // namespace

std::unique_ptr<Solid> makeSolid(const engine::Geom& geom, MadeShapes& made) {
  auto solid = std::make_unique<Solid>();
  solid->id = geom.id;
  solid->hasBody = geom.body != engine::kNone;
  solid->from = geom.shape;
  solid->shape = shapeOf(geom.shape, solid->hasBody, made);
  // Bullet's height fields are around the middle of their heights.
  if (geom.shape.shape == Shape::heightField)
    solid->origin.z() = (double(geom.shape.heightField->low) + geom.shape.heightField->high) / 2;
  if (solid->shape) solid->object.setCollisionShape(solid->shape.get());
  return solid;
}

bool isMadeOf(const Solid& solid, const engine::Geom& geom) {
  return solid.hasBody == (geom.body != engine::kNone) && engine::isSame(solid.from, geom.shape);
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
    case Shape::convex:
      for (std::size_t i = 0; i < shape.mesh->vertices.size() / 3; ++i)
        add(pose.position + pose.rotation * shape.mesh->vertex(i));
      break;
    default:
      break;
  }
}

}  // namespace spark::bullet
