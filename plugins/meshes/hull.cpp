#include "hull.h"

#include <libqhull_r/qhull_ra.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numeric>
#include <span>

#include "spark/error.h"

namespace spark::meshes {

namespace {

constexpr std::uint32_t kUnused = UINT32_MAX;

/// One run of Qhull. Its facets are triangles.
class Hull {
 public:
  Hull() : messages_(std::tmpfile(), std::fclose) { qh_zero(&qh_, messages_.get()); }
  ~Hull() {
    qh_freeqhull(&qh_, qh_ALL);
    int now = 0, total = 0;
    qh_memfreeshort(&qh_, &now, &total);
  }
  Hull(const Hull&) = delete;
  Hull& operator=(const Hull&) = delete;

  /// Throws Error if the points lie in a plane. They must outlive the run.
  void run(std::vector<double>& points) {
    char command[] = "qhull Qt";
    const int count = static_cast<int>(points.size() / 3);
    if (qh_new_qhull(&qh_, 3, count, points.data(), False, command, nullptr, messages_.get()) != 0)
      throw Error(fmt::format("expected vertices that span a volume, found {} that do not", count));
  }
  /// Indices of points, three for each triangle, which point outwards.
  std::vector<std::uint32_t> triangles() {
    std::vector<std::uint32_t> out;
    qhT* const qh = &qh_;  // the name that Qhull's macros use
    for (const facetT* facet = qh->facet_list; facet && facet->next; facet = facet->next) {
      std::uint32_t corners[3];
      for (int i = 0; i < 3; ++i) {
        const auto* const vertex = static_cast<const vertexT*>(facet->vertices->e[i].p);
        corners[i] = static_cast<std::uint32_t>(qh_pointid(qh, vertex->point));
      }
      if (facet->toporient != qh_ORIENTclock) std::swap(corners[1], corners[2]);
      out.insert(out.end(), corners, corners + 3);
    }
    return out;
  }

 private:
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> messages_;
  qhT qh_{};
};

/// The mean of its vertices.
Vec3 middleOf(const engine::Mesh& m) {
  Vec3 out = Vec3::Zero();
  const std::size_t count = m.vertices.size() / 3;
  for (std::size_t i = 0; i < count; ++i) out += m.vertex(i) / static_cast<double>(count);
  return out;
}

/// Of the solids between a point and each triangle, whichever of its sides looks there.
double volumeAround(const Vec3& point, const engine::Mesh& m) {
  double sum = 0;
  for (std::size_t t = 0; t + 2 < m.triangles.size(); t += 3) {
    Mat3 c;
    for (int i = 0; i < 3; ++i) c.col(i) = m.vertex(m.triangles[t + static_cast<std::size_t>(i)]) - point;
    sum += std::abs(c.determinant()) / 6;
  }
  return sum;
}

/// For each vertex the number of one at its place, the same for all that are there.
std::vector<std::uint32_t> placesOf(const engine::Mesh& m) {
  std::vector<std::uint32_t> order(m.vertices.size() / 3), out(order.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto at = [&](std::uint32_t v) { return std::span(m.vertices).subspan(3 * std::size_t{v}, 3); };
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return std::ranges::lexicographical_compare(at(a), at(b)); });
  for (std::size_t i = 0; i < order.size(); ++i)
    out[order[i]] = i > 0 && std::ranges::equal(at(order[i]), at(order[i - 1])) ? out[order[i - 1]] : order[i];
  return out;
}

}  // namespace

engine::Mesh hullOf(std::vector<double> points) {
  if (!std::all_of(points.begin(), points.end(), [](double v) { return std::isfinite(v); }))
    throw Error("expected vertices of finite numbers");
  if (points.size() < 12)
    throw Error(fmt::format("expected at least 4 vertices of a volume, found {}", points.size() / 3));
  engine::Mesh out;
  Hull hull;
  hull.run(points);
  out.triangles = hull.triangles();
  // The vertices that no triangle has are dropped.
  std::vector<std::uint32_t> place(points.size() / 3, kUnused);
  for (const std::uint32_t v : out.triangles) place[v] = 0;
  std::uint32_t used = 0;
  for (std::size_t i = 0; i < place.size(); ++i) {
    if (place[i] == kUnused) continue;
    place[i] = used++;
    out.vertices.insert(out.vertices.end(), points.begin() + 3 * std::ptrdiff_t(i),
                        points.begin() + 3 * std::ptrdiff_t(i) + 3);
  }
  for (std::uint32_t& v : out.triangles) v = place[v];
  // Smaller ones have no place in engines: MuJoCo takes none of less than 1e-15 m^3.
  constexpr double kLeast = 1e-14;
  if (const double volume = volumeAround(middleOf(out), out); volume < kLeast)
    throw Error(
        fmt::format("expected vertices that span at least {} m^3, found {:.3g}: are they in metres?", kLeast, volume));
  return out;
}

bool hasArea(const engine::Mesh& surface) {
  double twice = 0;
  for (std::size_t t = 0; t + 2 < surface.triangles.size(); t += 3) {
    const auto at = [&](std::size_t i) { return surface.vertex(surface.triangles[t + i]); };
    twice += (at(1) - at(0)).cross(at(2) - at(0)).norm();
  }
  return twice > 2e-6;
}

bool isConvex(const engine::Mesh& surface, const engine::Mesh& hull) {
  const Vec3 middle = middleOf(hull);
  const double whole = volumeAround(middle, hull);
  return std::abs(volumeAround(middle, surface) - whole) < 1e-3 * whole;
}

bool isClosed(const engine::Mesh& surface) {
  const std::vector<std::uint32_t> place = placesOf(surface);
  using Edge = std::pair<std::uint32_t, std::uint32_t>;
  std::vector<Edge> rising, falling;  // edges by the order of their ends, each as the rising one
  for (std::size_t t = 0; t + 2 < surface.triangles.size(); t += 3)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t from = place[surface.triangles[t + i]], to = place[surface.triangles[t + (i + 1) % 3]];
      if (from < to) rising.emplace_back(from, to);
      if (to < from) falling.emplace_back(to, from);
    }
  std::sort(rising.begin(), rising.end());
  std::sort(falling.begin(), falling.end());
  return !rising.empty() && rising == falling;
}

}  // namespace spark::meshes
