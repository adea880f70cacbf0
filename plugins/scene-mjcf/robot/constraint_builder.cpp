#include "constraint_builder.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "spark/access.h"

namespace spark::mjcf {

void ConstraintBuilder::build() {
  // Equalities name tendons.
  for (const Tendon& t : c_.model.tendons) c_.attempt(t.from, c_.top, [&] { tendon(t); });
  if (c_.flags.equality)
    for (const Equality& x : c_.model.equalities) c_.attempt(x.from, c_.top, [&] { equality(x); });
}

Leaf* ConstraintBuilder::make(const Element& from, const char* className, const std::string& name, const char* kind) {
  if (provides(c_.top.kernel(), className)) {
    Leaf& made = c_.top.create(className, c_.names.in(c_.top, name, kind));
    setWritten(made, from.placed());
    return &made;
  }
  c_.unsupported.add(from, fmt::format("<{}> needs the plugin physics-mujoco, which is not there", from.tag()));
  return nullptr;
}

std::string ConstraintBuilder::pathOf(const Construction::MadeJoint& joint) {
  const Leaf& leaf = joint.made->leaf();
  return "../" + leaf.parent()->name() + "/" + leaf.name();
}

const Construction::MadeJoint& ConstraintBuilder::jointOf(const std::string& name, const Element& user) {
  const auto found = c_.joints.find(name);
  if (found == c_.joints.end()) throw user.error(fmt::format("there is no joint '{}' with a coordinate", name));
  if (found->second.joint->kind == JointKind::ball)
    throw user.error(fmt::format("expected a joint with one coordinate, found the ball '{}'", name));
  return found->second;
}

void ConstraintBuilder::equality(const Equality& x) {
  // What it names is looked up first: an error leaves nothing behind.
  const bool tendons = x.type == "tendon", joints = x.type == "joint" || tendons;
  std::string first, second;
  if (tendons) {
    const Leaf *const a = tendonOf(x.first, x.from), *const b = x.second.empty() ? nullptr : tendonOf(x.second, x.from);
    if (!a || (!b && !x.second.empty())) return;
    first = "../" + a->name();
    if (b) second = "../" + b->name();
  } else if (joints) {
    first = pathOf(jointOf(x.first, x.from));
    if (!x.second.empty()) second = pathOf(jointOf(x.second, x.from));
  } else {
    first = c_.path(c_.bodies.find(x.first, x.from));
    second = c_.path(c_.bodies.find(x.second, x.from));
  }
  Leaf* const node = make(x.from, "MujocoEquality", x.name, "equality");
  if (!node) return;
  setProperty(*node, "type", x.type);
  setProperty(*node, "first", first);
  setProperty(*node, "second", second);
  if (joints)
    setProperty(*node, "polynomial", toList(x.polynomial));
  else
    place(x, *node);
  setProperty(*node, "solref", toList(x.solref));
  setProperty(*node, "solimp", toList(x.solimp));
  setProperty(*node, "active", x.active);
}

/// Points and rotation in the frames of the links that carry the bodies.
void ConstraintBuilder::place(const Equality& x, Leaf& node) {
  const PlacedBody &first = c_.bodies.find(x.first, x.from), &second = c_.bodies.find(x.second, x.from);
  const Pose in1 = Construction::frameOf(first), in2 = Construction::frameOf(second);
  const auto at = [](const Pose& p, const Vec3& v) { return Vec3(p.position + p.rotation * v); };
  const std::array<double, 7>& r = x.relativePose;
  const Eigen::Quaterniond given(r[3], r[4], r[5], r[6]);
  Vec3 point1 = x.anchor, point2 = x.anchor;
  Mat3 turn = first.world.rotation.transpose() * second.world.rotation;  // of the second in the first
  if (x.type == "connect") {
    point2 = inverse(second.world).position + second.world.rotation.transpose() * at(first.world, x.anchor);
  } else if (given.norm() == 0) {
    // They stay where the file has them.
    point1 = inverse(first.world).position + first.world.rotation.transpose() * at(second.world, x.anchor);
  } else {
    point1 = Vec3(r[0], r[1], r[2]);
    turn = given.normalized().toRotationMatrix();
  }
  const Eigen::Quaterniond q(Mat3(in1.rotation * turn * in2.rotation.transpose()));
  setProperty(node, "part1", first.part);
  setProperty(node, "part2", second.part);
  setProperty(node, "anchor1", toList(at(in1, point1)));
  setProperty(node, "anchor2", toList(at(in2, point2)));
  setProperty(node, "rotation", List{q.w(), q.x(), q.y(), q.z()});
  setProperty(node, "torqueScale", x.torqueScale);
}

/// The length that MuJoCo calls `springlength`, in the coordinates here: MuJoCo's less the reference of the file.
double ConstraintBuilder::springLength(const Tendon& t) {
  double length = 0;
  if (!t.spatial) {
    for (const TendonPart& part : t.parts) {
      const Joint& j = *jointOf(part.name, part.from).joint;
      length += part.coefficient * (t.springLength < 0 ? j.springPosition : -j.reference);
    }
    return t.springLength < 0 ? length : t.springLength + length;
  }
  if (t.springLength >= 0) return t.springLength;
  // MuJoCo finds the way around geoms, and where the springs of joints rest.
  using Kind = TendonPart::Kind;
  if (hasShiftedJoint(t) ||
      !std::all_of(t.parts.begin(), t.parts.end(), [](const auto& p) { return p.kind == Kind::site; }))
    return -1;
  std::vector<Vec3> points;
  for (const TendonPart& part : t.parts) {
    const auto place = c_.site(part.name, part.from);
    points.push_back(compose(place.body->world, place.site->pose).position);
  }
  for (std::size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
  return length;
}

const Leaf* ConstraintBuilder::tendonOf(const std::string& name, const Element& user) {
  const auto found = c_.tendons.find(name);
  if (found == c_.tendons.end()) throw user.error(fmt::format("there is no tendon '{}'", name));
  return found->second;
}

void ConstraintBuilder::tendon(const Tendon& t) {
  const double rest = springLength(t);
  double offset = 0;  // of lengths that are sums of coordinates
  if (!t.spatial)
    for (const TendonPart& part : t.parts) offset += part.coefficient * jointOf(part.name, part.from).joint->reference;
  Leaf* const node = make(t.from, "MujocoTendon", t.name, "tendon");
  const auto finish = [&] {
    if (!t.name.empty()) c_.tendons.emplace(t.name, node);
  };
  if (!node) return finish();
  for (const TendonPart& part : t.parts) addPart(part, *node);
  setProperty(*node, "stiffness", c_.flags.passive ? t.stiffness : 0);
  setProperty(*node, "damping", c_.flags.passive ? t.damping : 0);
  setProperty(*node, "frictionLoss", c_.flags.frictionLoss ? t.frictionLoss : 0);
  setProperty(*node, "springLength", rest);
  setProperty(*node, "limited", t.limited && c_.flags.limit);
  setProperty(*node, "range", List{t.range[0] - offset, t.range[1] - offset});
  setProperty(*node, "margin", t.margin);
  setProperty(*node, "limitSolref", toList(t.limitSolref));
  setProperty(*node, "limitSolimp", toList(t.limitSolimp));
  setProperty(*node, "frictionSolref", toList(t.frictionSolref));
  setProperty(*node, "frictionSolimp", toList(t.frictionSolimp));
  finish();
}

bool ConstraintBuilder::hasShiftedJoint(const Tendon& t) {
  const auto isAt = [&](const PlacedBody& joined, const TendonPart& part) {
    const PlacedBody* const own = part.kind == TendonPart::Kind::site ? c_.site(part.name, part.from).body : nullptr;
    int up = own ? static_cast<int>(own->body - c_.model.bodies.data()) : 0;
    while (up > 0 && &c_.bodies[up] != &joined) up = c_.model.bodies[static_cast<std::size_t>(up)].parent;
    return up > 0;
  };
  return std::any_of(c_.bodies.begin(), c_.bodies.end(), [&](const PlacedBody& b) {
    const auto& joints = b.body->joints;
    if (std::none_of(joints.begin(), joints.end(), [](const Joint& j) { return j.springPosition != 0; })) return false;
    const auto moved = std::count_if(t.parts.begin(), t.parts.end(), [&](const auto& part) { return isAt(b, part); });
    return moved > 0 && moved < std::ssize(t.parts);
  });
}

void ConstraintBuilder::addPart(const TendonPart& part, Leaf& node) {
  const auto at = [&](const PlacedBody& body, const Pose& pose) { return compose(Construction::frameOf(body), pose); };
  switch (part.kind) {
    case TendonPart::Kind::joint:
      callMethod(node, "addJoint", List{pathOf(jointOf(part.name, part.from)), part.coefficient});
      break;
    case TendonPart::Kind::pulley:
      callMethod(node, "addPulley", List{part.coefficient});
      break;
    case TendonPart::Kind::site: {
      const auto [body, site] = c_.site(part.name, part.from);
      const Vec3 p = at(*body, site->pose).position;
      callMethod(node, "addPoint", List{c_.path(*body), p.x(), p.y(), p.z()});
      break;
    }
    case TendonPart::Kind::geom: {
      const auto [body, geom] = geomOf(part);
      const Pose pose = at(*body, geom->pose);
      const Vec3& p = pose.position;
      const Eigen::Quaterniond q(pose.rotation);
      if (geom->shape.shape == engine::Shape::sphere)
        callMethod(node, "addSphere", List{c_.path(*body), p.x(), p.y(), p.z(), geom->shape.radius});
      else
        callMethod(node, "addCylinder",
                   List{c_.path(*body), p.x(), p.y(), p.z(), geom->shape.radius, q.w(), q.x(), q.y(), q.z()});
      if (part.side.empty()) break;
      const auto [sideBody, side] = c_.site(part.side, part.from);
      const Vec3 s = at(*sideBody, side->pose).position;
      callMethod(node, "setSide", List{c_.path(*sideBody), s.x(), s.y(), s.z()});
      break;
    }
  }
}

std::pair<PlacedBody*, const Geom*> ConstraintBuilder::geomOf(const TendonPart& part) {
  for (PlacedBody& b : c_.bodies)
    for (const Geom& g : b.body->geoms) {
      if (g.name != part.name || g.name.empty()) continue;
      if (g.shape.shape != engine::Shape::sphere && g.shape.shape != engine::Shape::cylinder)
        throw part.from.error(
            fmt::format("expected a sphere or a cylinder that a tendon can go around, found '{}'", part.name));
      return {&b, &g};
    }
  throw part.from.error(fmt::format("there is no geom '{}'", part.name));
}

}  // namespace spark::mjcf
