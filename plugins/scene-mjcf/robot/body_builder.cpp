#include "body_builder.h"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include "mended_numbers.h"
#include "spark/access.h"

namespace spark::mjcf {

using engine::JointParameter;

namespace {

/// Of a body with several joints, the part of the mass that each body between them has: little enough to move as
/// without them, and enough for engines that divide by it.
constexpr double kBetween = 1e-6;

/// World pose of the frame of a body: that of the link, with the centre of mass as origin.
Pose bodyPose(const PlacedBody& b) { return compose(b.world, {b.mass.center, Mat3::Identity()}); }

/// Makes the body of a transform, with that share of the mass of `b`.
Leaf& makeRigidBody(Node& transform, const PlacedBody& b, double share) {
  Leaf& body = transform.create("RigidBody", "body");
  const Mat3 i = share * b.mass.inertia;
  callMethod(body, "setMassParameters",
             List{share * b.mass.mass, 0.0, 0.0, 0.0, i(0, 0), i(1, 1), i(2, 2), i(0, 1), i(0, 2), i(1, 2)});
  return body;
}

void setPose(Leaf& body, const Pose& world) {
  static_cast<IRigidBody*>(body.requireAs(IRigidBody::kInterface))->setPose(world);
}

/// Bodies that are fixed to one that moves are its parts.
void addParts(Leaf& body, const PlacedBody& b) {
  if (b.parts.size() < 2 && b.parts.front().axes.isIdentity(0)) return;
  for (const engine::Part& part : b.parts) {
    const Vec3 c = part.center - b.mass.center;
    const Mat3& i = part.inertia;
    const Eigen::Quaterniond q(part.axes);
    callMethod(body, "addPart",
               List{part.mass, c.x(), c.y(), c.z(), i(0, 0), i(1, 1), i(2, 2), i(0, 1), i(0, 2), i(1, 2),
                    List{q.w(), q.x(), q.y(), q.z()}});
  }
}

std::string bodyPath(const std::string& transform) { return "../../" + transform + "/body"; }

/// `world`: pose of the child link's frame.
void setAxis(IJoint& made, const Joint& j, const Pose& world, const Flags& flags) {
  made.setWorldAxis(0, world.rotation * j.axis);
  if (j.limited && flags.limit) {
    made.setParameter(JointParameter::lowStop, 0, j.range[0]);
    made.setParameter(JointParameter::highStop, 0, j.range[1]);
  }
  made.setParameter(JointParameter::armature, 0, j.armature);
  made.setParameter(JointParameter::damping, 0, flags.passive ? j.damping : 0);
  made.setParameter(JointParameter::dryFriction, 0, flags.frictionLoss ? j.dryFriction : 0);
  if (Leaf* const numbers = extensionOf(made.leaf(), "MujocoAxis")) {
    const Firmness& n = j.firmness;
    setWritten(*numbers,
               n == Firmness() ? "" : "how firm limits and friction are (solref, solimp, margin): " + j.from.placed());
    setProperty(*numbers, "stopSolref", toList(n.stopSolref));
    setProperty(*numbers, "stopSolimp", toList(n.stopSolimp));
    setProperty(*numbers, "stopMargin", n.stopMargin);
    setProperty(*numbers, "frictionSolref", toList(n.frictionSolref));
    setProperty(*numbers, "frictionSolimp", toList(n.frictionSolimp));
  }
  // A spring is a law of its own, beside the joint's controller and its limits.
  if (flags.passive && (j.stiffness > 0 || j.springPosition != 0))
    callMethod(made.leaf(), "setSpring", List{0, j.stiffness, j.springPosition});
}

}  // namespace

void BodyBuilder::build() {
  for (PlacedBody& b : c_.bodies)
    if (c_.bodies.isCarrier(b)) makeBody(b);
  for (const PlacedBody& b : c_.bodies)
    if (b.node) makeJoints(b);
}

void BodyBuilder::makeBody(PlacedBody& p) {
  const Body& b = *p.body;
  if (!(p.mass.mass > 0)) throw b.from.error("a body that moves needs a mass above 0");
  mendSum(p);
  p.node = &transformAt(c_.names.body(c_.top, b.name, "body"), bodyPose(p));
  try {
    Leaf& body = makeRigidBody(*p.node, p, 1);
    setProperty(body, "linkOrigin", toList(Vec3(-p.mass.center)));
    addParts(body, p);
    setPose(body, bodyPose(p));
    compensateGravity(p, body);
  } catch (const Error& e) {
    throw Error(fmt::format("{}: cannot make the body '{}'", b.from.where(), b.name), e);
  }
}

/// Of a body with all that is fixed to it.
void BodyBuilder::mendSum(PlacedBody& p) {
  if (isUsable(p.mass)) return;
  const double before = p.mass.mass;
  mendMass(p.mass, p.body->from, c_.unsupported);
  for (engine::Part& part : p.parts) {
    part.mass *= p.mass.mass / before;
    part.inertia = part.mass / p.mass.mass * p.mass.inertia;
  }
}

/// A body has gravity or has none, so parts of it cannot be spared alone.
void BodyBuilder::compensateGravity(const PlacedBody& p, Leaf& body) {
  if (p.compensatedMass == 0 || !c_.flags.passive) return;
  if (std::abs(p.compensatedMass - p.mass.mass) <= 1e-9 * p.mass.mass)
    setProperty(body, "gravityOn", false);
  else
    c_.unsupported.add(p.body->from, fmt::format("{} has a gravcomp other than 1, or not of all bodies that move with "
                                                 "it, which is not supported",
                                                 p.body->from.named()));
}

void BodyBuilder::makeJoints(const PlacedBody& p) {
  const std::vector<Joint>& joints = p.body->joints;
  for (const Joint& j : joints)
    if (!c_.flags.passive && j.damping > 0)
      c_.unsupported.add(j.from,
                         "the flag passive=\"disable\" removes a damping as a whole; MuJoCo 2.2.2 keeps the "
                         "part of its implicit integration");
  if (joints.front().kind == JointKind::free) {
    Leaf& body = *p.node->child("body");
    setProperty(body, "linearDamping", c_.flags.passive ? joints.front().damping : 0.0);
    setProperty(body, "angularDamping", c_.flags.passive ? joints.front().damping : 0.0);
    if (!joints.front().name.empty()) c_.freeJoints.emplace(joints.front().name, &body);
    addFreedom(p, joints.front(), bodyPath(p.node->name()).substr(3));
    return;
  }
  std::string parent = p.above == 0 ? "" : bodyPath(c_.bodies[p.above].node->name());
  // A joint has one axis: between two of them there is a light body, which engines still compute with.
  const double share = std::max(kBetween, kMasses.least / p.mass.mass);
  for (std::size_t k = 0; k + 1 < joints.size(); ++k) {
    const std::string name = c_.names.body(c_.top, fmt::format("{}-{}", p.body->name, k + 1), "between");
    Node& between = transformAt(name, bodyPose(p));
    Leaf& connector = makeRigidBody(between, p, share);
    setProperty(connector, "connector", true);
    setPose(connector, bodyPose(p));
    makeJoint(p, joints[k], between, parent);
    parent = bodyPath(name);
  }
  if (joints.size() > 1)
    setProperty(*p.node->child("body"), "mass",
                std::max(kMasses.least, p.mass.mass * (1 - share * static_cast<double>(joints.size() - 1))));
  makeJoint(p, joints.back(), *p.node, parent);
}

void BodyBuilder::makeJoint(const PlacedBody& p, const Joint& j, Node& child, const std::string& parent) {
  const char* const kind = j.kind == JointKind::hinge   ? "HingeJoint"
                           : j.kind == JointKind::slide ? "SliderJoint"
                                                        : "BallJoint";
  try {
    auto& made = child.create<IJoint>(kind, c_.names.in(child, j.name, "joint"));
    callMethod(made.leaf(), "attach", List{"../body", parent});
    if (j.kind != JointKind::slide) made.setWorldAnchor(p.world.position + p.world.rotation * j.position);
    if (j.kind != JointKind::ball) setAxis(made, j, p.world, c_.flags);
    if (j.kind == JointKind::ball) {
      made.setParameter(JointParameter::damping, 0, c_.flags.passive ? j.damping : 0);
      addFreedom(p, j, fmt::format("../{}/{}", child.name(), made.leaf().name()));
    }
    if (!j.name.empty() && !c_.joints.emplace(j.name, Construction::MadeJoint{&j, &made}).second)
      throw Error(fmt::format("there are two joints '{}'", j.name));
  } catch (const Error& e) {
    throw Error(fmt::format("{}: cannot make the joint '{}'", j.from.where(), j.name), e);
  }
}

void BodyBuilder::addFreedom(const PlacedBody& p, const Joint& j, const std::string& of) {
  const double stiffness = c_.flags.passive ? j.stiffness : 0, friction = c_.flags.frictionLoss ? j.dryFriction : 0;
  const bool limited = j.limited && c_.flags.limit;
  if (j.armature == 0 && stiffness == 0 && friction == 0 && !limited) return;
  constexpr const char* kClass = "MujocoFreedom";
  if (!provides(c_.top.kernel(), kClass))
    return c_.unsupported.add(j.from,
                              "armature, friction, spring and limit of a ball or free joint need the plugin "
                              "physics-mujoco, which is not there");
  Leaf& node = c_.top.create(kClass, c_.names.in(c_.top, "", "freedom"));
  const Pose rest = j.kind == JointKind::free ? p.world : compose(inverse(c_.bodies[p.above].world), p.world);
  const Eigen::Quaterniond q(rest.rotation);
  setWritten(node, "armature, friction, spring and limit of a ball or free joint: " + j.from.placed());
  setProperty(node, "armature", j.armature);
  setProperty(node, "frictionLoss", friction);
  setProperty(node, "stiffness", stiffness);
  setProperty(node, "restRotation", List{q.w(), q.x(), q.y(), q.z()});
  setProperty(node, "restPosition", toList(rest.position));
  setProperty(node, "mostAngle", limited ? j.range[1] : 0.0);
  const Firmness& n = j.firmness;
  setProperty(node, "stopSolref", toList(n.stopSolref));
  setProperty(node, "stopSolimp", toList(n.stopSolimp));
  setProperty(node, "stopMargin", n.stopMargin);
  setProperty(node, "frictionSolref", toList(n.frictionSolref));
  setProperty(node, "frictionSolimp", toList(n.frictionSolimp));
  setProperty(node, "of", of);
}

Node& BodyBuilder::transformAt(const std::string& name, const Pose& world) {
  return c_.transform(c_.top, name, compose(inverse(c_.bodies.root()), world));
}

}  // namespace spark::mjcf
