#include "ode_shapes.h"

#include <Eigen/Geometry>
#include <algorithm>
#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>
#endif

namespace spark::ode {

using engine::Shape;
using engine::ShapeDescription;

namespace {

using MeshPointer = std::shared_ptr<const engine::Mesh>;

/// A mesh of one triangle is cut in two, at the middle of its longest edge. ODE makes no tree of a single triangle, and
/// its collisions with hulls and other meshes read the tree all the same.
MeshPointer withTwoTriangles(MeshPointer mesh) {
  if (mesh->triangles.size() != 3) return mesh;
  const auto corner = [&](int i) {
    return Vec3::Map(mesh->vertices.data() + std::size_t{3} * mesh->triangles[static_cast<std::size_t>(i % 3)]);
  };
  int longest = 0;
  for (int i = 1; i < 3; ++i)
    if ((corner(i) - corner(i + 1)).norm() > (corner(longest) - corner(longest + 1)).norm()) longest = i;
  auto out = std::make_shared<engine::Mesh>();
  const Vec3 a = corner(longest), b = corner(longest + 1), c = corner(longest + 2), middle = (a + b) / 2;
  for (const Vec3& p : {a, b, c, middle}) out->vertices.insert(out->vertices.end(), p.begin(), p.end());
  out->triangles = {0, 3, 2, 3, 1, 2};
  return out;
}

}  // namespace

OdeMesh::OdeMesh(MeshPointer from) : mesh(withTwoTriangles(std::move(from))), data(dGeomTriMeshDataCreate()) {
  dGeomTriMeshDataBuildDouble(data, mesh->vertices.data(), 3 * sizeof(double),
                              static_cast<int>(mesh->vertices.size() / 3), mesh->triangles.data(),
                              static_cast<int>(mesh->triangles.size()), 3 * sizeof(std::uint32_t));
  // Contacts with convex shapes need the angles at the edges.
  dGeomTriMeshDataPreprocess2(data, 1U << dTRIDATAPREPROCESS_BUILD_FACE_ANGLES, nullptr);
}

namespace {

/// ODE keeps the pose of a destroyed geom for the next one that is created, in whichever thread, and exchanges it
/// atomically. The thread sanitizer cannot see that within a library: it is told of the order by this tag.
#ifdef __SANITIZE_THREAD__
char posesOrder;
void posePutBack() { __tsan_release(&posesOrder); }
void poseTaken() { __tsan_acquire(&posesOrder); }
#else
void posePutBack() {}
void poseTaken() {}
#endif

dGeomID createHull(const ConvexHull& hull, dSpaceID space, std::size_t faces) {
  return dCreateConvex(space, hull.planes().data(), static_cast<unsigned>(faces), hull.corners().data(),
                       static_cast<unsigned>(hull.corners().size() / 3), hull.polygons().data());
}

}  // namespace

OdeHull::~OdeHull() {
  for (const dGeomID probe : probes_)
    if (probe) destroyGeom(probe);
}

dGeomID OdeHull::create(dSpaceID space) const { return createHull(hull_, space, 0); }

dGeomID OdeHull::probe(int which) {
  dGeomID& probe = probes_[which];
  if (!probe) {
    probe = createHull(hull_, nullptr, hull_.faces().size());
    poseTaken();
  }
  return probe;
}

dGeomID OdeHull::probeAt(dGeomID geom, int which) {
  const dGeomID out = probe(which);
  const dReal* const p = dGeomGetPosition(geom);
  dGeomSetPosition(out, p[0], p[1], p[2]);
  dGeomSetRotation(out, dGeomGetRotation(geom));
  updateBounds(out);
  return out;
}

OdeHeights::OdeHeights(std::shared_ptr<const engine::HeightField> from)
    : field(std::move(from)), data(dGeomHeightfieldDataCreate()) {
  const engine::HeightField& f = *field;
  const auto height = [](void* context, int x, int z) -> dReal {
    const auto& own = *static_cast<const engine::HeightField*>(context);
    return own.height(x, own.rows - 1 - z);
  };
  // What sinks in by less than this is still met from below [m].
  constexpr double kThickness = 1;
  dGeomHeightfieldDataBuildCallback(data, const_cast<engine::HeightField*>(&f), height, f.width, f.depth, f.columns,
                                    f.rows, 1, 0, kThickness, 0);
  dGeomHeightfieldDataSetBounds(data, f.low, f.high);
}

Mat3 OdeHeights::toShape() {
  Mat3 m;
  m << Vec3::UnitX(), Vec3::UnitZ(), -Vec3::UnitY();
  return m;
}

namespace {

/// A rotation that turns the z axis to `direction`.
Mat3 alongZ(const Vec3& direction) {
  const Vec3 z = direction.normalized();
  const Vec3 x = z.unitOrthogonal();
  Mat3 m;
  m << x, z.cross(x), z;
  return m;
}
dGeomID create(const ShapeDescription& s, dSpaceID space, MadeShapes& made, SharedShape& shared) {
  shared = {};
  switch (s.shape) {
    case Shape::box:
      return dCreateBox(space, s.lengths.x(), s.lengths.y(), s.lengths.z());
    case Shape::sphere:
      return dCreateSphere(space, s.radius);
    case Shape::capsule:
      return dCreateCapsule(space, s.radius, s.length);
    case Shape::cylinder:
      return dCreateCylinder(space, s.radius, s.length);
    case Shape::plane: {
      const double n = std::hypot(s.plane[0], s.plane[1], s.plane[2]);
      return dCreatePlane(space, s.plane[0] / n, s.plane[1] / n, s.plane[2] / n, s.plane[3] / n);
    }
    case Shape::ray:
      return dCreateRay(space, s.length);
    case Shape::mesh:
      shared.mesh = made.meshes.get(s.mesh, [](const auto& mesh) { return std::make_shared<OdeMesh>(mesh); });
      return dCreateTriMesh(space, shared.mesh->data, nullptr, nullptr, nullptr);
    case Shape::convex:
      shared.hull = made.hulls.get(s.mesh, [](const auto& mesh) { return std::make_shared<OdeHull>(mesh); });
      return shared.hull->create(space);
    case Shape::heightField:
      shared.heights =
          made.heights.get(s.heightField, [](const auto& field) { return std::make_shared<OdeHeights>(field); });
      return dCreateHeightfield(space, shared.heights->data, 1);
  }
  return nullptr;
}

}  // namespace

dGeomID createGeom(const ShapeDescription& s, dSpaceID space, MadeShapes& made, SharedShape& shared) {
  const dGeomID geom = create(s, space, made, shared);
  poseTaken();
  return geom;
}

void destroyGeom(dGeomID geom) {
  posePutBack();
  dGeomDestroy(geom);
}

void updateBounds(dGeomID geom) {
  dReal bounds[6];
  dGeomGetAABB(geom, bounds);
}

bool reshape(dGeomID geom, const ShapeDescription& from, const ShapeDescription& to) {
  if (from.shape != to.shape) return false;
  switch (to.shape) {
    case Shape::box:
      dGeomBoxSetLengths(geom, to.lengths.x(), to.lengths.y(), to.lengths.z());
      return true;
    case Shape::sphere:
      dGeomSphereSetRadius(geom, to.radius);
      return true;
    case Shape::capsule:
      dGeomCapsuleSetParams(geom, to.radius, to.length);
      return true;
    default:
      return false;
  }
}

Pose frameOf(const ShapeDescription& s, const SharedShape& shared) {
  switch (s.shape) {
    case Shape::ray:
      return {s.rayOrigin, alongZ(s.rayDirection)};
    case Shape::convex:
      return {shared.hull->hull().center(), Mat3::Identity()};
    case Shape::heightField:
      return {Vec3::Zero(), OdeHeights::toShape()};
    default:
      return {};
  }
}

}  // namespace spark::ode
