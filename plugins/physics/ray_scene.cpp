#include "ray_scene.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "api/math.h"
#include "shape_ray.h"

namespace spark::physics {

using engine::Geom;
using engine::Index;
using engine::Shape;
using engine::ShapeDescription;

namespace {

/// The box around a shape in its own frame, of shapes other than planes and meshes.
Box boundsOf(const ShapeDescription& s, const Mat3& rotation, const Vec3& center) {
  Vec3 half;
  const Vec3 axis = rotation.col(2).cwiseAbs();
  switch (s.shape) {
    case Shape::box:
      half = rotation.cwiseAbs() * (s.lengths / 2);
      break;
    case Shape::capsule:
      half = axis * (s.length / 2) + Vec3::Constant(s.radius);
      break;
    case Shape::cylinder:
      half = axis * (s.length / 2) + (Vec3::Ones() - axis.cwiseProduct(axis)).cwiseMax(0).cwiseSqrt() * s.radius;
      break;
    default:
      half = Vec3::Constant(s.radius);
  }
  return {center - half, center + half};
}

/// The box around a box that is moved.
Box moved(const Box& box, const Mat3& rotation, const Vec3& position) {
  const Vec3 center = position + rotation * ((box.low + box.high) / 2),
             half = rotation.cwiseAbs() * ((box.high - box.low) / 2);
  return {center - half, center + half};
}

/// Larger by more than the rounding of a ray's intersection, so that no hit at a corner is lost.
Box padded(const Box& box) {
  const Vec3 pad = Vec3::Constant(1e-9) + 1e-12 * box.low.cwiseAbs().cwiseMax(box.high.cwiseAbs());
  return {box.low - pad, box.high + pad};
}

void build(BoxTree& tree, const engine::Mesh& m) {
  std::vector<Box> boxes(m.triangles.size() / 3);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Vec3 a = cornerOf(m, 3 * i), b = cornerOf(m, 3 * i + 1), c = cornerOf(m, 3 * i + 2);
    boxes[i] = padded({a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)});
  }
  tree.build(boxes);
}

/// The box around a height field in its own frame.
Box boundsOf(const engine::HeightField& f) {
  return {{-f.width / 2, -f.depth / 2, f.low}, {f.width / 2, f.depth / 2, f.high}};
}

}  // namespace

void RayScene::clear() {
  at_ = nullptr;
  placed_.clear();  // the trees of meshes stay, for the next update
}

void RayScene::update(const engine::Model& model, const engine::State& state, std::uint64_t poses) {
  if (isCurrent(model, poses)) return;
  const Stamp now = stamp(model, poses);
  const Stamp* last = at_.load(std::memory_order_relaxed);
  if (!last || last->model != now.model || last->structure != now.structure || last->collision != now.collision)
    collect(model);
  place(model, state);
  Stamp& next = stamps_[last == stamps_.data() ? 1 : 0];
  next = now;
  at_.store(&next, std::memory_order_release);
}

/// Lists the geoms, and builds the trees of new meshes.
void RayScene::collect(const engine::Model& model) {
  placed_.clear();
  std::vector<std::shared_ptr<const MeshTree>> meshes;
  for (Index i = 0; i < model.geoms.size(); ++i) {
    const Geom& g = model.geoms[i];
    if (!isQueried(g)) continue;
    const BoxTree* triangles = nullptr;
    if (g.shape.shape == Shape::mesh || g.shape.shape == Shape::convex) {
      meshes.push_back(trees_.get(g.shape.mesh, [](const auto& mesh) {
        auto made = std::make_shared<MeshTree>(MeshTree{mesh, {}});
        build(made->triangles, *mesh);
        return made;
      }));
      triangles = &meshes.back()->triangles;
      if (triangles->empty()) continue;  // without triangles nothing is met
    }
    placed_.push_back({&g, i, triangles, Vec3::Zero(), Mat3::Identity()});
  }
  meshes_ = std::move(meshes);
  const auto planes = std::stable_partition(placed_.begin(), placed_.end(),
                                            [](const Placed& p) { return p.geom->shape.shape != Shape::plane; });
  bounded_ = static_cast<std::size_t>(planes - placed_.begin());
  boxes_.resize(bounded_);
}

void RayScene::place(const engine::Model& model, const engine::State& state) {
  for (std::size_t i = 0; i < placed_.size(); ++i) {
    Placed& p = placed_[i];
    const Pose pose = poseOf(model, state, p.index);
    p.position = pose.position;
    p.toShape = pose.rotation.transpose();
    if (i >= bounded_) continue;
    if (p.triangles)
      boxes_[i] = padded(moved(p.triangles->bounds(), pose.rotation, pose.position));
    else if (p.geom->shape.shape == Shape::heightField)
      boxes_[i] = padded(moved(boundsOf(*p.geom->shape.heightField), pose.rotation, pose.position));
    else
      boxes_[i] = padded(boundsOf(p.geom->shape, pose.rotation, pose.position));
  }
  tree_.build(boxes_);
}

/// Sets `hit` if the ray meets the geom within `length`.
bool RayScene::cast(const Placed& p, const Vec3& from, const Vec3& direction, double length, GeomHit& hit) const {
  ShapeRay ray{p.toShape * (from - p.position), p.toShape * direction, length};
  if (!p.triangles) {
    castShape(ray, p.geom->shape);
  } else {
    std::uint32_t met = 0;
    p.triangles->meet(ray.from, ray.direction, length, [&](std::uint32_t i) {
      ShapeRay one{ray.from, ray.direction, ray.nearest};
      castTriangle(one, *p.geom->shape.mesh, i);
      // At an edge of two triangles the last in their order counts.
      if (one.hit && (!ray.hit || one.nearest < ray.nearest || i > met)) ray = one, met = i;
      return ray.nearest;
    });
  }
  if (ray.hit) hit = {p.index, ray.nearest, p.toShape.transpose() * ray.normal};
  return ray.hit;
}

template <class Visit>
void RayScene::visitAlong(const Vec3& from, const Vec3& direction, double length, Visit&& visit) const {
  for (std::size_t i = bounded_; i < placed_.size(); ++i)
    if ((length = visit(placed_[i])) < 0) return;
  tree_.meet(from, direction, length, [&](std::uint32_t i) { return visit(placed_[i]); });
}

std::optional<GeomHit> RayScene::castRay(const Vec3& from, const Vec3& direction, double length,
                                         const Accepts& accepts) const {
  GeomHit nearest{engine::kNone, length, Vec3::Zero()};
  visitAlong(from, direction, length, [&](const Placed& p) {
    GeomHit hit;
    if (cast(p, from, direction, nearest.distance, hit) && (!accepts || accepts(*p.geom)) &&
        (hit.distance < nearest.distance || nearest.geom == engine::kNone || p.index > nearest.geom))
      nearest = hit;
    return nearest.distance;
  });
  if (nearest.geom == engine::kNone) return std::nullopt;
  return nearest;
}

void RayScene::findOverlaps(const Vec3& center, double radius, std::vector<Index>& out) const {
  const auto first = static_cast<std::ptrdiff_t>(out.size());
  const auto visit = [&](const Placed& p) {
    if (touches(p.geom->shape, p.position, p.toShape, center, radius)) out.push_back(p.index);
  };
  for (std::size_t i = bounded_; i < placed_.size(); ++i) visit(placed_[i]);
  tree_.near(center, std::max(radius, 0.0), [&](std::uint32_t i) { visit(placed_[i]); });
  std::sort(out.begin() + first, out.end());
}

/// The nearest point of a geom in the cone, relative to the apex, world frame.
std::optional<Vec3> RayScene::nearestIn(const Cone& cone, const Placed& p) const {
  const ShapeDescription& shape = p.geom->shape;
  const Vec3 to = p.position - cone.apex;
  if (shape.shape != Shape::plane && to.norm() > reach(shape) + cone.range) return std::nullopt;
  Cone local = cone;
  local.apex = p.toShape * -to;
  local.axis = p.toShape * cone.axis;
  const auto near = [&](const Vec3& center, double radius, const std::function<void(std::uint32_t)>& visit) {
    p.triangles->near(center, radius, visit);
  };
  const auto found = nearestInCone(shape, local, near);
  if (!found) return std::nullopt;
  return Vec3(p.toShape.transpose() * *found);
}

/// The distance to a geom whose nearest point is `nearest`, if that is not hidden; otherwise to the nearest of points
/// spread over it that are seen in the cone.
std::optional<double> RayScene::visibleFrom(const Cone& cone, const Placed& p, const Vec3& nearest,
                                            const Accepts& accepts) const {
  constexpr double kAtSurface = 1e-6;  // m: rounding
  const double distance = nearest.norm();
  if (distance <= kAtSurface) return 0;
  const auto first = castRay(cone.apex, nearest / distance, distance + kAtSurface, accepts);
  if (!first || first->geom == p.index || first->distance >= distance - kAtSurface)
    return first && first->geom == p.index ? std::min(first->distance, distance) : distance;
  thread_local std::vector<Vec3> points;  // for its memory
  points.clear();
  spreadPoints(p.geom->shape, points);
  std::optional<double> seen;
  for (const Vec3& point : points) {
    const Vec3 to = p.position + p.toShape.transpose() * point - cone.apex;
    const double length = to.norm();
    if (!(length > 0) || !cone.contains(to)) continue;
    const auto hit = castRay(cone.apex, to / length, cone.range, accepts);
    if (hit && hit->geom == p.index && (!seen || hit->distance < *seen)) seen = hit->distance;
  }
  return seen;
}

void RayScene::listen(const Cone& cone, int rings, const Accepts& accepts, std::vector<GeomEcho>& out) const {
  const auto first = static_cast<std::ptrdiff_t>(out.size());
  const auto visit = [&](const Placed& p) {
    if (accepts && !accepts(*p.geom)) return;
    if (const auto nearest = nearestIn(cone, p))
      if (const auto distance = visibleFrom(cone, p, *nearest, accepts)) out.push_back({p.index, *distance});
  };
  for (std::size_t i = bounded_; i < placed_.size(); ++i) visit(placed_[i]);
  tree_.near(cone.apex, cone.range, [&](std::uint32_t i) { visit(placed_[i]); });
  // What is hidden where it is nearest.
  const double widest = std::atan2(cone.sine, cone.cosine);
  const Vec3 right = cone.axis.unitOrthogonal(), up = cone.axis.cross(right);
  for (int ring = 0; ring <= rings; ++ring) {
    const double aside = ring > 0 ? widest * ring / rings : 0;
    const int rays = std::max(1, 6 * ring);
    for (int i = 0; i < rays; ++i) {
      const double around = 2 * kPi * i / rays;
      const Vec3 direction =
          std::cos(aside) * cone.axis + std::sin(aside) * (std::cos(around) * right + std::sin(around) * up);
      if (const auto hit = castRay(cone.apex, direction, cone.range, accepts))
        out.push_back({hit->geom, hit->distance});
    }
  }
  std::sort(out.begin() + first, out.end(), [](const GeomEcho& a, const GeomEcho& b) {
    return a.geom != b.geom ? a.geom < b.geom : a.distance < b.distance;
  });
  out.erase(std::unique(out.begin() + first, out.end(),
                        [](const GeomEcho& a, const GeomEcho& b) { return a.geom == b.geom; }),
            out.end());
}

bool RayScene::meets(const Vec3& from, const Vec3& direction, double length, const Accepts& accepts) const {
  bool met = false;
  visitAlong(from, direction, length, [&](const Placed& p) {
    GeomHit hit;
    met = cast(p, from, direction, length, hit) && (!accepts || accepts(*p.geom));
    return met ? -1.0 : length;
  });
  return met;
}

}  // namespace spark::physics
