#include "convex_hull.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

namespace spark::ode {

namespace {
/// Corners within this fraction of the hull's size belong to the plane of a face.
constexpr double kFlat = 1e-6;
/// Sine of the angle up to which an edge of a face goes straight on.
constexpr double kStraight = 1e-9;

/// Finds the corners of a plane, which touches the hull: from one to the next, for all that are above a plane are
/// connected by edges of the hull. So a face takes the time of its corners and their neighbours, not that of the hull.
class PlaneSearch {
 public:
  explicit PlaneSearch(const engine::Mesh& m)
      : mesh_(m), trianglesAt_(m.vertices.size() / 3), seen_(m.vertices.size() / 3) {
    for (std::size_t i = 0; i < m.triangles.size(); ++i)
      trianglesAt_[m.triangles[i]].push_back(static_cast<std::uint32_t>(i / 3));
  }
  const std::vector<std::uint32_t>& trianglesAt(std::uint32_t corner) const { return trianglesAt_[corner]; }
  /// The corners whose height over the plane, which is that of triangle `t`, is at most `tolerance`, in order.
  template <class Height>
  const std::vector<std::uint32_t>& find(std::size_t t, const Height& height, double tolerance) {
    found_.clear();
    ++round_;
    push(t);
    while (!waiting_.empty()) {
      const std::uint32_t v = waiting_.back();
      waiting_.pop_back();
      const double h = height(v);
      if (h < -tolerance) continue;
      if (h <= tolerance) found_.push_back(v);
      for (const std::uint32_t next : trianglesAt_[v]) push(next);
    }
    std::sort(found_.begin(), found_.end());
    return found_;
  }

 private:
  void push(std::size_t triangle) {
    for (std::size_t k = 3 * triangle; k < 3 * triangle + 3; ++k)
      if (const std::uint32_t v = mesh_.triangles[k]; std::exchange(seen_[v], round_) != round_) waiting_.push_back(v);
  }
  const engine::Mesh& mesh_;
  std::vector<std::vector<std::uint32_t>> trianglesAt_;
  std::vector<std::uint32_t> seen_, waiting_, found_;
  std::uint32_t round_ = 0;
};
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
  PlaneSearch search(m);
  std::vector<std::uint8_t> done(m.triangles.size() / 3, 0);
  for (std::size_t t = 0; t < done.size(); ++t) {
    if (done[t]) continue;
    const auto at = [&](std::size_t k) { return corner(m.triangles[3 * t + k]); };
    const Vec3 across = (at(1) - at(0)).cross(at(2) - at(0));
    if (!(across.norm() > 1e-12 * size * size)) continue;  // without area: its neighbours have its corners
    const Vec3 normal = across.normalized();
    const double offset = normal.dot(at(0));
    const auto height = [&](std::uint32_t v) { return normal.dot(corner(v)) - offset; };
    const auto isIn = [&](std::uint32_t v) { return std::abs(height(v)) <= kFlat * size; };
    const std::vector<std::uint32_t>& corners = search.find(t, height, kFlat * size);
    for (const std::uint32_t v : corners)
      for (const std::uint32_t other : search.trianglesAt(v))
        if (isIn(m.triangles[3 * other]) && isIn(m.triangles[3 * other + 1]) && isIn(m.triangles[3 * other + 2]))
          done[other] = 1;
    addFace(normal, offset, corners);
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

void ConvexHull::addFace(const Vec3& normal, double offset, const std::vector<std::uint32_t>& corners) {
  Face face{normal, offset, corners};
  Vec3 middle = Vec3::Zero();
  for (const std::uint32_t i : corners) middle += corner(i);
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
