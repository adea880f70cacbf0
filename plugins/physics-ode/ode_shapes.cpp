#include "ode_shapes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <numeric>
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

/// For each vertex the first one in its place.
std::vector<std::uint32_t> firstVertices(const engine::Mesh& m) {
  std::vector<std::uint32_t> order(m.vertices.size() / 3), first(order.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto at = [&m](std::uint32_t i) { return std::array{m.vertex(i).x(), m.vertex(i).y(), m.vertex(i).z()}; };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return at(a) < at(b); });
  for (std::size_t i = 0; i < order.size(); ++i)
    first[order[i]] = i > 0 && at(order[i]) == at(order[i - 1]) ? first[order[i - 1]] : order[i];
  return first;
}

/// For each triangle the first one with its corners that looks at its side.
std::vector<std::uint32_t> firstTriangles(std::vector<std::array<std::uint32_t, 3>> corners) {
  for (auto& c : corners) std::rotate(c.begin(), std::min_element(c.begin(), c.end()), c.end());
  std::vector<std::uint32_t> order(corners.size()), first(order.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return std::pair(corners[a], a) < std::pair(corners[b], b); });
  for (std::size_t i = 0; i < order.size(); ++i)
    first[order[i]] = i > 0 && corners[order[i]] == corners[order[i - 1]] ? first[order[i - 1]] : order[i];
  return first;
}

/// Which triangles lie on another one that looks at the opposite side, and come behind it: those share an edge, however
/// each side is cut into triangles.
std::vector<std::uint8_t> isReverse(const engine::Mesh& m) {
  const std::vector<std::uint32_t> vertex = firstVertices(m);
  std::vector<std::array<std::uint32_t, 3>> corners;
  std::vector<Vec3> normals;
  for (std::size_t i = 0; i < m.triangles.size(); i += 3) {
    const std::uint32_t* const c = m.triangles.data() + i;
    corners.push_back({vertex[c[0]], vertex[c[1]], vertex[c[2]]});
    normals.push_back((m.vertex(c[1]) - m.vertex(c[0])).cross(m.vertex(c[2]) - m.vertex(c[0])).normalized());
  }

  // The edges of triangles that lie on none of their own side: thousands of triangles may lie in one place.
  struct Edge {
    std::uint32_t from, to, triangle;
    auto operator<=>(const Edge&) const = default;
  };
  const std::vector<std::uint32_t> first = firstTriangles(corners);
  std::vector<Edge> edges;
  for (std::uint32_t t = 0; t < corners.size(); ++t)
    for (std::size_t i = 0; i < 3 && first[t] == t; ++i) edges.push_back({corners[t][i], corners[t][(i + 1) % 3], t});
  std::sort(edges.begin(), edges.end());

  // One triangle after the other: what is reverse makes no other one reverse.
  constexpr double kOpposite = -1 + 1e-6;  // cosine between the normals
  std::vector<std::uint8_t> out(corners.size(), 0);
  const auto liesOnEarlier = [&](std::uint32_t t, std::uint32_t from, std::uint32_t to) {
    for (auto other = std::lower_bound(edges.begin(), edges.end(), Edge{to, from, 0});
         other != edges.end() && other->from == to && other->to == from && other->triangle < t; ++other)
      if (!out[other->triangle] && normals[other->triangle].dot(normals[t]) < kOpposite) return true;
    return false;
  };
  for (std::uint32_t t = 0; t < corners.size(); ++t) {
    const auto& c = corners[t];
    out[t] = first[t] != t
                 ? out[first[t]]
                 : liesOnEarlier(t, c[0], c[1]) || liesOnEarlier(t, c[1], c[2]) || liesOnEarlier(t, c[2], c[0]);
  }
  return out;
}

/// The triangles of a mesh for which `chosen` has this value.
MeshPointer partOf(const engine::Mesh& mesh, const std::vector<std::uint8_t>& chosen, std::uint8_t value) {
  auto out = std::make_shared<engine::Mesh>();
  // ODE takes no vertices without triangles.
  std::vector<std::uint32_t> at(mesh.vertices.size() / 3, UINT32_MAX);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (chosen[i / 3] != value) continue;
    const std::uint32_t from = mesh.triangles[i];
    if (at[from] == UINT32_MAX) {
      at[from] = static_cast<std::uint32_t>(out->vertices.size() / 3);
      const Vec3 v = mesh.vertex(from);
      out->vertices.insert(out->vertices.end(), v.begin(), v.end());
    }
    out->triangles.push_back(at[from]);
  }
  return withTwoTriangles(std::move(out));
}

}  // namespace

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

/// Moves a geom in no space to where another one is.
void placeLike(dGeomID geom, dGeomID moved) {
  const dReal* const p = dGeomGetPosition(geom);
  dGeomSetPosition(moved, p[0], p[1], p[2]);
  dGeomSetRotation(moved, dGeomGetRotation(geom));
  updateBounds(moved);
}

}  // namespace

OdeMesh::OdeMesh(MeshPointer from) : mesh(withTwoTriangles(std::move(from))), data(dGeomTriMeshDataCreate()) {
  dGeomTriMeshDataBuildDouble(data, mesh->vertices.data(), 3 * sizeof(double),
                              static_cast<int>(mesh->vertices.size() / 3), mesh->triangles.data(),
                              static_cast<int>(mesh->triangles.size()), 3 * sizeof(std::uint32_t));
  // Contacts with convex shapes need the angles at the edges.
  dGeomTriMeshDataPreprocess2(data, 1U << dTRIDATAPREPROCESS_BUILD_FACE_ANGLES, nullptr);
  const std::vector<std::uint8_t> reverse = isReverse(*mesh);
  if (std::find(reverse.begin(), reverse.end(), 1) == reverse.end()) return;
  for (std::uint8_t side = 0; side < 2; ++side) {
    sides_[side] = std::make_unique<OdeMesh>(partOf(*mesh, reverse, side));
    asked_.push_back(dCreateTriMesh(nullptr, sides_[side]->data, nullptr, nullptr, nullptr));
    poseTaken();
  }
}

OdeMesh::~OdeMesh() {
  for (const dGeomID geom : asked_)
    if (sides_[0]) destroyGeom(geom);
  dGeomTriMeshDataDestroy(data);
}

std::span<const dGeomID> OdeMesh::sidesAt(dGeomID geom) {
  if (!sides_[0]) asked_ = {geom};
  for (const dGeomID side : asked_)
    if (side != geom) placeLike(geom, side);
  return asked_;
}

namespace {

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
  placeLike(geom, out);
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

std::shared_ptr<OdeHull> prismAround(const ShapeDescription& cylinder) {
  const double radius = cylinder.radius / std::cos(kPi / kPrismSides), half = cylinder.length / 2;
  auto mesh = std::make_shared<engine::Mesh>();
  for (std::uint32_t i = 0; i < kPrismSides; ++i) {
    const double angle = 2 * kPi * i / kPrismSides;
    for (const double z : {-half, half})
      mesh->vertices.insert(mesh->vertices.end(), {radius * std::cos(angle), radius * std::sin(angle), z});
    // Corners of this side: low, high, and the next ones.
    const std::uint32_t low = 2 * i, high = low + 1, nextLow = (low + 2) % (2 * kPrismSides), nextHigh = nextLow + 1;
    mesh->triangles.insert(mesh->triangles.end(), {low, nextLow, nextHigh, low, nextHigh, high});
    if (i >= 1 && i + 1 < kPrismSides)
      mesh->triangles.insert(mesh->triangles.end(), {0, nextLow, low, 1, high, nextHigh});
  }
  return std::make_shared<OdeHull>(std::move(mesh));
}

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
