#include "cone.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "height_field.h"
#include "queries.h"
#include "shape_ray.h"

namespace spark::physics {

using engine::Shape;
using engine::ShapeDescription;

namespace {

constexpr int kSides = 64;  // of the prism in place of a cylinder

/// The point of a triangle that is nearest to the origin (Ericson 2005, "Real-Time Collision Detection",
/// section 5.1.5).
Vec3 nearestOf(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a;
  const double d1 = -ab.dot(a), d2 = -ac.dot(a);
  if (d1 <= 0 && d2 <= 0) return a;
  const double d3 = -ab.dot(b), d4 = -ac.dot(b);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0 && d1 > d3) return a + d1 / (d1 - d3) * ab;
  const double d5 = -ab.dot(c), d6 = -ac.dot(c);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0 && d2 > d6) return a + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0 && d4 - d3 + d5 - d6 > 0)
    return b + (d4 - d3) / (d4 - d3 + d5 - d6) * (c - b);
  const double sum = va + vb + vc;
  return sum != 0 ? Vec3(a + vb / sum * ab + vc / sum * ac) : a;
}

/// Collects the nearest point. All points are relative to the apex.
class Search {
 public:
  explicit Search(const Cone& cone) : cone_(cone), nearest_(cone.range) {}
  std::optional<Vec3> result() const { return found_; }
  double nearest() const { return nearest_; }
  void take(const Vec3& p) {
    const double d = p.norm();
    if (!(d <= nearest_)) return;
    nearest_ = d;
    found_ = p;
  }
  void triangle(const Vec3& a, const Vec3& b, const Vec3& c);
  void sphere(const Vec3& center, double radius);
  void plane(const Vec3& normal, double distance);

 private:
  void edge(const Vec3& a, const Vec3& b);
  const Cone& cone_;
  double nearest_;
  std::optional<Vec3> found_;
};

/// A triangle's nearest point in the cone is its nearest point of all, or on an edge, or where the side of the cone
/// that leans most to the triangle's plane meets that plane: on the curve in which they meet the distance has no other
/// minimum.
void Search::triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 q = nearestOf(a, b, c);
  if (q.norm() > nearest_) return;
  if (cone_.contains(q)) return take(q);
  edge(a, b), edge(b, c), edge(c, a);
  Vec3 normal = (b - a).cross(c - a);
  if (normal.isZero(0)) return;
  normal.normalize();
  if (normal.dot(a) < 0) normal = -normal;
  const Vec3 side = cone_.nearestTo(normal);
  const double towards = normal.dot(side);
  if (!(towards > 1e-12)) return;
  const Vec3 p = normal.dot(a) / towards * side;
  const double s1 = normal.dot((b - a).cross(p - a)), s2 = normal.dot((c - b).cross(p - b)),
               s3 = normal.dot((a - c).cross(p - c));
  if ((s1 >= 0 && s2 >= 0 && s3 >= 0) || (s1 <= 0 && s2 <= 0 && s3 <= 0)) take(p);
}

/// The parts of an edge that are in the cone are between its ends and the points in which it meets the cone's side.
void Search::edge(const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const double length = d.squaredNorm();
  const double along = length > 0 ? std::clamp(-a.dot(d) / length, 0.0, 1.0) : 0;
  if ((a + along * d).norm() > nearest_) return;
  // (p axis)^2 = cosine^2 p p
  const double c2 = cone_.cosine * cone_.cosine, ax = a.dot(cone_.axis), dx = d.dot(cone_.axis);
  const double qa = dx * dx - c2 * length, qb = ax * dx - c2 * a.dot(d), qc = ax * ax - c2 * a.squaredNorm();
  const auto inside = [](double t) { return t > 0 && t < 1 ? t : 1; };
  double first = 1, second = 1;
  if (qa == 0) {
    if (qb != 0) first = inside(-qc / (2 * qb));
  } else if (const double square = qb * qb - qa * qc; square >= 0) {
    const double root = std::sqrt(square);
    first = inside((-qb - root) / qa), second = inside((-qb + root) / qa);
  }
  const std::array<double, 4> at{0, std::min(first, second), std::max(first, second), 1};
  for (std::size_t i = 0; i < 3; ++i)
    if (cone_.contains(a + (at[i] + at[i + 1]) / 2 * d)) take(a + std::clamp(along, at[i], at[i + 1]) * d);
}

/// In the cone's direction that is nearest to the centre.
void Search::sphere(const Vec3& center, double radius) {
  const Vec3 u = cone_.nearestTo(center);
  const double along = u.dot(center), inside = along * along - center.squaredNorm() + radius * radius;
  if (inside >= 0 && along > 0) take(std::max(along - std::sqrt(inside), 0.0) * u);
}

/// The plane normal p = distance, with the apex on its outer side.
void Search::plane(const Vec3& normal, double distance) {
  const Vec3 u = cone_.nearestTo(-normal);
  const double towards = normal.dot(u);
  if (distance / towards >= 0) take(distance / towards * u);
}

/// A cylinder along z, with or without its ends.
void tube(Search& search, const Cone& cone, double radius, double length, bool ends) {
  const double first = std::atan2(cone.apex.y(), cone.apex.x());
  const auto corner = [&](int i, double z) -> Vec3 {
    const double angle = first + 2 * kPi * i / kSides;
    return Vec3(radius * std::cos(angle), radius * std::sin(angle), z) - cone.apex;
  };
  const double h = length / 2;
  for (int i = 0; i < kSides; ++i) {
    const Vec3 a = corner(i, -h), b = corner(i + 1, -h), c = corner(i + 1, h), d = corner(i, h);
    search.triangle(a, b, c), search.triangle(a, c, d);
    if (!ends) continue;
    search.triangle(a, b, Vec3(0, 0, -h) - cone.apex), search.triangle(d, c, Vec3(0, 0, h) - cone.apex);
  }
}

void box(Search& search, const Cone& cone, const Vec3& half) {
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      const int j = (axis + 1) % 3, k = (axis + 2) % 3;
      const auto corner = [&](double u, double v) {
        Vec3 p;
        p[axis] = side * half[axis], p[j] = u * half[j], p[k] = v * half[k];
        return Vec3(p - cone.apex);
      };
      search.triangle(corner(-1, -1), corner(1, -1), corner(1, 1));
      search.triangle(corner(-1, -1), corner(1, 1), corner(-1, 1));
    }
}

/// All cells that are within range.
void heightField(Search& search, const Cone& cone, const engine::HeightField& f) {
  const auto cells = [&](double at, double size, double cell, int count) {
    const auto number = [&](double v) {
      return static_cast<int>(std::clamp(std::floor((v + size / 2) / cell), 0.0, double(count - 1)));
    };
    return std::pair(number(at - cone.range), number(at + cone.range));
  };
  const auto [left, right] = cells(cone.apex.x(), f.width, f.cellWidth(), f.columns - 1);
  const auto [near, far] = cells(cone.apex.y(), f.depth, f.cellDepth(), f.rows - 1);
  for (int row = near; row <= far; ++row)
    for (int column = left; column <= right; ++column)
      for (const bool second : {false, true}) {
        const auto [a, b, c] = triangleOf(f, column, row, second);
        search.triangle(a - cone.apex, b - cone.apex, c - cone.apex);
      }
}

/// Searches in spheres that grow: most triangles of a large mesh are far away.
void mesh(Search& search, const Cone& cone, const engine::Mesh& m, const NearTriangles& near) {
  const auto visit = [&](std::uint32_t i) {
    search.triangle(cornerOf(m, 3 * i) - cone.apex, cornerOf(m, 3 * i + 1) - cone.apex,
                    cornerOf(m, 3 * i + 2) - cone.apex);
  };
  for (double radius = cone.range / 64; search.nearest() > radius / 2; radius *= 2) {
    near(cone.apex, std::min(radius, cone.range), std::cref(visit));  // a copy would allocate
    if (radius >= cone.range) return;
  }
}

}  // namespace

Vec3 Cone::nearestTo(const Vec3& v) const {
  if (contains(v)) return v.normalized();
  Vec3 aside = v - v.dot(axis) * axis;
  aside = aside.isZero(1e-15) ? axis.unitOrthogonal() : aside.normalized();
  return cosine * axis + sine * aside;
}

std::optional<Vec3> nearestInCone(const ShapeDescription& s, const Cone& cone, const NearTriangles& near) {
  if (s.shape != Shape::mesh && s.shape != Shape::heightField && distanceTo(s, cone.apex) <= 0) return Vec3::Zero();
  Search search(cone);
  switch (s.shape) {
    case Shape::box:
      box(search, cone, s.lengths / 2);
      break;
    case Shape::sphere:
      search.sphere(-cone.apex, s.radius);
      break;
    case Shape::capsule:
      tube(search, cone, s.radius, s.length, false);
      for (const double side : {-1.0, 1.0}) search.sphere(Vec3(0, 0, side * s.length / 2) - cone.apex, s.radius);
      break;
    case Shape::cylinder:
      tube(search, cone, s.radius, s.length, true);
      break;
    case Shape::plane: {
      const Vec3 normal(s.plane[0], s.plane[1], s.plane[2]);
      search.plane(normal.normalized(), (s.plane[3] - normal.dot(cone.apex)) / normal.norm());
      break;
    }
    case Shape::mesh:
    case Shape::convex:
      mesh(search, cone, *s.mesh, near);
      break;
    case Shape::heightField:
      heightField(search, cone, *s.heightField);
      break;
    case Shape::ray:
      break;
  }
  return search.result();
}

void spreadPoints(const ShapeDescription& s, std::vector<Vec3>& out) {
  constexpr double kWithin = 0.98;  // of a size: rays to an edge may miss it
  constexpr int kAlong = 8;         // steps along a post
  constexpr std::size_t kMost = 128;
  const auto grid = [&](const Vec3& half) {
    for (const double z : {-1.0, 0.0, 1.0})
      for (const double y : {-1.0, 0.0, 1.0})
        for (const double x : {-1.0, 0.0, 1.0}) out.push_back(kWithin * half.cwiseProduct(Vec3(x, y, z)));
  };
  switch (s.shape) {
    case Shape::box:
      return grid(s.lengths / 2);
    case Shape::sphere:
      return grid(Vec3::Constant(s.radius / std::sqrt(3.0)));
    case Shape::capsule:
    case Shape::cylinder: {
      const double half = s.length / 2 + (s.shape == Shape::capsule ? s.radius : 0);
      for (int i = 0; i <= kAlong; ++i)
        for (const double side : {-1.0, 0.0, 1.0}) {
          const Vec3 at(0, 0, kWithin * half * (2.0 * i / kAlong - 1));
          out.push_back(at + Vec3(side * s.radius / 2, 0, 0));
          if (side != 0) out.push_back(at + Vec3(0, side * s.radius / 2, 0));
        }
      return;
    }
    case Shape::mesh:
    case Shape::convex: {
      const std::size_t count = s.mesh->triangles.size() / 3, step = count / kMost + 1;
      for (std::size_t i = 0; i < count; i += step)
        out.push_back((cornerOf(*s.mesh, 3 * i) + cornerOf(*s.mesh, 3 * i + 1) + cornerOf(*s.mesh, 3 * i + 2)) / 3);
      return;
    }
    default:
      return;  // rings of rays meet what is so large
  }
}

}  // namespace spark::physics
