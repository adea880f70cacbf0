#include "agent_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "sensor_reader.h"

namespace spark::urdf {

/// How agents move the joints: as the transmissions say, or each joint if there are none.
void AgentParts::drives() {
  std::map<std::string, const mjcf::Joint*, std::less<>> movable;
  for (const mjcf::Body& b : model_.bodies)
    for (const mjcf::Joint& j : b.joints)
      if (j.kind == mjcf::JointKind::hinge || j.kind == mjcf::JointKind::slide) movable[j.name] = &j;
  std::set<std::string, std::less<>> joints, followers;
  for (const Element& e : childrenOf(root_))
    if (e.tag() == "joint") joints.insert(nameOf(e));
  for (const mjcf::Equality& q : model_.equalities) followers.insert(q.first);
  bool any = false;
  std::set<std::string, std::less<>> driven;
  for (const Element& t : childrenOf(root_)) {
    if (t.tag() != "transmission") continue;
    any = true;
    const auto leaveOut = [&](const Element& at, const std::string& why) {
      unsupported_.add(at, fmt::format("the {} is left out: {}", t.named(), why));
    };
    if (!childOf(t, "joint")) leaveOut(t, "expected an element <joint>");
    for (const Element& e : childrenOf(t)) {
      if (e.tag() != "joint") continue;
      const std::string name(textOf(e, "name"));
      if (!joints.contains(name)) {
        leaveOut(
            e, name.empty() ? "expected an attribute 'name' of <joint>" : fmt::format("there is no joint '{}'", name));
        continue;
      }
      reductions(t);
      const auto joint = movable.find(name);
      if (joint == movable.end()) {
        leaveOut(e, fmt::format("the joint '{}' is none of one axis", name));
        continue;
      }
      if (!driven.insert(name).second) {
        leaveOut(e, fmt::format("the joint '{}' has one already", name));
        continue;
      }
      drive(e, *joint->second, interfaceOf(t, e).find("Effort") != std::string_view::npos);
    }
  }
  if (any) return;
  for (const mjcf::Body& b : model_.bodies)
    for (const mjcf::Joint& j : b.joints)
      if (movable.contains(j.name) && !followers.contains(j.name)) drive(j.from, j, false);
}

/// hardware_interface/EffortJointInterface, PositionJointInterface, VelocityJointInterface: of the joint, or in older
/// files of its actuator.
std::string_view AgentParts::interfaceOf(const Element& transmission, const Element& joint) {
  if (const auto own = childOf(joint, "hardwareInterface")) return contentOf(*own);
  const auto actuator = childOf(transmission, "actuator");
  const auto interface = actuator ? childOf(*actuator, "hardwareInterface") : std::nullopt;
  return interface ? contentOf(*interface) : "";
}

void AgentParts::reductions(const Element& around) {
  for (const Element& e : childrenOf(around)) {
    if (e.tag() == "joint" || e.tag() == "actuator") reductions(e);
    if (e.tag() != "mechanicalReduction") continue;
    const auto found = numbersOf(contentOf(e));
    if (!found || found->front() != 1)
      unsupported_.add(e, "a <mechanicalReduction> other than 1 is ignored: agents drive the joint itself");
  }
}

void AgentParts::drive(const Element& from, const mjcf::Joint& joint, bool byForceAlone) {
  mjcf::Actuator x;
  x.from = from;
  x.joint = joint.name;
  const auto add = [&](const char* ending, std::array<double, 3> gain, std::array<double, 2> range) {
    x.name = joint.name + ending;
    x.gain = gain;
    x.controlRange = range;
    model_.actuators.push_back(x);
  };
  const std::array<double, 2> force{-joint.maxForce, joint.maxForce}, all{-HUGE_VAL, HUGE_VAL};
  if (byForceAlone) return add("", {1, 0, 0}, force);
  // Targets with gains that the agent chooses: limp until then.
  add("_pos", {0, 0, 0}, joint.limited ? joint.range : all);
  add("_vel", {0, 0, 0}, all);
  add("_tau", {1, 0, 0}, force);
}

void AgentParts::sensors() {
  for (const mjcf::Body& b : model_.bodies)
    for (const mjcf::Joint& j : b.joints)
      if (j.kind == mjcf::JointKind::hinge || j.kind == mjcf::JointKind::slide)
        model_.sensors.push_back({j.from, "jointpos", j.name, j.name, "joint", ""});
  SensorReader reader(model_, unsupported_);
  for (const Element& e : childrenOf(root_))
    if (e.tag() == "gazebo") reader.read(e);
}

}  // namespace spark::urdf
