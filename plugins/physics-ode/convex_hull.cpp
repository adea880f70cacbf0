#include "convex_hull.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace spark::ode {

namespace {
/// Corners within this fraction of the hull's size belong to the plane of a face.
constexpr double kFlat = 1e-6;
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
  planes_.insert(planes_.end(), {normal.x(), normal.y(), normal.z(), offset});
  polygons_.push_back(static_cast<unsigned>(face.corners.size()));
  polygons_.insert(polygons_.end(), face.corners.begin(), face.corners.end());
  faces_.push_back(std::move(face));
}

}  // namespace spark::ode
