#include "mesh_pieces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>

#include "meshes/hull.h"
#include "spark/error.h"

// 1  Corners in the same place become one, and triangles that share an edge a part.
// 2  A part that encloses as much as its hull is convex: one piece.
// 3  In the others, polygons grow from triangles: two in one plane that share an edge become one while it stays convex
//    (Hertel and Mehlhorn 1983, "Fast triangulation of the plane with respect to simple polygons").
// 4  A polygon becomes a plate: its corners, and the same behind the surface.
//
//          ____________
//         |____________|  <- plates of a slab with a hole, seen from the side
//         |__|      |__|

namespace spark::mujoco {

namespace {

using Index = std::uint32_t;

constexpr double kThickness = 0.01;            // m
constexpr double kLeastVolume = 1e-13;         // m^3: MuJoCo takes none of less than 1e-15
constexpr double kThinnest = 1e-4;             // m
constexpr double kFlat = 1e-6;                 // of the size of a mesh: what is nearer to a plane is in it
constexpr std::size_t kMostRays = 50'000'000;  // pairs of a ray and a triangle

using Loop = std::vector<Index>;  ///< corners of a polygon, counter-clockwise seen from outside

/// The edges of triangles, each in the direction in which its triangle has it.
struct Edges {
  using Edge = std::pair<Index, Index>;
  std::map<Edge, std::size_t> owner;  ///< which triangle has an edge; none of an edge that several have
  std::vector<Edge> all;              ///< in the order of the triangles
  explicit Edges(const std::vector<Loop>& triangles) {
    std::vector<Edge> twice;
    for (std::size_t t = 0; t < triangles.size(); ++t)
      for (std::size_t i = 0; i < 3; ++i) {
        const Edge edge{triangles[t][i], triangles[t][(i + 1) % 3]};
        (owner.emplace(edge, t).second ? all : twice).push_back(edge);
      }
    for (const Edge& edge : twice) owner.erase(edge);
  }
};

class Surface {
 public:
  explicit Surface(const engine::Mesh& mesh) {
    std::map<std::array<double, 3>, Index> known;
    std::vector<Index> corner(mesh.vertices.size() / 3);
    for (std::size_t i = 0; i < corner.size(); ++i) {
      const Vec3 v = mesh.vertex(i);
      const auto [at, isNew] = known.try_emplace({v.x(), v.y(), v.z()}, static_cast<Index>(corners_.size()));
      if (isNew) corners_.push_back(v);
      corner[i] = at->second;
    }
    Vec3 low = Vec3::Constant(HUGE_VAL), high = -low;
    for (const Vec3& v : corners_) low = low.cwiseMin(v), high = high.cwiseMax(v);
    size_ = (high - low).norm();
    for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) {
      const Loop loop{corner[mesh.triangles[t]], corner[mesh.triangles[t + 1]], corner[mesh.triangles[t + 2]]};
      if (across(loop).norm() > kFlat * kFlat * size_ * size_) triangles_.push_back(loop);
    }
  }

  std::vector<Piece> pieces() const {
    std::vector<Piece> out;
    std::vector<Loop> hollow;
    for (const std::vector<Loop>& part : parts())
      if (auto solid = solidOf(part))
        out.push_back(std::move(*solid));
      else
        for (Loop& polygon : polygonsOf(part)) hollow.push_back(std::move(polygon));
    if (out.size() + hollow.size() > kMostPieces) return {};
    const bool many = hollow.size() * triangles_.size() * 4 > kMostRays;
    for (const Loop& polygon : hollow) {
      const double thickness = many || isCovered(polygon) ? kThinnest : depthBehind(polygon);
      if (thickness * acrossAll(polygon).norm() / 2 > kLeastVolume) out.push_back(plate(polygon, thickness));
    }
    return out;
  }

 private:
  Vec3 across(const Loop& l) const { return (at(l[1]) - at(l[0])).cross(at(l[2]) - at(l[0])); }
  const Vec3& at(Index i) const { return corners_[i]; }

  /// The triangles, grouped by which share an edge that no others have, in the order of the first ones.
  std::vector<std::vector<Loop>> parts() const {
    std::vector<std::size_t> root(triangles_.size());
    std::iota(root.begin(), root.end(), std::size_t{0});
    const auto find = [&root](std::size_t i) {
      while (root[i] != i) i = root[i] = root[root[i]];
      return i;
    };
    const Edges edges(triangles_);
    for (const auto& [a, b] : edges.all)
      if (const auto here = edges.owner.find({a, b}), there = edges.owner.find({b, a});
          here != edges.owner.end() && there != edges.owner.end())
        root[find(here->second)] = find(there->second);
    std::map<std::size_t, std::size_t> number;
    std::vector<std::vector<Loop>> out;
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      const auto [entry, isNew] = number.try_emplace(find(t), out.size());
      if (isNew) out.emplace_back();
      out[entry->second].push_back(triangles_[t]);
    }
    return out;
  }

  /// The corners of a part that is convex.
  std::optional<Piece> solidOf(const std::vector<Loop>& part) const {
    engine::Mesh mesh;
    for (const Loop& t : part)
      for (const Index i : t) {
        mesh.triangles.push_back(static_cast<Index>(mesh.vertices.size() / 3));
        mesh.vertices.insert(mesh.vertices.end(), at(i).begin(), at(i).end());
      }
    try {
      engine::Mesh hull = meshes::hullOf(mesh.vertices);
      if (!meshes::isConvex(mesh, hull)) return std::nullopt;
      return std::move(hull.vertices);
    } catch (const Error&) {
      return std::nullopt;  // flat
    }
  }

  /// Convex polygons of the triangles of a part.
  std::vector<Loop> polygonsOf(const std::vector<Loop>& part) const {
    std::vector<Loop> polygons = part;
    Edges edges(part);
    auto& owner = edges.owner;
    for (const auto& [a, b] : edges.all) {
      const auto here = owner.find({a, b}), there = owner.find({b, a});
      if (here == owner.end() || there == owner.end() || here->second == there->second) continue;
      Loop &p = polygons[here->second], &q = polygons[there->second];
      if (!inOnePlane(p, q)) continue;
      // From b around p to a, then around q back to b.
      std::rotate(p.begin(), std::find(p.begin(), p.end(), b), p.end());
      std::rotate(q.begin(), std::find(q.begin(), q.end(), a), q.end());
      if (p.back() != a || q.back() != b) continue;
      Loop both = p;
      both.insert(both.end(), q.begin() + 1, q.end() - 1);
      const Vec3 normal = across(part[here->second]);
      if (!turnsLeft(both, 0, normal) || !turnsLeft(both, p.size() - 1, normal)) continue;
      const std::size_t kept = here->second, gone = there->second;
      for (std::size_t i = 0; i < q.size(); ++i)
        if (const auto moved = owner.find({q[i], q[(i + 1) % q.size()]}); moved != owner.end()) moved->second = kept;
      p = std::move(both);
      polygons[gone].clear();
    }
    std::erase_if(polygons, [](const Loop& l) { return l.empty(); });
    return polygons;
  }
  bool inOnePlane(const Loop& p, const Loop& q) const {
    const Vec3 n = normalOf(p);
    if (n.dot(normalOf(q)) < 0) return false;
    return std::all_of(q.begin(), q.end(),
                       [&](Index i) { return std::abs(n.dot(at(i) - at(p.front()))) < kFlat * size_; });
  }
  /// Along the normal of a polygon, twice as long as its area.
  Vec3 acrossAll(const Loop& l) const {
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 1; i + 1 < l.size(); ++i) sum += (at(l[i]) - at(l[0])).cross(at(l[i + 1]) - at(l[0]));
    return sum;
  }
  Vec3 normalOf(const Loop& l) const { return acrossAll(l).normalized(); }
  /// True if a polygon is convex at its corner `i`.
  bool turnsLeft(const Loop& l, std::size_t i, const Vec3& normal) const {
    const Vec3 in = at(l[i]) - at(l[(i + l.size() - 1) % l.size()]), out = at(l[(i + 1) % l.size()]) - at(l[i]);
    const double turn = normal.normalized().dot(in.cross(out)) / (in.norm() * out.norm());
    return turn > 1e-9 || (turn > -1e-9 && in.dot(out) > 0);
  }

  /// True if triangles that look at the other side lie on a polygon, at its middle.
  bool isCovered(const Loop& polygon) const {
    const Vec3 normal = normalOf(polygon);
    Vec3 middle = Vec3::Zero();
    for (const Index i : polygon) middle += at(i) / static_cast<double>(polygon.size());
    return std::any_of(triangles_.begin(), triangles_.end(), [&](const Loop& t) {
      if (across(t).normalized().dot(normal) > kFlat - 1) return false;
      if (std::abs(normal.dot(at(t[0]) - middle)) > kFlat * size_) return false;
      for (std::size_t k = 0; k < 3; ++k)
        if (normal.dot((at(t[(k + 1) % 3]) - at(t[k])).cross(middle - at(t[k]))) > kFlat * size_ * size_) return false;
      return true;
    });
  }

  /// How far the solid reaches behind a polygon, from its middle and the middles between that and its corners.
  double depthBehind(const Loop& polygon) const {
    const Vec3 along = -normalOf(polygon);
    Vec3 middle = Vec3::Zero();
    for (const Index i : polygon) middle += at(i) / static_cast<double>(polygon.size());
    double nearest = std::min(distance(middle, along), kThickness);
    for (const Index i : polygon) nearest = std::min(nearest, distance((middle + at(i)) / 2, along));
    return std::max(nearest, kThinnest);
  }
  /// To the first triangle of the ray (Moeller and Trumbore 1997, "Fast, Minimum Storage Ray/Triangle Intersection").
  double distance(const Vec3& from, const Vec3& along) const {
    double nearest = HUGE_VAL;
    for (const Loop& t : triangles_) {
      const Vec3 e1 = at(t[1]) - at(t[0]), e2 = at(t[2]) - at(t[0]), p = along.cross(e2);
      const double det = e1.dot(p);
      if (std::abs(det) < 1e-12 * size_ * size_) continue;
      const Vec3 s = from - at(t[0]), q = s.cross(e1);
      const double u = s.dot(p) / det, v = along.dot(q) / det, d = e2.dot(q) / det;
      if (u >= 0 && v >= 0 && u + v <= 1 && d > kFlat * size_) nearest = std::min(nearest, d);
    }
    return nearest;
  }

  Piece plate(const Loop& polygon, double thickness) const {
    const Vec3 behind = -thickness * normalOf(polygon);
    Piece out;
    for (const Vec3& shift : {Vec3(Vec3::Zero()), behind})
      for (const Index i : polygon) {
        const Vec3 v = at(i) + shift;
        out.insert(out.end(), v.begin(), v.end());
      }
    return out;
  }

  std::vector<Vec3> corners_;
  double size_ = 0;
  std::vector<Loop> triangles_;
};

}  // namespace

std::vector<Piece> piecesOf(const engine::Mesh& mesh) { return Surface(mesh).pieces(); }

Vec3 MeshPieces::frontOf(const engine::Geom& geom, std::size_t piece) const {
  const auto found = all_.find(geom.shape.mesh.get());
  if (found == all_.end() || piece >= found->second->pieces.size()) return Vec3::Zero();
  // A plate has the corners of its front, and then the same behind.
  const Piece& p = found->second->pieces[piece];
  if (p.size() % 6 != 0) return Vec3::Zero();
  const std::size_t half = p.size() / 2;
  const auto shift = [&](std::size_t i) { return Vec3(Vec3::Map(&p[i]) - Vec3::Map(&p[half + i])); };
  for (std::size_t i = 3; i < half; i += 3)
    if ((shift(i) - shift(0)).norm() > 1e-6 * kThickness) return Vec3::Zero();
  return shift(0).norm() > 1.001 * kThickness ? Vec3(Vec3::Zero()) : shift(0).normalized();
}

namespace {

/// A mesh whose extent is less than 0.1 mm, which contacts give way by, enlarged to that about its middle; otherwise
/// itself.
std::shared_ptr<const engine::Mesh> enlarged(const std::shared_ptr<const engine::Mesh>& mesh) {
  constexpr double kLeastExtent = 1e-4;  // m
  using Points = Eigen::Matrix3Xd;
  const Eigen::Map<const Points> points(mesh->vertices.data(), 3, static_cast<Eigen::Index>(mesh->vertices.size() / 3));
  const Vec3 low = points.rowwise().minCoeff(), high = points.rowwise().maxCoeff();
  const double extent = (high - low).maxCoeff();
  if (!(extent > 0 && extent < kLeastExtent)) return mesh;
  auto out = std::make_shared<engine::Mesh>(*mesh);
  const Vec3 middle = (low + high) / 2;
  Eigen::Map<Points> larger(out->vertices.data(), 3, points.cols());
  larger = ((points.colwise() - middle) * (kLeastExtent / extent)).colwise() + middle;
  return out;
}

}  // namespace

void MeshPieces::update(const engine::Model& model) {
  std::unordered_map<const engine::Mesh*, std::shared_ptr<const Entry>> now;
  for (const engine::Geom& g : model.geoms) {
    if (g.shape.shape != engine::Shape::mesh || now.contains(g.shape.mesh.get())) continue;
    if (const auto known = all_.find(g.shape.mesh.get()); known != all_.end()) {
      now.insert(*known);
      continue;
    }
    auto made = std::make_shared<Entry>();
    made->mesh = g.shape.mesh;
    made->written = enlarged(g.shape.mesh);
    made->pieces = piecesOf(*made->written);
    try {
      meshes::hullOf(made->written->vertices);
    } catch (const Error&) {
      made->isSolid = false;
    }
    now.emplace(g.shape.mesh.get(), std::move(made));
  }
  all_ = std::move(now);
}

}  // namespace spark::mujoco
