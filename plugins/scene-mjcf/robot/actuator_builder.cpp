#include "actuator_builder.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "spark/access.h"

namespace spark::mjcf {

namespace {

bool isLimited(const std::array<double, 2>& range) { return std::isfinite(range[0]) || std::isfinite(range[1]); }

/// As std::clamp, for ranges of any order.
double clampTo(const std::array<double, 2>& range, double v) { return std::max(range[0], std::min(range[1], v)); }

/// The range of an actuator's force along its joint.
std::array<double, 2> jointRange(const Actuator& x) {
  const double a = x.gear * x.forceRange[0], b = x.gear * x.forceRange[1];
  return {std::min(a, b), std::max(a, b)};
}

/// True when the force depends on the joint's position or rate.
bool hasFeedback(const Actuator& x) { return x.gain[1] != 0 || x.gain[2] != 0 || x.bias[1] != 0 || x.bias[2] != 0; }

}  // namespace

void ActuatorBuilder::build() {
  if (!c_.flags.actuation) return;
  // By joint, in the order of the file.
  std::vector<std::pair<std::string, Actuators>> groups;
  for (const Actuator& x : c_.model.actuators) {
    bool plain = false;
    c_.attempt(x.from, c_.top, [&] {
      plain = !isOfEngine(x);
      if (!plain) makeEngineActuator(x);
    });
    if (!plain) continue;
    auto found = std::find_if(groups.begin(), groups.end(), [&](const auto& g) { return g.first == x.joint; });
    if (found == groups.end()) found = groups.insert(groups.end(), {x.joint, {}});
    found->second.push_back(&x);
  }
  for (const auto& [name, all] : groups) onJoint(all, c_.joints.find(name)->second);
}

/// True for what no controller of a joint can be. Throws Error where it drives a joint that is not there.
bool ActuatorBuilder::isOfEngine(const Actuator& x) const {
  if (x.engine.type != "joint" && x.engine.type != "jointinparent") return true;
  const auto joint = c_.joints.find(x.joint);
  if (joint == c_.joints.end() && !c_.freeJoints.contains(x.joint))
    throw x.from.error(fmt::format("there is no joint '{}' to act on", x.joint));
  return !x.engine.isPlain() || joint == c_.joints.end() || joint->second.joint->kind == JointKind::ball;
}

void ActuatorBuilder::makeEngineActuator(const Actuator& x) {
  constexpr const char* kClass = "MujocoActuator";
  if (!provides(c_.top.kernel(), kClass))
    return c_.unsupported.add(x.from,
                              fmt::format("{} needs the plugin physics-mujoco, which is not there", x.from.named()));
  const Actuator::Engine& n = x.engine;
  // What it names is looked up first: an error leaves nothing behind.
  std::vector<std::pair<const char*, Value>> settings;
  const auto at = [&](const std::string& site, const char* path, const char* point, const char* rotation) {
    const auto [body, found] = c_.site(site, x.from);
    const Pose pose = compose(Construction::frameOf(*body), found->pose);
    const Eigen::Quaterniond q(pose.rotation);
    settings.insert(
        settings.end(),
        {{path, c_.path(*body)}, {point, toList(pose.position)}, {rotation, List{q.w(), q.x(), q.y(), q.z()}}});
  };
  double offset = 0;  // MuJoCo's length in the pose of the file, less that here
  if (n.type == "tendon") {
    const auto tendon = c_.tendons.find(n.target);
    if (tendon == c_.tendons.end()) {
      const auto& all = c_.model.tendons;
      if (!c_.model.skippedTendons.contains(n.target) &&
          std::none_of(all.begin(), all.end(), [&](const Tendon& t) { return t.name == n.target; }))
        throw x.from.error(fmt::format("there is no tendon '{}'", n.target));
      return c_.unsupported.add(x.from, fmt::format("{} acts on a tendon that is left out", x.from.named()));
    }
    if (!tendon->second) return;
    settings.emplace_back("target", "../" + tendon->second->name());
    for (const Tendon& t : c_.model.tendons)
      if (t.name == n.target && !t.spatial)
        for (const TendonPart& part : t.parts)
          if (const auto joint = c_.joints.find(part.name); joint != c_.joints.end())
            offset += n.gear[0] * part.coefficient * joint->second.joint->reference;
  } else if (n.type == "site" || n.type == "slidercrank") {
    at(n.target, "target", "point", "rotation");
    if (!n.reference.empty()) {
      at(n.reference, "reference", "point2", "rotation2");
      settings.emplace_back("hasReference", true);
    } else if (n.type == "slidercrank") {
      throw x.from.error("expected an attribute 'slidersite'");
    }
    settings.emplace_back("crankLength", n.crankLength);
  } else if (n.type == "body") {
    const PlacedBody& body = c_.bodies.find(n.target, x.from);
    settings.emplace_back("target", c_.path(body));
    settings.emplace_back("part", body.part);
  } else if (const auto free = c_.freeJoints.find(x.joint); free != c_.freeJoints.end()) {
    settings.emplace_back("target", "../" + free->second->parent()->name() + "/" + free->second->name());
  } else {
    const Construction::MadeJoint& joint = c_.joints.find(x.joint)->second;
    settings.emplace_back("target", "../" + joint.made->leaf().parent()->name() + "/" + joint.made->leaf().name());
    offset = n.gear[0] * joint.joint->reference;
    const bool muscle = n.gainType == "muscle" || n.biasType == "muscle";
    if (muscle && !joint.joint->limited && !(n.lengthRange[0] < n.lengthRange[1]))
      throw x.from.error("expected a 'lengthrange' of the muscle, or a limit of the joint that it moves");
  }
  auto gain = n.gain, bias = n.bias;
  if (n.gainType == "affine") gain[0] += gain[1] * offset;
  if (n.biasType == "affine") bias[0] += bias[1] * offset;
  const std::string name = x.name.empty() ? x.joint : x.name;
  Node& place = c_.transform(c_.top, c_.names.in(c_.top, name, "actuator"), Pose{});
  Leaf& node = place.create(kClass, "actuator");
  setWritten(node, x.from.placed());
  setProperty(node, "type", n.type);
  for (const auto& [property, value] : settings) {
    const bool path = std::string_view(property) == "target" || std::string_view(property) == "reference";
    setProperty(node, property, path && !value.plain().empty() ? Value("../" + value.plain()) : value);
  }
  setProperty(node, "gear", toList(n.gear));
  setProperty(node, "dynamics", n.dynamics);
  setProperty(node, "gain", n.gainType);
  setProperty(node, "bias", n.biasType);
  setProperty(node, "dynamicsNumbers", toList(n.dynamicsNumbers));
  setProperty(node, "gainNumbers", toList(gain));
  setProperty(node, "biasNumbers", toList(bias));
  const auto range = [&](const char* property, const std::array<double, 2>& r) {
    if (isLimited(r)) setProperty(node, property, toList(r));
  };
  range("controlRange", controlRange(x));
  range("forceRange", x.forceRange);
  range("activationRange", n.activationRange);
  range("lengthRange", {n.lengthRange[0] - offset, n.lengthRange[1] - offset});
  if (c_.has("EngineActuatorEffector")) makeEffector("EngineActuatorEffector", name, place, x.from);
}

void ActuatorBuilder::onJoint(const Actuators& all, const Construction::MadeJoint& on) {
  if (const auto parts = partsOf(all)) return makeController(*parts, on);
  engine::Control sum;
  sum.maxForce = on.joint->maxForce;
  for (const Actuator* x : all) {
    auto law = lawOf(*x, *on.joint, all.size() == 1);
    if (!law) continue;
    law->maxForce = std::min(law->maxForce, on.joint->maxForce);
    const double u = std::max(law->least, std::min(law->most, 0.0));
    sum.maxForce = std::min(sum.maxForce, law->maxForce);
    if (!sum.addLaw({law->bias + law->gain * u, law->stiffness + law->gainStiffness * u,
                     law->damping + law->gainDamping * u, law->leastForce, law->mostForce}))
      c_.unsupported.add(x->from, fmt::format("{} is one of more than {} actuators of a joint with force ranges, or "
                                              "that drive it away from a target: it has no range, and does not",
                                              x->from.named(), engine::Control::kMaxTerms));
    makeActuator(*x, *law, on);
  }
  on.made->control(0, sum);
}

std::array<double, 2> ActuatorBuilder::controlRange(const Actuator& x) const {
  return c_.flags.clampControl ? x.controlRange : std::array{-HUGE_VAL, HUGE_VAL};
}

/// Of an actuator without feedback: the range of controls that keeps its force within bounds as well.
std::array<double, 2> ActuatorBuilder::constantRange(const Actuator& x) const {
  const std::array<double, 2> range = controlRange(x);
  if (x.gain[0] == 0 || !isLimited(x.forceRange)) return range;
  std::array<double, 2> byForce{(x.forceRange[0] - x.bias[0]) / x.gain[0], (x.forceRange[1] - x.bias[0]) / x.gain[0]};
  if (x.gain[0] < 0) std::swap(byForce[0], byForce[1]);
  return {clampTo(byForce, range[0]), clampTo(byForce, range[1])};
}

/// nullopt for an actuator that is not supported. `alone`: it is the only one of its joint.
std::optional<ActuatorBuilder::Law> ActuatorBuilder::lawOf(const Actuator& x, const Joint& joint, bool alone) {
  const double gear = x.gear, square = gear * gear, offset = gear * joint.reference;
  Law law{.gain = gear * (x.gain[0] + x.gain[1] * offset),
          .bias = gear * (x.bias[0] + x.bias[1] * offset),
          .stiffness = -square * x.bias[1],
          .damping = -square * x.bias[2],
          .gainStiffness = -square * x.gain[1],
          .gainDamping = -square * x.gain[2]};
  const bool feedback = hasFeedback(x);
  const std::array<double, 2> range = feedback ? controlRange(x) : constantRange(x);
  law.least = range[0], law.most = range[1];
  if (!feedback && x.gain[0] == 0) law.bias = gear * clampTo(x.forceRange, x.bias[0]);
  if (!feedback || !isLimited(x.forceRange)) return law;
  if (alone && x.forceRange[0] == -x.forceRange[1])
    law.maxForce = std::min(law.maxForce, std::abs(gear) * x.forceRange[1]);
  else
    law.leastForce = jointRange(x)[0], law.mostForce = jointRange(x)[1];
  return law;
}

/// The parts of a controller, where they are all that acts on a joint.
std::optional<ActuatorBuilder::Parts> ActuatorBuilder::partsOf(const Actuators& all) const {
  const auto ending = [&](const char* end, bool (*fits)(const Actuator&)) -> const Actuator* {
    for (const Actuator* x : all)
      if (x->name.ends_with(end) && x->gain[1] == 0 && x->gain[2] == 0 && x->gear != 0 && fits(*x)) return x;
    return nullptr;
  };
  using A = Actuator;
  const Parts p{ending("_pos",
                       [](const A& x) {
                         return x.bias == std::array{0.0, -x.gain[0], 0.0} && x.gain[0] >= 0;
                       }),
                ending("_vel",
                       [](const A& x) {
                         return x.bias == std::array{0.0, 0.0, -x.gain[0]} && x.gain[0] >= 0;
                       }),
                ending("_tau", [](const A& x) {
                  return x.bias == std::array{0.0, 0.0, 0.0};
                })};
  if (all.size() != 3 || !p.position || !p.velocity || !p.torque) return std::nullopt;
  return p;
}

void ActuatorBuilder::makeController(const Parts& p, const Construction::MadeJoint& on) {
  const double g = p.position->gear, h = p.velocity->gear, t = p.torque->gear * p.torque->gain[0];
  const std::array<double, 2> angle = controlRange(*p.position), rate = controlRange(*p.velocity),
                              torque = constantRange(*p.torque);
  engine::Control law{.position = clampTo(angle, 0) / g - on.joint->reference,
                      .velocity = clampTo(rate, 0) / h,
                      .force = t * clampTo(torque, 0),
                      .maxForce = on.joint->maxForce};
  const double stiffness = g * g * p.position->gain[0], damping = h * h * p.velocity->gain[0];
  // The range of a torque without feedback is that of its control.
  const std::array<double, 2> byPosition = jointRange(*p.position), byRate = jointRange(*p.velocity);
  if (isLimited(byPosition))
    law.add({stiffness * law.position, stiffness, 0, byPosition[0], byPosition[1]});
  else
    law.stiffness = stiffness;
  if (isLimited(byRate))
    law.add({damping * law.velocity, 0, damping, byRate[0], byRate[1]});
  else
    law.damping = damping;
  on.made->control(0, law);
  if (!c_.has("ControlEffector")) return;
  const std::string name = p.position->name.substr(0, p.position->name.size() - 4);
  Leaf& effector = makeEffector("ControlEffector", name, on, p.position->from);
  setProperty(effector, "maxForce", on.joint->maxForce);
  setProperty(effector, "gears", toList(Vec3(g, h, t)));
  setProperty(effector, "leastControls", toList(Vec3(angle[0], rate[0], torque[0])));
  setProperty(effector, "mostControls", toList(Vec3(angle[1], rate[1], torque[1])));
  setProperty(effector, "leastForces", toList(Vec3(byPosition[0], byRate[0], -HUGE_VAL)));
  setProperty(effector, "mostForces", toList(Vec3(byPosition[1], byRate[1], HUGE_VAL)));
  setProperty(effector, "reference", on.joint->reference);
}

void ActuatorBuilder::makeActuator(const Actuator& x, const Law& law, const Construction::MadeJoint& on) {
  if (!c_.has("ActuatorEffector")) return;
  Leaf& effector = makeEffector("ActuatorEffector", x.name.empty() ? on.joint->name : x.name, on, x.from);
  setProperty(effector, "gain", law.gain);
  setProperty(effector, "bias", law.bias);
  setProperty(effector, "stiffness", law.stiffness);
  setProperty(effector, "damping", law.damping);
  setProperty(effector, "gainStiffness", law.gainStiffness);
  setProperty(effector, "gainDamping", law.gainDamping);
  setProperty(effector, "maxForce", law.maxForce);
  setProperty(effector, "leastForce", law.leastForce);
  setProperty(effector, "mostForce", law.mostForce);
  setProperty(effector, "least", law.least);
  setProperty(effector, "most", law.most);
}

Leaf& ActuatorBuilder::makeEffector(const char* className, const std::string& name, const Construction::MadeJoint& on,
                                    const Element& from) {
  return makeEffector(className, name, *on.made->leaf().asNode(), from);
}

Leaf& ActuatorBuilder::makeEffector(const char* className, const std::string& name, Node& parent, const Element& from) {
  Leaf& effector = parent.create(className, c_.names.unprefixed(parent, name, "actuator"));
  const std::string message = c_.names.effector(name.empty() ? effector.name() : name);
  if (message != effector.name()) setProperty(effector, "messageName", message);
  if (message != name) c_.unsupported.add(from, fmt::format("{} is called {} in messages", from.named(), message));
  return effector;
}

}  // namespace spark::mjcf
