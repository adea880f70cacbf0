#include "actuator_builder.h"

#include <fmt/format.h>

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
    auto found = std::find_if(groups.begin(), groups.end(), [&](const auto& g) { return g.first == x.joint; });
    if (found == groups.end()) found = groups.insert(groups.end(), {x.joint, {}});
    found->second.push_back(&x);
  }
  for (const auto& [name, all] : groups) {
    const Element& from = all.front()->from;
    const auto joint = c_.joints.find(name);
    const bool free = c_.freeJoints.contains(name);
    if (joint == c_.joints.end() && !free) throw from.error(fmt::format("there is no joint '{}' to act on", name));
    if (!free && joint->second.joint->kind != JointKind::ball) {
      onJoint(all, joint->second);
      continue;
    }
    for (const Actuator* x : all)
      c_.unsupported.add(x->from, fmt::format("{} acts on a {} joint, which is not supported", x->from.named(),
                                              free ? "free" : "ball"));
  }
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
  Node& parent = *on.made->leaf().asNode();
  Leaf& effector = parent.create(className, c_.names.unprefixed(parent, name, "actuator"));
  const std::string message = c_.names.effector(name.empty() ? effector.name() : name);
  if (message != effector.name()) setProperty(effector, "messageName", message);
  if (message != name) c_.unsupported.add(from, fmt::format("{} is called {} in messages", from.named(), message));
  return effector;
}

}  // namespace spark::mjcf
