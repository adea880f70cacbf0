#include "queries.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>

namespace spark::physics {

using engine::Index;
using engine::Shape;
using engine::ShapeDescription;

namespace {

/// A ray in the frame of a shape, and the nearest hit so far.
struct Ray {
  Vec3 from, direction;
  double nearest;              ///< hits farther away do not count [m]
  Vec3 normal = Vec3::Zero();  ///< of the nearest hit
  bool hit = false;

  Vec3 at(double t) const { return from + t * direction; }
  void take(double t, const Vec3& outwards) {
    if (!(t >= 0) || !std::isfinite(t) || t > nearest) return;
    nearest = t;
    normal = outwards.dot(direction) > 0 ? Vec3(-outwards) : outwards;
    hit = true;
  }
};

void castBox(Ray& ray, const Vec3& half) {
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      const double t = (side * half[axis] - ray.from[axis]) / ray.direction[axis];
      const Vec3 p = ray.at(t).cwiseAbs();
      const int j = (axis + 1) % 3, k = (axis + 2) % 3;
      if (p[j] <= half[j] && p[k] <= half[k]) ray.take(t, side * Vec3::Unit(axis));
    }
}

/// Both roots of a t^2 + 2 b t + c = 0, none where they are not real.
std::optional<std::array<double, 2>> roots(double a, double b, double c) {
  const double inside = b * b - a * c;
  if (a == 0 || inside < 0) return std::nullopt;
  const double root = std::sqrt(inside);
  return std::array{(-b - root) / a, (-b + root) / a};
}

/// A sphere around `center`; only the part whose z relative to the centre has the sign of `half`, or all where it is 0.
void castSphere(Ray& ray, const Vec3& center, double radius, double half) {
  const Vec3 o = ray.from - center;
  if (const auto both = roots(1, o.dot(ray.direction), o.squaredNorm() - radius * radius))
    for (const double t : *both)
      if (const Vec3 p = ray.at(t) - center; p.z() * half >= 0) ray.take(t, p / radius);
}

/// The mantle of a cylinder along z.
void castTube(Ray& ray, double radius, double halfLength) {
  const Vec3 &o = ray.from, &d = ray.direction;
  const double a = d.x() * d.x() + d.y() * d.y(), b = o.x() * d.x() + o.y() * d.y(),
               c = o.x() * o.x() + o.y() * o.y() - radius * radius;
  if (const auto both = roots(a, b, c))
    for (const double t : *both)
      if (const Vec3 p = ray.at(t); std::abs(p.z()) <= halfLength) ray.take(t, Vec3(p.x(), p.y(), 0) / radius);
}

void castDisks(Ray& ray, double radius, double halfLength) {
  for (const double side : {-1.0, 1.0}) {
    const double t = (side * halfLength - ray.from.z()) / ray.direction.z();
    if (ray.at(t).head<2>().squaredNorm() <= radius * radius) ray.take(t, side * Vec3::UnitZ());
  }
}

Vec3 vertexOf(const ShapeDescription& s, std::size_t corner) {
  const double* v = &s.vertices[std::size_t{3} * s.triangles[corner]];
  return {v[0], v[1], v[2]};
}

/// Moeller and Trumbore 1997, "Fast, minimum storage ray/triangle intersection".
void castTriangle(Ray& ray, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, p = ray.direction.cross(ac);
  const double determinant = ab.dot(p);
  if (determinant == 0) return;
  const Vec3 o = ray.from - a, q = o.cross(ab);
  const double u = o.dot(p) / determinant, v = ray.direction.dot(q) / determinant;
  if (u >= 0 && v >= 0 && u + v <= 1) ray.take(ac.dot(q) / determinant, ab.cross(ac).normalized());
}

void cast(Ray& ray, const ShapeDescription& s) {
  switch (s.shape) {
    case Shape::box:
      return castBox(ray, s.lengths / 2);
    case Shape::sphere:
      return castSphere(ray, Vec3::Zero(), s.radius, 0);
    case Shape::capsule:
      castTube(ray, s.radius, s.length / 2);
      for (const double side : {-1.0, 1.0}) castSphere(ray, {0, 0, side * s.length / 2}, s.radius, side);
      return;
    case Shape::cylinder:
      castTube(ray, s.radius, s.length / 2);
      return castDisks(ray, s.radius, s.length / 2);
    case Shape::plane: {
      const Vec3 normal(s.plane[0], s.plane[1], s.plane[2]);
      return ray.take((s.plane[3] - normal.dot(ray.from)) / normal.dot(ray.direction), normal.normalized());
    }
    case Shape::mesh:
      for (std::size_t i = 0; i + 2 < s.triangles.size(); i += 3)
        castTriangle(ray, vertexOf(s, i), vertexOf(s, i + 1), vertexOf(s, i + 2));
      return;
    case Shape::ray:
      return;
  }
}

/// Radius of a sphere around the shape's origin that holds it [m]; infinite for planes, and for meshes, which would
/// have to be measured.
double reach(const ShapeDescription& s) {
  switch (s.shape) {
    case Shape::box:
      return s.lengths.norm() / 2;
    case Shape::sphere:
      return s.radius;
    case Shape::capsule:
      return s.radius + s.length / 2;
    case Shape::cylinder:
      return std::hypot(s.radius, s.length / 2);
    default:
      return HUGE_VAL;
  }
}

/// Distance from a point to a triangle: to its plane where the point is above it, else to the nearest edge.
double distanceToTriangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = (b - a).cross(c - a).normalized();
  const auto toEdge = [&](const Vec3& from, const Vec3& to) {
    const Vec3 edge = to - from;
    return (p - from - std::clamp(edge.dot(p - from) / edge.squaredNorm(), 0.0, 1.0) * edge).norm();
  };
  const auto inside = [&](const Vec3& from, const Vec3& to) { return normal.dot((to - from).cross(p - from)) >= 0; };
  if (inside(a, b) && inside(b, c) && inside(c, a)) return std::abs(normal.dot(p - a));
  return std::min({toEdge(a, b), toEdge(b, c), toEdge(c, a)});
}

bool isQueried(const engine::Geom& g) { return g.collides && g.shape.shape != Shape::ray; }

}  // namespace

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
    // The sphere around the shape must come near enough to the ray.
    const Vec3 to = pose.position - from;
    const double r = reach(g.shape), along = std::clamp(to.dot(direction), 0.0, nearest.distance);
    if ((to - along * direction).squaredNorm() > r * r) continue;
    if (accepts && !accepts(g)) continue;
    const Mat3 toShape = pose.rotation.transpose();
    Ray ray{toShape * -to, toShape * direction, nearest.distance};
    cast(ray, g.shape);
    if (ray.hit) nearest = {i, ray.nearest, pose.rotation * ray.normal};
  }
  if (nearest.geom == engine::kNone) return std::nullopt;
  return nearest;
}

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
    case Shape::mesh: {
      double nearest = HUGE_VAL;
      for (std::size_t i = 0; i + 2 < s.triangles.size(); i += 3)
        nearest = std::min(nearest, distanceToTriangle(p, vertexOf(s, i), vertexOf(s, i + 1), vertexOf(s, i + 2)));
      return nearest;
    }
    case Shape::ray:
      break;
  }
  return HUGE_VAL;
}

void findOverlaps(const engine::Model& model, const engine::State& state, const Vec3& center, double radius,
                  std::vector<Index>& out) {
  for (Index i = 0; i < model.geoms.size(); ++i) {
    const engine::Geom& g = model.geoms[i];
    if (!isQueried(g)) continue;
    const Pose pose = poseOf(model, state, i);
    const Vec3 to = center - pose.position;
    if (to.norm() > reach(g.shape) + radius) continue;
    if (distanceTo(g.shape, pose.rotation.transpose() * to) <= radius) out.push_back(i);
  }
}

}  // namespace spark::physics
