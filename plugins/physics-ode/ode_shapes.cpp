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

/// The mesh without vertices that no triangle has: ODE fails on a mesh of one triangle with others.
std::shared_ptr<const engine::Mesh> withoutUnused(std::shared_ptr<const engine::Mesh> mesh) {
  const std::size_t points = mesh->vertices.size() / 3;
  std::vector<std::uint32_t> now(points, 0);
  for (const std::uint32_t i : mesh->triangles) now[i] = 1;
  if (std::find(now.begin(), now.end(), 0U) == now.end()) return mesh;
  auto out = std::make_shared<engine::Mesh>();
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < points; ++i) {
    if (now[i] == 0) continue;
    const auto vertex = mesh->vertices.begin() + static_cast<std::ptrdiff_t>(3 * i);
    out->vertices.insert(out->vertices.end(), vertex, vertex + 3);
    now[i] = count++;
  }
  for (const std::uint32_t i : mesh->triangles) out->triangles.push_back(now[i]);
  return out;
}

}  // namespace

OdeMesh::OdeMesh(std::shared_ptr<const engine::Mesh> from)
    : mesh(withoutUnused(std::move(from))), data(dGeomTriMeshDataCreate()) {
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
  // Outside of a space nothing updates the bounds, by which ODE selects triangles of a mesh.
  dReal bounds[6];
  dGeomGetAABB(out, bounds);
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
