#include "convex_contacts.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "api/contact_points.h"
#include "ode_shapes.h"

namespace spark::ode {

using engine::Shape;

namespace {

/// A reference face looks at most this far away from the normal that ODE found (11 degrees).
constexpr double kAligned = 0.98;
/// Points on one face that are nearer to each other are one [m^2].
constexpr double kSamePoint = 1e-12;

}  // namespace

void ConvexContacts::find(const PlacedShape& s, const Vec3& direction, Feature& out) {
  out.points.clear();
  out.alignment = 0;
  const Vec3 local = s.rotation.transpose() * direction;
  const auto add = [&](const Vec3& p) { out.points.push_back(s.position + s.rotation * p); };
  const auto setNormal = [&](const Vec3& normal) {
    out.normal = s.rotation * normal;
    out.alignment = normal.dot(local);
  };
  switch (s.shape.shape) {
    case Shape::convex: {
      const auto& faces = s.hull->faces();
      if (faces.empty()) return;
      const auto best = std::max_element(faces.begin(), faces.end(), [&](const auto& x, const auto& y) {
        return x.normal.dot(local) < y.normal.dot(local);
      });
      setNormal(best->normal);
      for (const std::uint32_t i : best->corners) add(s.hull->corner(i));
      break;
    }
    case Shape::box: {
      int axis = 0;
      local.cwiseAbs().maxCoeff(&axis);
      const double side = local[axis] < 0 ? -1 : 1;
      setNormal(side * Vec3::Unit(axis));
      const Vec3 half = s.shape.lengths / 2, x = half[(axis + 1) % 3] * Vec3::Unit((axis + 1) % 3),
                 y = side * half[(axis + 2) % 3] * Vec3::Unit((axis + 2) % 3),
                 middle = side * half[axis] * Vec3::Unit(axis);
      for (const Vec3& p : {Vec3(x + y), Vec3(-x + y), Vec3(-x - y), Vec3(x - y)}) add(middle + p);
      break;
    }
    case Shape::cylinder: {
      const double r = s.shape.radius, half = s.shape.length / 2, up = local.z() < 0 ? -1 : 1;
      const Vec3 aside(local.x(), local.y(), 0);
      if (std::abs(local.z()) > 0.7 || aside.isZero(0)) {
        setNormal(up * Vec3::UnitZ());
        // The lowest point of the rim first, so that a tilted cylinder touches where it does.
        const double begin = aside.isZero(1e-9) ? 0 : std::atan2(aside.y(), aside.x());
        for (int i = 0; i < 8; ++i) {
          const double angle = begin + up * i * kPi / 4;
          add({r * std::cos(angle), r * std::sin(angle), up * half});
        }
      } else {
        for (const double end : {-half, half}) add(r * aside.normalized() + end * Vec3::UnitZ());
      }
      break;
    }
    case Shape::capsule:
      for (const double end : {-0.5, 0.5}) add(s.shape.radius * local + end * s.shape.length * Vec3::UnitZ());
      break;
    default:
      add(s.shape.radius * local);
  }
}

void ConvexContacts::clip(const Feature& reference, Feature& incident) {
  std::vector<Vec3>& points = incident.points;
  const std::size_t sides = reference.points.size();
  for (std::size_t i = 0; i < sides && !points.empty(); ++i) {
    const Vec3& from = reference.points[i];
    const Vec3 inwards = reference.normal.cross(reference.points[(i + 1) % sides] - from);
    clipped_.clear();
    for (std::size_t k = 0; k < points.size(); ++k) {
      const Vec3 &p = points[k], &q = points[(k + 1) % points.size()];
      const double a = inwards.dot(p - from), b = inwards.dot(q - from);
      if (a >= 0) clipped_.push_back(p);
      if ((a < 0) != (b < 0) && points.size() > 1) clipped_.push_back(p + a / (a - b) * (q - p));
    }
    std::swap(points, clipped_);
  }
  points_.clear();
  const double plane = reference.normal.dot(reference.points.front());
  for (const Vec3& p : points) {
    const double depth = plane - reference.normal.dot(p);
    const bool known = std::any_of(points_.begin(), points_.end(),
                                   [&](const Point& o) { return (o.position - p).squaredNorm() < kSamePoint; });
    if (depth >= 0 && !known) points_.push_back({p, depth});
  }
}

int ConvexContacts::spread(const PlacedShape& a, const PlacedShape& b, int max, dContactGeom* found) {
  if (a.shape.shape == Shape::sphere || b.shape.shape == Shape::sphere) return 1;  // touches in one point
  const Vec3 normal = toVec(found->normal);
  find(a, -normal, a_);
  find(b, normal, b_);
  // The second is the reference of two that look alike, so that the choice does not change from step to step.
  const bool ofA = a_.alignment > b_.alignment + 1e-3;
  if (std::max(a_.alignment, b_.alignment) < kAligned) return 1;
  if (ofA)
    clip(a_, b_);
  else
    clip(b_, a_);
  if (points_.empty()) return 1;
  return write(max, ofA ? Vec3(-a_.normal) : b_.normal, found);
}

int ConvexContacts::onPlane(const PlacedShape& a, const Vec3& normal, double offset, int max, dContactGeom* found) {
  points_.clear();
  const Vec3 local = a.rotation.transpose() * normal;
  const double beyond = offset - normal.dot(a.position);
  for (std::uint32_t i = 0; 3 * i < a.hull->corners().size(); ++i)
    if (const double depth = beyond - local.dot(a.hull->corner(i)); depth >= 0)
      points_.push_back({a.position + a.rotation * a.hull->corner(i), depth});
  return write(max, normal, found);
}

namespace {

/// Moves a contact at the prism around a cylinder to the cylinder.
void moveToCylinder(const PlacedShape& a, dContactGeom& c) {
  constexpr double kLying = 0.2;  // sine of the angle up to which a cylinder lies on its side
  constexpr double kStep = 2 * kPi / kPrismSides;
  const Vec3 normal = toVec(c.normal), down = -(a.rotation.transpose() * normal);
  const Vec3 before = a.rotation.transpose() * (toVec(c.pos) - a.position);
  const double half = a.shape.length / 2, radius = a.shape.radius, end = down.z() < 0 ? -half : half;
  const bool atEnd =
      std::abs(down.z()) > kLying && std::abs(end - before.z()) * std::abs(down.z()) <= c.depth + 0.01 * radius;
  const double lowest = std::atan2(down.y(), down.x()), there = std::atan2(before.y(), before.x());
  const bool isCorner = std::abs(std::remainder(there, kStep)) < 0.1 * kStep;
  Vec3 p(before.x(), before.y(), atEnd ? end : std::clamp(before.z(), -half, half));
  if (std::abs(down.z()) <= kAligned && isCorner && std::abs(std::remainder(lowest - there, 2 * kPi)) <= kStep) {
    // A face of the mesh touches the side: corners of the prism are further out than the cylinder.
    p.head<2>() = radius * down.head<2>().normalized();
    const double fromCorner = lowest - kStep * std::round(lowest / kStep);
    c.depth += down.head<2>().norm() * radius * (1 - std::cos(fromCorner) / std::cos(kStep / 2));
  } else {
    // The end, or an edge of the mesh somewhere on the side.
    p.head<2>() *= std::min(1.0, radius / p.head<2>().norm());
    c.depth += down.head<2>().dot((p - before).head<2>());
  }
  for (int k = 0; k < 3; ++k) c.pos[k] = (a.position + a.rotation * p)[k];
}

}  // namespace

int ConvexContacts::onMesh(const PlacedShape& a, dGeomID probe, std::span<const dGeomID> sides, int max,
                           dContactGeom* found) {
  constexpr int kMost = 16;       // points of one question
  constexpr double kTurn = 0.01;  // rad: the lower side of a foot sinks in by millimetres
  constexpr double kSame = 1e-6;  // m^2
  const bool round = a.shape.shape == Shape::cylinder;
  all_.resize(5 * kMost * sides.size());
  const auto ask = [&](dGeomID mesh, const Mat3& turn, dContactGeom* to) {
    const Mat3 r = turn * a.rotation;
    dMatrix3 rotation;
    toOde(r, rotation);
    dGeomSetPosition(probe, a.position.x(), a.position.y(), a.position.z());
    dGeomSetRotation(probe, rotation);
    updateBounds(probe);
    const int found = dCollide(probe, mesh, kMost, to, sizeof(dContactGeom));
    // ODE's points are halfway between both surfaces; here those of the prism count.
    for (int i = 0; round && i < found; ++i)
      for (int k = 0; k < 3; ++k) to[i].pos[k] -= to[i].normal[k] * to[i].depth / 2;
    return found;
  };
  int count = 0;
  const auto add = [&](dContactGeom c, bool first) {
    // Of two sides the one that looks at the middle of the hull holds it.
    if (sides.size() > 1 && toVec(c.normal).dot(a.position - toVec(c.pos)) <= 0) return;
    if (round) moveToCylinder(a, c);
    const auto isSame = [&](const dContactGeom& o) {
      return (toVec(o.pos) - toVec(c.pos)).squaredNorm() < kSame &&
             (!first || toVec(o.normal).dot(toVec(c.normal)) > kAligned);
    };
    if (c.depth < 0 || ((!first || round) && std::any_of(all_.data(), all_.data() + count, isSame))) return;
    all_[static_cast<std::size_t>(count++)] = c;
  };
  dContactGeom asked[kMost];
  for (const dGeomID mesh : sides) {
    const int first = ask(mesh, Mat3::Identity(), asked);
    if (first == 0) continue;
    const Vec3 x = toVec(asked[0].normal).unitOrthogonal(), y = toVec(asked[0].normal).cross(x);
    for (int i = 0; i < first; ++i) add(asked[i], true);
    for (const Vec3& axis : {x, y, Vec3(-x), Vec3(-y)}) {
      const Mat3 turn = Eigen::AngleAxisd(kTurn, axis).toRotationMatrix();
      const int more = ask(mesh, turn, asked);
      for (int i = 0; i < more; ++i) {
        // Turned back: where the point of the hull is, and how deep.
        dContactGeom c = asked[i];
        const Vec3 turned = toVec(c.pos), p = a.position + turn.transpose() * (turned - a.position);
        c.depth -= toVec(c.normal).dot(p - turned);
        for (int k = 0; k < 3; ++k) c.pos[k] = p[k];
        add(c, false);
      }
    }
  }
  count = choose(count, max, all_.data());
  std::copy_n(all_.data(), count, found);
  return count;
}

int ConvexContacts::write(int max, const Vec3& normal, dContactGeom* found) {
  const bool all = points_.size() <= static_cast<std::size_t>(max);
  if (!all)
    engine::choosePoints(
        points_.size(), static_cast<std::size_t>(max), [this](std::size_t i) { return points_[i].position; },
        [this](std::size_t i) { return points_[i].depth; }, apart_);
  int count = 0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (!all && apart_[i] >= 0) continue;
    dContactGeom& c = found[count++];
    for (int k = 0; k < 3; ++k) c.pos[k] = points_[i].position[k], c.normal[k] = normal[k];
    c.depth = points_[i].depth;
  }
  return count;
}

int ConvexContacts::choose(int count, int max, dContactGeom* found) {
  if (count <= max) return count;
  engine::choosePoints(
      static_cast<std::size_t>(count), static_cast<std::size_t>(max),
      [&](std::size_t i) { return toVec(found[i].pos); }, [&](std::size_t i) { return found[i].depth; }, apart_);
  int kept = 0;
  for (int i = 0; i < count; ++i)
    if (apart_[static_cast<std::size_t>(i)] < 0) found[kept++] = found[i];
  return kept;
}

}  // namespace spark::ode
