#include "piece_contacts.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace spark::mujoco {

namespace {

constexpr int kMostTriangles = 64;    // of a hull: MuJoCo finds the contacts of finer ones well
constexpr double kInPlane = 1e-6;     // of the size of a piece, whose corners are in single precision
constexpr double kDeep = 0.005;       // m
constexpr double kLikeFront = 0.999;  // cosine between the front of a plate and the normals of its two sides

Vec3 vectorAt(const mjtNum* v) { return {v[0], v[1], v[2]}; }
auto axesAt(mjtNum* m) { return Eigen::Map<Eigen::Matrix<mjtNum, 3, 3, Eigen::RowMajor>>(m); }

}  // namespace

void PieceContacts::add(const mjModel& m, int geom, const Vec3& front) {
  faces_.resize(static_cast<std::size_t>(m.ngeom));
  for (std::vector<Point>* points : {&points_, &best_, &clipped_}) points->reserve(2 * mjMAXCONPAIR);  // for the steps
  const int mesh = m.geom_dataid[geom];
  if (m.geom_type[geom] != mjGEOM_MESH || mesh < 0 || m.mesh_graphadr[mesh] < 0) return;
  // The hull: numbers of vertices and triangles, two lists by vertex, one of edges, and the triangles' vertices.
  const int* const graph = m.mesh_graph + m.mesh_graphadr[mesh];
  const int vertices = graph[0], triangles = graph[1];
  if (triangles > kMostTriangles) return;
  const int* const used = graph + 2 + vertices;
  const int* const corners = used + vertices + vertices + 3 * triangles;
  const auto vertex = [&](int i) {
    const float* const v = m.mesh_vert + 3 * (m.mesh_vertadr[mesh] + i);
    return Vec3(v[0], v[1], v[2]);
  };
  double size = 0;
  for (int i = 0; i < vertices; ++i) size = std::max(size, vertex(used[i]).norm());
  const Eigen::Quaterniond q(m.geom_quat[4 * geom], m.geom_quat[4 * geom + 1], m.geom_quat[4 * geom + 2],
                             m.geom_quat[4 * geom + 3]);
  const Vec3 ownFront = q.conjugate() * front;

  // Large triangles first: the normals of small ones are noise.
  struct Triangle {
    Vec3 across, at;
    std::array<int, 3> corners;
  };
  std::vector<Triangle> sorted;
  for (int t = 0; t < triangles; ++t) {
    const int* const c = corners + 3 * t;
    Vec3 across = (vertex(c[1]) - vertex(c[0])).cross(vertex(c[2]) - vertex(c[0]));
    if (across.dot(vertex(c[0])) < 0) across = -across;  // MuJoCo has the centre at the origin
    sorted.push_back({across, vertex(c[0]), {c[0], c[1], c[2]}});
  }
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const Triangle& a, const Triangle& b) { return a.across.norm() > b.across.norm(); });
  std::vector<Face>& faces = faces_[geom];
  for (const Triangle& t : sorted) {
    const auto isIn = [&](const Face& f) {
      return std::all_of(t.corners.begin(), t.corners.end(),
                         [&](int i) { return std::abs(f.normal.dot(vertex(i)) - f.offset) < kInPlane * size; });
    };
    if (!(t.across.norm() > kInPlane * kInPlane * size * size) || std::any_of(faces.begin(), faces.end(), isIn))
      continue;
    Face& face = faces.emplace_back();
    face.normal = t.across.normalized();
    face.offset = face.normal.dot(t.at);
    for (int i = 0; i < vertices; ++i)
      if (const Vec3 v = vertex(used[i]); std::abs(face.normal.dot(v) - face.offset) < kInPlane * size)
        face.corners.push_back(v);
    Vec3 middle = Vec3::Zero();
    for (const Vec3& v : face.corners) middle += v / static_cast<double>(face.corners.size());
    const Vec3 x = face.normal.unitOrthogonal(), y = face.normal.cross(x);
    std::sort(face.corners.begin(), face.corners.end(), [&](const Vec3& a, const Vec3& b) {
      return std::atan2(y.dot(a - middle), x.dot(a - middle)) < std::atan2(y.dot(b - middle), x.dot(b - middle));
    });
  }
  if (!front.isZero(0))
    for (Face& f : faces) f.isRim = std::abs(f.normal.dot(ownFront)) < kLikeFront;
}

double PieceContacts::ask(const mjModel* m, const mjData* d, mjContact* out, int piece, int other, const Face& face,
                          mjtNum margin) {
  // MuJoCo reads nothing of a plane but its pose: the piece has that of the plane meanwhile.
  mjtNum* const position = d->geom_xpos + 3 * piece;
  mjtNum* const rotation = d->geom_xmat + 9 * piece;
  const Vec3 at = vectorAt(position);
  const Mat3 axes = axesAt(rotation);
  const Vec3 normal = axes * face.normal, x = normal.unitOrthogonal(), plane = at + face.offset * normal;
  std::copy_n(plane.data(), 3, position);
  axesAt(rotation) << x, normal.cross(x), normal;
  const int count = mjCOLLISIONFUNC[mjGEOM_PLANE][m->geom_type[other]](m, d, out, piece, other, margin);
  std::copy_n(at.data(), 3, position);
  axesAt(rotation) = axes;

  points_.clear();
  double deepest = -1;
  for (int i = 0; i < count; ++i) {
    points_.push_back({axes.transpose() * (vectorAt(out[i].pos) - at), out[i].dist});
    deepest = std::max({deepest, 0.0, -out[i].dist});
  }
  return deepest;
}

void PieceContacts::clip(const Face& face, std::vector<Point>& points) {
  if (points.size() > 2) {
    Vec3 middle = Vec3::Zero();
    for (const Point& p : points) middle += p.position / static_cast<double>(points.size());
    const Vec3 x = face.normal.unitOrthogonal(), y = face.normal.cross(x);
    const auto angle = [&](const Point& p) {
      return std::atan2(y.dot(p.position - middle), x.dot(p.position - middle));
    };
    std::sort(points.begin(), points.end(), [&](const Point& a, const Point& b) { return angle(a) < angle(b); });
  }
  // Sutherland and Hodgman 1974, "Reentrant polygon clipping".
  const std::size_t sides = face.corners.size();
  for (std::size_t i = 0; i < sides && !points.empty(); ++i) {
    const Vec3& from = face.corners[i];
    const Vec3 inwards = face.normal.cross(face.corners[(i + 1) % sides] - from).normalized();
    const double tolerance = kInPlane * (1 + face.corners[i].norm());
    clipped_.clear();
    for (std::size_t k = 0; k < points.size(); ++k) {
      const Point &p = points[k], &q = points[(k + 1) % points.size()];
      const double a = inwards.dot(p.position - from) + tolerance, b = inwards.dot(q.position - from) + tolerance;
      if (a >= 0) clipped_.push_back(p);
      if ((a < 0) == (b < 0) || points.size() < 2) continue;
      const double share = a / (a - b);
      clipped_.push_back(
          {p.position + share * (q.position - p.position), p.distance + share * (q.distance - p.distance)});
    }
    std::swap(points, clipped_);
  }
}

int PieceContacts::find(const mjModel* m, const mjData* d, mjContact* out, int geom1, int geom2, mjtNum margin) {
  const bool second = facesOf(geom2) != nullptr;
  const int piece = second ? geom2 : geom1, other = second ? geom1 : geom2;
  const std::vector<Face>* const faces = facesOf(piece);
  if (!faces || m->geom_type[other] == mjGEOM_HFIELD || facesOf(other)) return -1;
  const Mat3 axes = axesAt(d->geom_xmat + 9 * piece);
  const Vec3 at = vectorAt(d->geom_xpos + 3 * piece);
  const Vec3 centre = axes.transpose() * (vectorAt(d->geom_xpos + 3 * other) - at);
  // A body comes from a side on which its centre is.
  const auto looksAt = [&](const Face& f) { return f.normal.dot(centre) > f.offset; };
  const bool isOutside =
      std::any_of(faces->begin(), faces->end(), [&](const Face& f) { return !f.isRim && looksAt(f); });
  const Face* least = nullptr;
  double depth = HUGE_VAL, beyondRim = HUGE_VAL;
  for (const Face& face : *faces) {
    if (face.isRim ? !looksAt(face) : isOutside && !looksAt(face)) continue;
    const double own = ask(m, d, out, piece, other, face, margin);
    if (own < 0) return 0;  // the plane is between them
    if (face.isRim) beyondRim = std::min(beyondRim, own);
    if (face.isRim || own >= depth) continue;
    depth = own, least = &face;
    std::swap(best_, points_);
  }
  // The next plate begins at a rim, so it counts for what stands beside the plate alone.
  if (!least || depth > kDeep + 2 * beyondRim) return -1;
  clip(*least, best_);
  if (best_.empty()) return -1;
  const Vec3 normal = (second ? -1 : 1) * (axes * least->normal);
  const std::size_t count = std::min<std::size_t>(best_.size(), mjMAXCONPAIR);
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 p = at + axes * best_[i].position;
    out[i].dist = best_[i].distance;
    std::copy_n(p.data(), 3, out[i].pos);
    mju_zero(out[i].frame, 9);
    std::copy_n(normal.data(), 3, out[i].frame);
  }
  return static_cast<int>(count);
}

}  // namespace spark::mujoco
