#include "shape_ray.h"

#include <Eigen/Geometry>
#include <array>
#include <optional>

#include "height_field.h"

namespace spark::physics {

using engine::Shape;
using engine::ShapeDescription;

namespace {

void castBox(ShapeRay& ray, const Vec3& half) {
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
void castSphere(ShapeRay& ray, const Vec3& center, double radius, double half) {
  const Vec3 o = ray.from - center;
  if (const auto both = roots(1, o.dot(ray.direction), o.squaredNorm() - radius * radius))
    for (const double t : *both)
      if (const Vec3 p = ray.at(t) - center; p.z() * half >= 0) ray.take(t, p / radius);
}

/// The mantle of a cylinder along z.
void castTube(ShapeRay& ray, double radius, double halfLength) {
  const Vec3 &o = ray.from, &d = ray.direction;
  const double a = d.x() * d.x() + d.y() * d.y(), b = o.x() * d.x() + o.y() * d.y(),
               c = o.x() * o.x() + o.y() * o.y() - radius * radius;
  if (const auto both = roots(a, b, c))
    for (const double t : *both)
      if (const Vec3 p = ray.at(t); std::abs(p.z()) <= halfLength) ray.take(t, Vec3(p.x(), p.y(), 0) / radius);
}

void castDisks(ShapeRay& ray, double radius, double halfLength) {
  for (const double side : {-1.0, 1.0}) {
    const double t = (side * halfLength - ray.from.z()) / ray.direction.z();
    if (ray.at(t).head<2>().squaredNorm() <= radius * radius) ray.take(t, side * Vec3::UnitZ());
  }
}

}  // namespace

/// Moeller and Trumbore 1997, "Fast, minimum storage ray/triangle intersection".
void castTriangle(ShapeRay& ray, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, p = ray.direction.cross(ac);
  const double determinant = ab.dot(p);
  if (determinant == 0) return;
  const Vec3 o = ray.from - a, q = o.cross(ab);
  const double u = o.dot(p) / determinant, v = ray.direction.dot(q) / determinant;
  if (u >= 0 && v >= 0 && u + v <= 1) ray.take(ac.dot(q) / determinant, ab.cross(ac).normalized());
}

void castTriangle(ShapeRay& ray, const engine::Mesh& mesh, std::size_t triangle) {
  castTriangle(ray, cornerOf(mesh, 3 * triangle), cornerOf(mesh, 3 * triangle + 1), cornerOf(mesh, 3 * triangle + 2));
}

void castShape(ShapeRay& ray, const ShapeDescription& s) {
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
    case Shape::convex:
      for (std::size_t i = 0; i < s.mesh->triangles.size() / 3; ++i) castTriangle(ray, *s.mesh, i);
      return;
    case Shape::heightField:
      return castHeightField(ray, *s.heightField);
    case Shape::ray:
      return;
  }
}

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

}  // namespace spark::physics
