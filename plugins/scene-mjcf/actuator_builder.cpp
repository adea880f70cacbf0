#include "actuator_builder.h"

#include <fmt/format.h>

#include <algorithm>

#include "spark/access.h"

namespace spark::mjcf {

void ActuatorBuilder::build() {
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
    if (joint != c_.joints.end())
      onJoint(all, joint->second);
    else if (c_.freeJoints.contains(name))
      c_.leftOver.add(from, fmt::format("a <{}> on a free joint is left out", from.tag()));
    else
      throw from.error(fmt::format("there is no joint '{}' to act on", name));
  }
}

void ActuatorBuilder::onJoint(const Actuators& all, const Construction::MadeJoint& on) {
  const Actuator& first = *all.front();
  if (on.joint->kind == JointKind::ball)
    return c_.leftOver.add(first.from, fmt::format("a <{}> on a ball joint is left out", first.from.tag()));
  const double maxForce = std::min(on.joint->maxForce, all.size() == 1 ? first.maxForce : HUGE_VAL);
  if (makeController(all, on, maxForce)) return;
  for (std::size_t i = 1; i < all.size(); ++i)
    c_.leftOver.add(all[i]->from, fmt::format("a second <{}> on a joint is left out", all[i]->from.tag()));
  makeActuator(first, on, maxForce);
}

/// Makes one controller of name_pos, name_vel and name_tau. Returns false where these are not all that there is.
bool ActuatorBuilder::makeController(const Actuators& all, const Construction::MadeJoint& on, double maxForce) {
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
  if (all.size() != 3 || !position || !velocity || !torque || !plain || torque->gain != 1) return false;
  if (on.joint->stiffness > 0)
    c_.leftOver.add(on.joint->from,
                    "the attribute 'stiffness' of <joint> is left out where the joint has a controller");
  on.made->control(0, {.stiffness = position->gain, .damping = velocity->gain, .maxForce = maxForce});
  if (!c_.has("ControlEffector")) return true;
  const std::string name = position->name.substr(0, position->name.size() - 4);
  Leaf& effector = on.made->leaf().asNode()->create("ControlEffector", name);
  setProperty(effector, "maxForce", maxForce);
  return true;
}

void ActuatorBuilder::makeActuator(const Actuator& x, const Construction::MadeJoint& on, double maxForce) {
  // The joint's spring acts beside the actuator.
  const double spring = on.joint->stiffness, gear2 = x.gear * x.gear;
  const double bias = x.gear * x.bias[0] + spring * on.joint->springAngle;
  const double atFirst = std::clamp(0.0, x.controlRange[0], x.controlRange[1]);
  const engine::Control law{.stiffness = spring - gear2 * x.bias[1],
                            .damping = -gear2 * x.bias[2],
                            .force = bias + x.gear * x.gain * atFirst,
                            .maxForce = maxForce};
  if (law.stiffness < 0 || law.damping < 0)
    return c_.leftOver.add(x.from, "an actuator that drives a joint away from its target is left out");
  on.made->control(0, law);
  if (!c_.has("ActuatorEffector")) return;
  const std::string& name = x.name.empty() ? on.joint->name : x.name;
  Leaf& effector = on.made->leaf().asNode()->create("ActuatorEffector", name);
  setProperty(effector, "gain", x.gear * x.gain);
  setProperty(effector, "bias", bias);
  setProperty(effector, "stiffness", law.stiffness);
  setProperty(effector, "damping", law.damping);
  setProperty(effector, "maxForce", maxForce);
  setProperty(effector, "least", x.controlRange[0]);
  setProperty(effector, "most", x.controlRange[1]);
}

}  // namespace spark::mjcf
