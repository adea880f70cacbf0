#include "queries.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "height_field.h"
#include "shape_ray.h"

namespace spark::physics {

using engine::Index;
using engine::Shape;
using engine::ShapeDescription;

// To its plane where the point is above it, else to the nearest edge. One without area has edges only.
double distanceToTriangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = (b - a).cross(c - a).normalized();
  const auto toEdge = [&](const Vec3& from, const Vec3& to) {
    const Vec3 edge = to - from;
    const double square = edge.squaredNorm();
    const double along = square > 0 ? std::clamp(edge.dot(p - from) / square, 0.0, 1.0) : 0;
    return (p - from - along * edge).norm();
  };
  const auto inside = [&](const Vec3& from, const Vec3& to) { return normal.dot((to - from).cross(p - from)) >= 0; };
  if (!normal.isZero(0) && inside(a, b) && inside(b, c) && inside(c, a)) return std::abs(normal.dot(p - a));
  return std::min({toEdge(a, b), toEdge(b, c), toEdge(c, a)});
}

bool isQueried(const engine::Geom& g) { return g.collides && g.shape.shape != Shape::ray; }

Pose poseOf(const engine::Model& model, const engine::State& state, Index geom) {
  const engine::Geom& g = model.geoms[geom];
  if (g.body == engine::kNone) return g.shape.shape == Shape::plane ? Pose{} : g.offset;
  const engine::DynamicState& s = state.bodies[g.body];
  if (g.centred) return {s.position, s.rotation};
  return compose({s.position, s.rotation}, g.offset);
}

std::optional<GeomHit> castRay(const engine::Model& model, const engine::State& state, const Vec3& from,
                               const Vec3& direction, double length, const Accepts& accepts) {
  GeomHit nearest{engine::kNone, length, Vec3::Zero()};
  for (Index i = 0; i < model.geoms.size(); ++i) {
    const engine::Geom& g = model.geoms[i];
    if (!isQueried(g)) continue;
    const Pose pose = poseOf(model, state, i);
    // The sphere around the shape must come near enough to the ray, with room for rounding: a ray that only touches the
    // shape is not rejected.
    const Vec3 to = pose.position - from;
    const double r = reach(g.shape), along = std::clamp(to.dot(direction), 0.0, nearest.distance);
    if ((to - along * direction).squaredNorm() > r * r + 1e-12 * (r * r + to.squaredNorm())) continue;
    if (accepts && !accepts(g)) continue;
    const Mat3 toShape = pose.rotation.transpose();
    ShapeRay ray{toShape * -to, toShape * direction, nearest.distance};
    castShape(ray, g.shape);
    if (ray.hit) nearest = {i, ray.nearest, toShape.transpose() * ray.normal};
  }
  if (nearest.geom == engine::kNone) return std::nullopt;
  return nearest;
}

namespace {

double distanceToSurface(const engine::Mesh& m, const Vec3& p) {
  double nearest = HUGE_VAL;
  for (std::size_t i = 0; i + 2 < m.triangles.size(); i += 3)
    nearest = std::min(nearest, distanceToTriangle(p, cornerOf(m, i), cornerOf(m, i + 1), cornerOf(m, i + 2)));
  return nearest;
}

/// How far a point is outside of the farthest of the planes of a hull's faces [m]; 0 or less inside.
double beyondFaces(const engine::Mesh& m, const Vec3& p) {
  double farthest = -HUGE_VAL;
  for (std::size_t i = 0; i + 2 < m.triangles.size(); i += 3) {
    const Vec3 a = cornerOf(m, i);
    const Vec3 normal = (cornerOf(m, i + 1) - a).cross(cornerOf(m, i + 2) - a).normalized();
    if (!normal.isZero(0)) farthest = std::max(farthest, normal.dot(p - a));
  }
  return farthest;
}

}  // namespace

double distanceTo(const ShapeDescription& s, const Vec3& p) {
  const double aside = std::hypot(p.x(), p.y()), along = std::abs(p.z());
  switch (s.shape) {
    case Shape::box: {
      const Vec3 beyond = p.cwiseAbs() - s.lengths / 2;
      return beyond.maxCoeff() <= 0 ? beyond.maxCoeff() : beyond.cwiseMax(0).norm();
    }
    case Shape::sphere:
      return p.norm() - s.radius;
    case Shape::capsule:
      return std::hypot(aside, std::max(0.0, along - s.length / 2)) - s.radius;
    case Shape::cylinder: {
      const double outside = aside - s.radius, above = along - s.length / 2;
      if (outside <= 0 && above <= 0) return std::max(outside, above);
      return std::hypot(std::max(0.0, outside), std::max(0.0, above));
    }
    case Shape::plane: {
      const Vec3 normal(s.plane[0], s.plane[1], s.plane[2]);
      return (normal.dot(p) - s.plane[3]) / normal.norm();
    }
    case Shape::mesh:
      return distanceToSurface(*s.mesh, p);
    case Shape::convex: {
      const double beyond = beyondFaces(*s.mesh, p);
      return beyond <= 0 ? beyond : distanceToSurface(*s.mesh, p);
    }
    case Shape::heightField:
      return distanceTo(*s.heightField, p);
    case Shape::ray:
      break;
  }
  return HUGE_VAL;
}

bool touches(const ShapeDescription& shape, const Vec3& position, const Mat3& toShape, const Vec3& center,
             double radius) {
  const Vec3 to = center - position;
  return to.norm() <= reach(shape) + radius && distanceTo(shape, toShape * to) <= radius;
}

void findOverlaps(const engine::Model& model, const engine::State& state, const Vec3& center, double radius,
                  std::vector<Index>& out) {
  for (Index i = 0; i < model.geoms.size(); ++i) {
    const engine::Geom& g = model.geoms[i];
    if (!isQueried(g)) continue;
    const Pose pose = poseOf(model, state, i);
    if (touches(g.shape, pose.position, pose.rotation.transpose(), center, radius)) out.push_back(i);
  }
}

}  // namespace spark::physics
