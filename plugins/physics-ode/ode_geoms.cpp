#include <fmt/format.h>

#include <Eigen/Geometry>

#include "ode_engine.h"

namespace spark {

using namespace ode;
using engine::Geom;
using engine::Shape;
using engine::ShapeDescription;

namespace {

void expectLength(double v, const char* what) {
  if (!std::isfinite(v) || v < 0) throw Error(fmt::format("expected {} of 0 m or more, found {}", what, v));
}

/// Throws Error for a malformed mesh.
void checkMesh(const ShapeDescription& s) {
  const std::size_t points = s.vertices.size() / 3;
  if (points == 0 || s.vertices.size() % 3 || s.triangles.empty() || s.triangles.size() % 3)
    throw Error(fmt::format("expected three numbers a vertex and three indices a triangle, found {} and {}",
                            s.vertices.size(), s.triangles.size()));
  for (double v : s.vertices)
    if (!std::isfinite(v)) throw Error("a vertex of the mesh is not finite");
  for (std::uint32_t i : s.triangles)
    if (i >= points) throw Error(fmt::format("a triangle of the mesh names vertex {} of {}", i, points));
}

/// Throws Error for a shape that ODE cannot represent.
void check(const ShapeDescription& s) {
  switch (s.shape) {
    case Shape::box:
      for (int i = 0; i < 3; ++i) expectLength(s.lengths[i], "an edge of a box");
      break;
    case Shape::sphere:
      expectLength(s.radius, "a sphere's radius");
      break;
    case Shape::capsule:
    case Shape::cylinder:
      expectLength(s.radius, "a radius");
      expectLength(s.length, "a length");
      break;
    case Shape::plane:
      if (const double n = std::hypot(s.plane[0], s.plane[1], s.plane[2]);
          !(n > 1e-12) || !std::isfinite(n) || !std::isfinite(s.plane[3]))
        throw Error("expected a plane with a normal longer than 0 m and finite numbers");
      break;
    case Shape::ray:
      expectLength(s.length, "a ray's length");
      if (!(s.rayDirection.norm() > 1e-12) || !s.rayDirection.allFinite() || !s.rayOrigin.allFinite())
        throw Error("expected a ray with a direction longer than 0 m and finite numbers");
      break;
    case Shape::mesh:
      checkMesh(s);
      break;
  }
}

/// A rotation that turns the z axis to `direction`.
Mat3 alongZ(const Vec3& direction) {
  const Vec3 z = direction.normalized();
  const Vec3 x = z.unitOrthogonal();
  Mat3 m;
  m << x, z.cross(x), z;
  return m;
}

}  // namespace

void OdeEngine::createShape(GeomData& g) {
  const ShapeDescription& s = g.shape;
  g.base = Pose{};
  switch (s.shape) {
    case Shape::box:
      g.id = dCreateBox(g.space, s.lengths.x(), s.lengths.y(), s.lengths.z());
      break;
    case Shape::sphere:
      g.id = dCreateSphere(g.space, s.radius);
      break;
    case Shape::capsule:
      g.id = dCreateCapsule(g.space, s.radius, s.length);
      break;
    case Shape::cylinder:
      g.id = dCreateCylinder(g.space, s.radius, s.length);
      break;
    case Shape::plane: {
      const double n = std::hypot(s.plane[0], s.plane[1], s.plane[2]);
      g.id = dCreatePlane(g.space, s.plane[0] / n, s.plane[1] / n, s.plane[2] / n, s.plane[3] / n);
      break;
    }
    case Shape::ray:
      g.id = dCreateRay(g.space, s.length);
      g.base = {s.rayOrigin, alongZ(s.rayDirection)};
      break;
    case Shape::mesh:
      g.mesh.reset(dGeomTriMeshDataCreate());
      dGeomTriMeshDataBuildDouble(g.mesh.get(), s.vertices.data(), 3 * sizeof(double),
                                  static_cast<int>(s.vertices.size() / 3), s.triangles.data(),
                                  static_cast<int>(s.triangles.size()), 3 * sizeof(std::uint32_t));
      g.id = dCreateTriMesh(g.space, g.mesh.get(), nullptr, nullptr, nullptr);
      break;
  }
  dGeomSetData(g.id, &g);
}

void OdeEngine::place(GeomData& g) {
  if (g.shape.shape == Shape::plane) return;  // a plane is given in the world frame
  const Pose p = compose(g.offset, g.base);
  dMatrix3 r;
  toOde(p.rotation, r);
  dGeomSetBody(g.id, g.body ? g.body->id : nullptr);
  if (!g.body) {
    dGeomSetPosition(g.id, p.position.x(), p.position.y(), p.position.z());
    dGeomSetRotation(g.id, r);
  } else if (p.position.isZero(0) && p.rotation.isIdentity(0)) {
    dGeomClearOffset(g.id);
  } else {
    dGeomSetOffsetPosition(g.id, p.position.x(), p.position.y(), p.position.z());
    dGeomSetOffsetRotation(g.id, r);
  }
}

namespace {

/// Changes the dimensions of ODE's geom, so that it keeps its position in the space's list. Returns false when the geom
/// must be created again.
bool reshape(GeomData& g, const ShapeDescription& s) {
  if (s.shape != g.shape.shape) return false;
  switch (s.shape) {
    case Shape::box:
      dGeomBoxSetLengths(g.id, s.lengths.x(), s.lengths.y(), s.lengths.z());
      break;
    case Shape::sphere:
      dGeomSphereSetRadius(g.id, s.radius);
      break;
    case Shape::capsule:
      dGeomCapsuleSetParams(g.id, s.radius, s.length);
      break;
    default:
      return false;
  }
  g.shape = s;
  return true;
}

}  // namespace

Geom OdeEngine::createGeom(engine::Space space, const ShapeDescription& shape, void* owner) {
  check(shape);
  const MessageCapture capture(odeMessage_);
  SpaceData& s = *data(space);
  auto g = std::make_unique<GeomData>();
  g->world = s.world;
  g->space = s.id;
  g->shape = shape;
  g->owner = owner;
  g->age = s.world->nextAge++;
  createShape(*g);
  place(*g);
  const Geom created = handle(*g);
  s.world->geoms.push_back(std::move(g));
  return created;
}

void OdeEngine::destroyGeom(Geom geom) {
  GeomData* g = data(geom);
  dGeomDestroy(g->id);
  removeFrom(g->world->geoms, g);
}

void OdeEngine::setShape(Geom geom, const ShapeDescription& shape) {
  check(shape);
  const MessageCapture capture(odeMessage_);
  GeomData& g = *data(geom);
  if (reshape(g, shape)) return;
  const bool collides = dGeomIsEnabled(g.id);
  dGeomDestroy(g.id);
  g.mesh.reset();
  g.shape = shape;
  createShape(g);
  place(g);
  if (!collides) dGeomDisable(g.id);
}

void OdeEngine::setBody(Geom geom, engine::Body body, const Pose& offset) {
  if (!inRange(offset.position) || !inRange(offset.rotation.data(), 9))
    throw Error("expected a finite offset of a collider");
  GeomData& g = *data(geom);
  g.body = g.shape.shape == Shape::plane ? nullptr : data(body);
  g.offset = offset;
  place(g);
}

void OdeEngine::setPose(Geom geom, const Pose& pose) {
  GeomData& g = *data(geom);
  if (g.body || !inRange(pose.position) || !inRange(pose.rotation.data(), 9)) return;
  g.offset = pose;
  place(g);
}

Pose OdeEngine::pose(Geom geom) const {
  // Computed here: getters run in several threads, and ODE's getters may update a geom's cached pose.
  const GeomData& g = *data(geom);
  if (!g.body) return g.offset;
  return compose({toVec(g.body->position), toMat(g.body->rotation)}, g.offset);
}

void OdeEngine::setCollides(Geom geom, bool on) {
  if (on)
    dGeomEnable(data(geom)->id);
  else
    dGeomDisable(data(geom)->id);
}

}  // namespace spark
