#include "builder.h"

#include <fmt/ranges.h>

#include <algorithm>

#include "../physics/mass.h"
#include "spark/access.h"

namespace spark::mjcf {

using engine::JointParameter;
using engine::Shape;

namespace {

/// Of a body with several joints, the part of the mass that each body between them has.
constexpr double kBetween = 0.01;

Pose inverse(const Pose& p) { return {-(p.rotation.transpose() * p.position), p.rotation.transpose()}; }
List numbers(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
template <std::size_t N>
List numbers(const std::array<double, N>& a) {
  return List(a.begin(), a.end());
}
List matrix(const Mat3& r) {
  List out;
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) out.emplace_back(r(row, column));
    out.emplace_back(0.0);
  }
  for (const double v : {0.0, 0.0, 0.0, 1.0}) out.emplace_back(v);
  return out;
}

}  // namespace

// ---- bodies ----

void Builder::build(Node& root) {
  Node& top = *root.create("Space", nameOf(model_.name, "model")).asNode();
  top_ = &top;
  try {
    auto* const above = static_cast<SceneNode&>(*top.asNode()).transform();
    placeBodies(above ? toPose(above->worldNow()) : Pose{});
    for (Part& p : parts_)
      if (p.carrier != 0 && &parts_[static_cast<std::size_t>(p.carrier)] == &p) makeBody(p);
    for (Part& p : parts_)
      if (p.node) makeJoints(p);
    for (Part& p : parts_) makeGeoms(p), makeSites(p);
    exclude();
    pair();
    makeActuators();
    makeSensors();
    if (!model_.options.empty() && !prefix_.empty())
      leftOver_.add(model_.options.front().from,
                    "the options of an attached model are left out: the world has its own");
    if (const auto left = leftOver_.sentences(); strict_ && !left.empty())
      throw Error(fmt::format("{}", fmt::join(left, "; ")));
    if (prefix_.empty()) setOptions(root);
  } catch (...) {
    root.remove(top);
    throw;
  }
}

std::string Builder::nameOf(const std::string& given, const char* kind) {
  std::string name = prefix_ + (given.empty() ? fmt::format("{}{}", kind, ++unnamed_) : given);
  // What paths are made of.
  for (char& c : name)
    if (c == '/' || c == '[' || c == ']') c = '_';
  if (name == "." || name == "..") name += '_';
  return name;
}

/// A name that no other has: of bodies, which joints name, and of colliders, which exclude each other by name.
std::string Builder::uniqueName(std::set<std::string>& taken, const std::string& given, const char* kind) {
  const std::string name = nameOf(given, kind);
  std::string unique = name;
  for (int i = 2; !taken.insert(unique).second; ++i) unique = fmt::format("{}~{}", name, i);
  return unique;
}

void Builder::placeBodies(const Pose& root) {
  rootPose_ = root;
  parts_.resize(model_.bodies.size());
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    Part& p = parts_[i];
    const Body& b = model_.bodies[i];
    p.body = &b;
    if (i == 0) {
      p.world = root;
      continue;
    }
    const Part& parent = parts_[static_cast<std::size_t>(b.parent)];
    p.world = compose(parent.world, b.pose);
    const bool free =
        std::any_of(b.joints.begin(), b.joints.end(), [](const Joint& j) { return j.kind == JointKind::free; });
    if (free && (b.parent != 0 || b.joints.size() > 1))
      throw b.from.error("expected a free joint as the only one of a body in the world");
    if (b.joints.empty()) {
      p.carrier = parent.carrier;
      p.inCarrier = compose(parent.inCarrier, b.pose);
    } else {
      p.carrier = static_cast<int>(i);
      p.above = parent.carrier;
    }
    if (p.carrier == 0) continue;
    // Masses of parts move to the carrier.
    Part& carrier = parts_[static_cast<std::size_t>(p.carrier)];
    const Mat3& r = p.inCarrier.rotation;
    carrier.mass = physics::together(
        carrier.mass, {b.mass.mass, p.inCarrier.position + r * b.mass.center, r * b.mass.inertia * r.transpose()});
    if (!b.name.empty() && !bodies_.emplace(b.name, &p).second)
      throw b.from.error(fmt::format("there are two bodies '{}'", b.name));
  }
}

Node& Builder::transform(Node& parent, const std::string& name, const Pose& local) {
  Node& node = *parent.create("Transform", name).asNode();
  // As a body would do it: nothing below takes the pose, which is in single precision.
  static_cast<Transform*>(node.requireAs(Transform::kInterface))->setLocalFromBody(toMatrix(local));
  return node;
}

void Builder::makeBody(Part& p) {
  const Body& b = *p.body;
  if (!(p.mass.mass > 0)) throw b.from.error("a body that moves needs a mass above 0");
  // The frame of a body of ours is that of the link, with the centre of mass as origin.
  const Pose world = compose(p.world, {p.mass.center, Mat3::Identity()});
  p.node = &transform(*top_, uniqueName(bodyNames_, b.name, "body"), compose(inverse(rootPose_), world));
  try {
    Leaf& body = p.node->create("RigidBody", "body");
    const Mat3& i = p.mass.inertia;
    callMethod(body, "setMassParameters",
               List{p.mass.mass, 0.0, 0.0, 0.0, i(0, 0), i(1, 1), i(2, 2), i(0, 1), i(0, 2), i(1, 2)});
    setProperty(body, "linkOrigin", numbers(-p.mass.center));
    static_cast<IRigidBody*>(body.requireAs(IRigidBody::kInterface))->setPose(world);
  } catch (const Error& e) {
    throw Error(fmt::format("{}: cannot make the body '{}'", b.from.where(), b.name), e);
  }
}

// ---- joints ----

void Builder::makeJoints(Part& p) {
  const std::vector<Joint>& joints = p.body->joints;
  if (joints.front().kind == JointKind::free) {
    freeJoints_.insert(joints.front().name);
    return;
  }
  const std::string above = p.above == 0 ? "" : parts_[static_cast<std::size_t>(p.above)].node->name();
  std::string parent = above.empty() ? "" : "../../" + above + "/body";
  // A joint has one axis: between two of them there is a light body.
  for (std::size_t k = 0; k + 1 < joints.size(); ++k) {
    if (k == 0)
      leftOver_.add(joints[0].from,
                    fmt::format("a body with {} joints gets light bodies between them, each with {} of its mass",
                                joints.size(), kBetween));
    const Pose world = compose(p.world, {p.mass.center, Mat3::Identity()});
    const std::string name = uniqueName(bodyNames_, fmt::format("{}-{}", p.body->name, k + 1), "between");
    Node& between = transform(*top_, name, compose(inverse(rootPose_), world));
    Leaf& body = between.create("RigidBody", "body");
    const Mat3 i = kBetween * p.mass.inertia;
    callMethod(body, "setMassParameters",
               List{kBetween * p.mass.mass, 0.0, 0.0, 0.0, i(0, 0), i(1, 1), i(2, 2), i(0, 1), i(0, 2), i(1, 2)});
    static_cast<IRigidBody*>(body.requireAs(IRigidBody::kInterface))->setPose(world);
    makeJoint(p, joints[k], between, parent);
    parent = "../../" + name + "/body";
  }
  if (joints.size() > 1)
    setProperty(*p.node->child("body"), "mass", p.mass.mass * (1 - kBetween * static_cast<double>(joints.size() - 1)));
  makeJoint(p, joints.back(), *p.node, parent);
}

void Builder::makeJoint(Part& p, const Joint& j, Node& child, const std::string& parent) {
  const char* const kind = j.kind == JointKind::hinge   ? "HingeJoint"
                           : j.kind == JointKind::slide ? "SliderJoint"
                                                        : "BallJoint";
  try {
    auto& made = child.create<IJoint>(kind, nameOf(j.name, "joint"));
    Leaf& leaf = made.leaf();
    callMethod(leaf, "attach", List{"../body", parent});
    if (j.kind != JointKind::slide) made.setWorldAnchor(p.world.position + p.world.rotation * j.position);
    if (j.kind != JointKind::ball) {
      made.setWorldAxis(0, p.world.rotation * j.axis);
      if (j.limited) {
        made.setParameter(JointParameter::lowStop, 0, j.range[0]);
        made.setParameter(JointParameter::highStop, 0, j.range[1]);
      }
      made.setParameter(JointParameter::armature, 0, j.armature);
      made.setParameter(JointParameter::damping, 0, j.damping);
      made.setParameter(JointParameter::dryFriction, 0, j.dryFriction);
      const engine::MujocoAxis& n = j.numbers;
      callMethod(leaf, "setMujocoStopSolref", List{0, numbers(n.stopSolref)});
      callMethod(leaf, "setMujocoStopSolimp", List{0, numbers(n.stopSolimp)});
      callMethod(leaf, "setMujocoStopMargin", List{0, n.stopMargin});
      callMethod(leaf, "setMujocoFrictionSolref", List{0, numbers(n.frictionSolref)});
      callMethod(leaf, "setMujocoFrictionSolimp", List{0, numbers(n.frictionSolimp)});
      // A passive joint: its spring, or nothing beside dry friction.
      made.control(0, {.stiffness = j.stiffness, .position = j.springAngle});
    }
    if (!j.name.empty() && !joints_.emplace(j.name, MadeJoint{&j, &made}).second)
      throw Error(fmt::format("there are two joints '{}'", j.name));
  } catch (const Error& e) {
    throw Error(fmt::format("{}: cannot make the joint '{}'", j.from.where(), j.name), e);
  }
}

// ---- geoms and sites ----

void Builder::makeGeoms(Part& p) {
  const Part& carrier = parts_[static_cast<std::size_t>(p.carrier)];
  // Where a body is drawn by meshes alone, which viewers do not have, its collision shapes are shown.
  const bool drawn = std::any_of(p.body->geoms.begin(), p.body->geoms.end(), [](const Geom& g) { return g.visible(); });
  for (const Geom& g : p.body->geoms) {
    // In the frame of the carrier's body, or in the world.
    const Pose pose = p.carrier == 0
                          ? compose(p.world, g.pose)
                          : compose(Pose{-carrier.mass.center, Mat3::Identity()}, compose(p.inCarrier, g.pose));
    try {
      if (g.collides() || inPair(g.name)) makeCollider(g, p, pose);
      if (g.visible() || !drawn)
        makeVisible(g, carrier.node ? *carrier.node : *top_, carrier.node ? pose : compose(inverse(rootPose_), pose));
    } catch (const Error& e) {
      throw Error(fmt::format("{}: cannot make the geom '{}'", g.from.where(), g.name), e);
    }
  }
}

void Builder::makeCollider(const Geom& g, Part& part, const Pose& pose) {
  const Part& carrier = parts_[static_cast<std::size_t>(part.carrier)];
  const engine::ShapeDescription& s = g.shape;
  const char* const kinds[] = {
      "BoxCollider", "SphereCollider", "CapsuleCollider", "CylinderCollider", "PlaneCollider", "", "TriMeshCollider"};
  Node& parent = carrier.node ? *carrier.node : *top_;
  Node& c = *parent.create(kinds[static_cast<int>(s.shape)], uniqueName(colliderNames_, g.name, "geom")).asNode();
  part.colliders.push_back(&c);
  if (!g.name.empty() && !geoms_.emplace(g.name, &c).second)
    throw Error(fmt::format("there are two geoms '{}'", g.name));
  switch (s.shape) {
    case Shape::box:
      callMethod(c, "setBoxLengths", numbers(s.lengths));
      break;
    case Shape::sphere:
      callMethod(c, "setRadius", List{s.radius});
      break;
    case Shape::capsule:
    case Shape::cylinder:
      callMethod(c, "setParams", List{s.radius, s.length});
      break;
    case Shape::plane: {
      const Vec3 normal = pose.rotation.col(2);
      callMethod(c, "setParams", List{normal.x(), normal.y(), normal.z(), normal.dot(pose.position)});
      break;
    }
    default: {
      List vertices(s.vertices.begin(), s.vertices.end()), triangles;
      for (const std::uint32_t t : s.triangles) triangles.emplace_back(static_cast<std::int64_t>(t));
      setProperty(c, "vertices", vertices);
      setProperty(c, "triangles", triangles);
      break;
    }
  }
  if (s.shape != Shape::plane) {
    callMethod(c, "setRotation", matrix(pose.rotation));
    callMethod(c, "setLocalPosition", numbers(pose.position));
  }
  const engine::Geom::Mujoco& m = g.contact;
  setProperty(c, "mujocoFriction", numbers(m.friction));
  setProperty(c, "mujocoCondim", m.condim);
  setProperty(c, "mujocoPriority", m.priority);
  setProperty(c, "mujocoSolref", numbers(m.solref));
  setProperty(c, "mujocoSolimp", numbers(m.solimp));
  setProperty(c, "mujocoMargin", m.margin);
  setProperty(c, "mujocoGap", m.gap);
  setProperty(c, "contactTypes", g.contactTypes);
  setProperty(c, "contactAffinities", g.contactAffinities);
  // For the other engines.
  Leaf& surface = c.create("ContactJointHandler", "surface");
  setProperty(surface, "contactBounceMode", false);
  setProperty(surface, "contactMu", m.condim == 1 ? 0.0 : m.friction[0]);
  setProperty(surface, "contactPyramid", true);
}

void Builder::makeVisible(const Geom& g, Node& parent, const Pose& pose) {
  const engine::ShapeDescription& s = g.shape;
  const char* const kinds[] = {"Box", "Sphere", "Capsule", "Cylinder"};
  const auto kind = static_cast<std::size_t>(s.shape);
  if (kind >= std::size(kinds)) return;
  Leaf& shape = transform(parent, nameOf(g.name.empty() ? "" : g.name + "-shape", "shape"), pose).create(kinds[kind]);
  if (s.shape == Shape::box)
    callMethod(shape, "setExtents", numbers(s.lengths));
  else if (s.shape == Shape::sphere)
    callMethod(shape, "setRadius", List{s.radius});
  else
    callMethod(shape, "setParams", List{s.radius, s.length});
  callMethod(shape, "setMaterial", List{"matGrey"});
}

void Builder::makeSites(const Part& p) {
  const Part& carrier = parts_[static_cast<std::size_t>(p.carrier)];
  for (const Site& s : p.body->sites) {
    Node& made = carrier.node
                     ? transform(*carrier.node, nameOf(s.name, "site"),
                                 compose(Pose{-carrier.mass.center, Mat3::Identity()}, compose(p.inCarrier, s.pose)))
                     : transform(*top_, nameOf(s.name, "site"), compose(inverse(rootPose_), compose(p.world, s.pose)));
    if (!s.name.empty()) sites_.emplace(s.name, &made);
  }
}

Builder::Part* Builder::partOf(const std::string& body, const Element& user) {
  if (body == "world") return &parts_.front();
  const auto found = bodies_.find(body);
  if (found != bodies_.end()) return found->second;
  for (Part& p : parts_)  // a static one
    if (p.body->name == body && !body.empty()) return &p;
  throw user.error(fmt::format("there is no body '{}'", body));
}

bool Builder::inPair(const std::string& geom) const {
  return !geom.empty() && std::any_of(model_.pairs.begin(), model_.pairs.end(),
                                      [&](const Pair& p) { return p.geom1 == geom || p.geom2 == geom; });
}

void Builder::pair() {
  for (const Pair& p : model_.pairs) {
    const auto first = geoms_.find(p.geom1), second = geoms_.find(p.geom2);
    if (first == geoms_.end() || second == geoms_.end())
      throw p.from.error(fmt::format("there is no geom '{}'", first == geoms_.end() ? p.geom1 : p.geom2));
    callMethod(*first->second, "addCollideWithColliderName", List{second->second->name(), true});
  }
}

void Builder::exclude() {
  for (const Exclusion& x : model_.exclusions) {
    const Part &a = *partOf(x.body1, x.from), &b = *partOf(x.body2, x.from);
    for (Node* first : a.colliders)
      for (const Node* second : b.colliders)
        callMethod(*first, "addNotCollideWithColliderName", List{second->name(), true});
  }
}

// ---- actuators and sensors ----

bool Builder::has(const char* className) {
  const Kernel& kernel = top_->kernel();
  const char* const base = std::string_view(className).ends_with("Effector") ? "Effector" : "Perceptor";
  if (kernel.findClass(base) && kernel.findClass(className)) return true;
  withoutParts_ = true;
  return false;
}

void Builder::makeActuators() {
  // By joint, in the order of the file.
  std::vector<std::pair<std::string, std::vector<const Actuator*>>> groups;
  for (const Actuator& x : model_.actuators) {
    auto found = std::find_if(groups.begin(), groups.end(), [&](const auto& g) { return g.first == x.joint; });
    if (found == groups.end()) found = groups.insert(groups.end(), {x.joint, {}});
    found->second.push_back(&x);
  }
  for (const auto& [name, all] : groups) {
    const auto joint = joints_.find(name);
    if (joint != joints_.end())
      makeActuator(all, joint->second);
    else if (freeJoints_.contains(name))
      leftOver_.add(all.front()->from, fmt::format("a <{}> on a free joint is left out", all.front()->from.tag()));
    else
      throw all.front()->from.error(fmt::format("there is no joint '{}' to act on", name));
  }
}

void Builder::makeActuator(const std::vector<const Actuator*>& all, const MadeJoint& on) {
  const Actuator& first = *all.front();
  if (on.joint->kind == JointKind::ball)
    return leftOver_.add(first.from, fmt::format("a <{}> on a ball joint is left out", first.from.tag()));
  const double maxForce = std::min(on.joint->maxForce, all.size() == 1 ? first.maxForce : HUGE_VAL);
  const double spring = on.joint->stiffness;
  Node& parent = *on.made->leaf().asNode();

  // name_pos, name_vel and name_tau: one controller.
  const auto ending = [&](const char* end, bool (*fits)(const Actuator&)) -> const Actuator* {
    for (const Actuator* x : all)
      if (x->name.ends_with(end) && fits(*x)) return x;
    return nullptr;
  };
  const Actuator* position = ending("_pos", [](const Actuator& x) { return x.bias[1] == -x.gain && x.bias[2] == 0; });
  const Actuator* velocity = ending("_vel", [](const Actuator& x) { return x.bias[2] == -x.gain && x.bias[1] == 0; });
  const Actuator* torque = ending("_tau", [](const Actuator& x) { return x.bias == std::array<double, 3>{}; });
  const bool plain = std::all_of(all.begin(), all.end(), [](const Actuator* x) {
    return x->gear == 1 && std::isinf(x->maxForce) && std::isinf(x->controlRange[1]);
  });
  if (all.size() == 3 && position && velocity && torque && plain && torque->gain == 1) {
    if (spring > 0)
      leftOver_.add(on.joint->from,
                    "the attribute 'stiffness' of <joint> is left out where the joint has a controller");
    on.made->control(0, {.stiffness = position->gain, .damping = velocity->gain, .maxForce = maxForce});
    if (!has("ControlEffector")) return;
    Leaf& effector = parent.create("ControlEffector", position->name.substr(0, position->name.size() - 4));
    setProperty(effector, "maxForce", maxForce);
    return;
  }
  for (std::size_t i = 1; i < all.size(); ++i)
    leftOver_.add(all[i]->from, fmt::format("a second <{}> on a joint is left out", all[i]->from.tag()));
  const double gear2 = first.gear * first.gear;
  const double bias = first.gear * first.bias[0] + spring * on.joint->springAngle;
  const double atFirst = std::clamp(0.0, first.controlRange[0], first.controlRange[1]);
  const engine::Control law{.stiffness = spring - gear2 * first.bias[1],
                            .damping = -gear2 * first.bias[2],
                            .force = bias + first.gear * first.gain * atFirst,
                            .maxForce = maxForce};
  if (law.stiffness < 0 || law.damping < 0)
    return leftOver_.add(first.from, "an actuator that drives a joint away from its target is left out");
  on.made->control(0, law);
  if (!has("ActuatorEffector")) return;
  Leaf& effector = parent.create("ActuatorEffector", first.name.empty() ? on.joint->name : first.name);
  setProperty(effector, "gain", first.gear * first.gain);
  setProperty(effector, "bias", bias);
  setProperty(effector, "stiffness", law.stiffness);
  setProperty(effector, "damping", law.damping);
  setProperty(effector, "maxForce", maxForce);
  setProperty(effector, "least", first.controlRange[0]);
  setProperty(effector, "most", first.controlRange[1]);
}

Node& Builder::frame(const Sensor& s) {
  if (const auto site = sites_.find(s.object); site != sites_.end()) return *site->second;
  const Part& part = *partOf(s.object, s.from);
  const Part& carrier = parts_[static_cast<std::size_t>(part.carrier)];
  if (!carrier.node) throw s.from.error(fmt::format("the body '{}' does not move", s.object));
  const Pose link = compose(Pose{-carrier.mass.center, Mat3::Identity()}, part.inCarrier);
  Node& made = transform(*carrier.node, nameOf(s.object + "-link", ""), link);
  sites_.emplace(s.object, &made);
  return made;
}

void Builder::makeSensors() {
  for (const Sensor& s : model_.sensors) {
    if (s.kind == "jointpos" || s.kind == "jointvel") {
      const auto joint = joints_.find(s.object);
      if (joint == joints_.end()) throw s.from.error(fmt::format("there is no joint '{}'", s.object));
      // One perceptor tells angle and rate.
      Node& parent = *joint->second.made->leaf().asNode();
      const bool known = std::any_of(parent.children().begin(), parent.children().end(),
                                     [](const auto& c) { return c->classObject()->name() == "JointPerceptor"; });
      if (!known && has("JointPerceptor")) parent.create("JointPerceptor", s.name);
    } else if (s.kind == "gyro" || s.kind == "accelerometer") {
      const char* const kind = s.kind == "gyro" ? "GyroRatePerceptor" : "Accelerometer";
      if (!has(kind)) continue;
      Node& site = frame(s);
      if (!toPose(static_cast<Transform*>(site.requireAs(Transform::kInterface))->local()).rotation.isIdentity(1e-6))
        leftOver_.add(s.from, fmt::format("the rotation of the site of a <{}> is left out", s.kind));
      site.parent()->create(kind, s.name);
    } else if (s.kind == "framepos" || s.kind == "framequat") {
      const char* const kind = s.kind == "framepos" ? "PositionPerceptor" : "OrientationPerceptor";
      if (!has(kind)) continue;
      if (s.objectType == "body")
        leftOver_.add(s.from, fmt::format("the inertial frame of a body is left out; <{}> has the link's", s.kind));
      frame(s).create(kind, s.name);
    } else {
      leftOver_.element(s.from);
    }
  }
}

// ---- options ----

void Builder::setOptions(Node& root) {
  Leaf* world = nullptr;
  for (Node* up = &root; up && !world; up = up->parent())
    for (const auto& child : up->children())
      if (!world && child->classObject()->name() == "World") world = child.get();
  if (!world) return;
  std::vector<std::pair<const char*, Value>> before;
  for (const Option& o : model_.options) {
    try {
      before.emplace_back(o.property, getProperty(*world, o.property));
      setProperty(*world, o.property, o.value);
    } catch (const Error& e) {
      for (auto old = before.rbegin(); old != before.rend(); ++old) setProperty(*world, old->first, old->second);
      throw Error(o.from.where() + ": cannot set an option", e);
    }
  }
}

}  // namespace spark::mjcf
