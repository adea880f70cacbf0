#include "hull.h"

#include <libqhull_r/qhull_ra.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

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
  return out;
}

}  // namespace spark::meshes
