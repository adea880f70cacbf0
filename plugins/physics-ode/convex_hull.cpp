#include "convex_hull.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace spark::ode {

namespace {
/// Corners within this fraction of the hull's size belong to the plane of a face.
constexpr double kFlat = 1e-6;
/// Sine of the angle up to which an edge of a face goes straight on.
constexpr double kStraight = 1e-9;
}  // namespace

ConvexHull::ConvexHull(std::shared_ptr<const engine::Mesh> mesh) : mesh_(std::move(mesh)) {
  const engine::Mesh& m = *mesh_;
  const std::size_t count = m.vertices.size() / 3;
  for (std::size_t i = 0; i < count; ++i) center_ += m.vertex(i) / static_cast<double>(count);
  double size = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 v = m.vertex(i) - center_;
    corners_.insert(corners_.end(), {v.x(), v.y(), v.z()});
    size = std::max(size, v.norm());
  }

  // The triangles of a plane make one face.
  std::vector<std::uint8_t> done(m.triangles.size() / 3, 0);
  for (std::size_t t = 0; t < done.size(); ++t) {
    if (done[t]) continue;
    const auto at = [&](std::size_t k) { return corner(m.triangles[3 * t + k]); };
    const Vec3 across = (at(1) - at(0)).cross(at(2) - at(0));
    if (!(across.norm() > 1e-12 * size * size)) continue;  // without area: its neighbours have its corners
    const Vec3 normal = across.normalized();
    const double offset = normal.dot(at(0));
    addFace(normal, offset, kFlat * size);
    const auto isIn = [&](std::uint32_t v) { return std::abs(normal.dot(corner(v)) - offset) <= kFlat * size; };
    for (std::size_t other = t; other < done.size(); ++other)
      if (!done[other] && isIn(m.triangles[3 * other]) && isIn(m.triangles[3 * other + 1]) &&
          isIn(m.triangles[3 * other + 2]))
        done[other] = 1;
  }
}

bool ConvexHull::makeConvex(Face& face) const {
  std::vector<std::uint32_t>& c = face.corners;
  const auto at = [&](std::size_t i) { return c[i % c.size()]; };
  // Corners of neighbouring faces, in this plane but for noise, may be inside of it or on its edges.
  const auto turnsRight = [&](std::size_t i) {
    const Vec3 before = corner(at(i + 1)) - corner(at(i)), after = corner(at(i + 2)) - corner(at(i + 1));
    return before.cross(after).dot(face.normal) <= kStraight * before.norm() * after.norm();
  };
  for (std::size_t i = 0, convex = 0; c.size() >= 3 && convex < c.size();) {
    if (!turnsRight(i)) {
      ++convex, i = (i + 1) % c.size();
      continue;
    }
    c.erase(c.begin() + static_cast<std::ptrdiff_t>((i + 1) % c.size()));
    // The corner before the removed one turns elsewhere now.
    convex = 0, i = c.empty() ? 0 : (i + c.size() - 1) % c.size();
  }
  // ODE takes the first three for those that say how the face is turned, seen from the centre.
  const auto volume = [&](std::size_t i) { return corner(at(i)).dot(corner(at(i + 1)).cross(corner(at(i + 2)))); };
  for (std::size_t i = 0; c.size() >= 3 && i < c.size(); ++i) {
    if (!(volume(i) > 0)) continue;
    std::rotate(c.begin(), c.begin() + static_cast<std::ptrdiff_t>(i), c.end());
    return true;
  }
  return false;
}

void ConvexHull::addFace(const Vec3& normal, double offset, double tolerance) {
  Face face{normal, offset, {}};
  Vec3 middle = Vec3::Zero();
  for (std::uint32_t i = 0; 3 * i < corners_.size(); ++i) {
    if (std::abs(normal.dot(corner(i)) - offset) > tolerance) continue;
    face.corners.push_back(i);
    middle += corner(i);
  }
  if (face.corners.size() < 3) return;
  middle /= static_cast<double>(face.corners.size());
  const Vec3 x = normal.unitOrthogonal(), y = normal.cross(x);
  const auto angle = [&](std::uint32_t i) {
    const Vec3 v = corner(i) - middle;
    return std::atan2(y.dot(v), x.dot(v));
  };
  std::sort(face.corners.begin(), face.corners.end(),
            [&](std::uint32_t a, std::uint32_t b) { return angle(a) < angle(b); });
  if (!makeConvex(face)) return;
  planes_.insert(planes_.end(), {normal.x(), normal.y(), normal.z(), offset});
  polygons_.push_back(static_cast<unsigned>(face.corners.size()));
  polygons_.insert(polygons_.end(), face.corners.begin(), face.corners.end());
  faces_.push_back(std::move(face));
}

}  // namespace spark::ode
