#include "constraint_builder.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "spark/access.h"

namespace spark::mjcf {

void ConstraintBuilder::build() {
  if (c_.flags.equality)
    for (const Equality& x : c_.model.equalities) equality(x);
  for (const Tendon& t : c_.model.tendons) tendon(t);
}

Leaf* ConstraintBuilder::make(const Element& from, const char* className, const std::string& name, const char* kind) {
  if (provides(c_.top.kernel(), className)) return &c_.top.create(className, c_.names.in(c_.top, name, kind));
  c_.unsupported.add(from, fmt::format("<{}> needs the plugin physics-mujoco, which is not there", from.tag()));
  return nullptr;
}

std::string ConstraintBuilder::path(const PlacedBody& body) {
  return body.carrier == 0 ? "" : "../" + c_.bodies.carrierOf(body).node->name() + "/body";
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

Pose ConstraintBuilder::frameOf(const PlacedBody& body) { return body.carrier == 0 ? body.world : body.inCarrier; }

void ConstraintBuilder::equality(const Equality& x) {
  // What it names is looked up first: an error leaves nothing behind.
  const bool joints = x.type == "joint";
  std::string first, second;
  if (joints) {
    first = pathOf(jointOf(x.first, x.from));
    if (!x.second.empty()) second = pathOf(jointOf(x.second, x.from));
  } else {
    first = path(c_.bodies.find(x.first, x.from));
    second = path(c_.bodies.find(x.second, x.from));
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
  const Pose in1 = frameOf(first), in2 = frameOf(second);
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
  std::vector<Vec3> points;
  for (const TendonPart& part : t.parts) {
    const Place place = siteOf(part);
    points.push_back(compose(place.body->world, place.site->pose).position);
  }
  for (std::size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
  return length;
}

void ConstraintBuilder::tendon(const Tendon& t) {
  const double rest = springLength(t);
  double offset = 0;  // of lengths that are sums of coordinates
  if (!t.spatial)
    for (const TendonPart& part : t.parts) offset += part.coefficient * jointOf(part.name, part.from).joint->reference;
  if (t.spatial && t.springLength < 0 && t.stiffness > 0 && hasShiftedJoint(t))
    c_.unsupported.add(t.from,
                       fmt::format("the spring of {} rests where the file has the bodies; 'springref' and 'ref' "
                                   "of joints do not count",
                                   t.from.named()));
  Leaf* const node = make(t.from, "MujocoTendon", t.name, "tendon");
  if (!node) return;
  for (const TendonPart& part : t.parts)
    if (t.spatial)
      addSite(part, *node);
    else
      callMethod(*node, "addJoint", List{pathOf(jointOf(part.name, part.from)), part.coefficient});
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
}

bool ConstraintBuilder::hasShiftedJoint(const Tendon& t) {
  const auto isAt = [&](const PlacedBody& joined, const TendonPart& part) {
    int up = static_cast<int>(siteOf(part).body->body - c_.model.bodies.data());
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

ConstraintBuilder::Place ConstraintBuilder::siteOf(const TendonPart& part) {
  for (PlacedBody& b : c_.bodies)
    for (const Site& s : b.body->sites)
      if (s.name == part.name && !s.name.empty()) return {&b, &s};
  throw part.from.error(fmt::format("there is no site '{}'", part.name));
}

void ConstraintBuilder::addSite(const TendonPart& part, Leaf& node) {
  const Place place = siteOf(part);
  const Vec3 p = compose(frameOf(*place.body), place.site->pose).position;
  callMethod(node, "addPoint", List{path(*place.body), p.x(), p.y(), p.z()});
}

}  // namespace spark::mjcf
