// A joint as calls of scene files. They set anchor and axes at the places that the bodies have then, so that
// coordinates are 0: a joint that has been moved since has no such calls.

#include "joint.h"
#include "joint_kinematics.h"

namespace spark {

using engine::JointParameter;
using engine::JointType;

namespace {

/// A parameter and the end of its setter's name, behind "set".
struct Named {
  JointParameter parameter;
  const char* name;
};
constexpr Named kNamed[] = {{JointParameter::lowStop, "LowStopPos"},
                            {JointParameter::highStop, "HighStopPos"},
                            {JointParameter::velocity, "LinearMotorVelocity"},
                            {JointParameter::maxForce, "MaxMotorForce"},
                            {JointParameter::fudgeFactor, "FudgeFactor"},
                            {JointParameter::bounce, "Bounce"},
                            {JointParameter::cfm, "CFM"},
                            {JointParameter::stopErp, "StopERP"},
                            {JointParameter::stopCfm, "StopCFM"},
                            {JointParameter::suspensionErp, "SuspensionERP"},
                            {JointParameter::suspensionCfm, "SuspensionCFM"},
                            {JointParameter::armature, "Armature"},
                            {JointParameter::damping, "Damping"},
                            {JointParameter::dryFriction, "DryFriction"}};

/// The value of a new joint in a world with those parameters.
double valueOfNew(JointParameter p, const engine::WorldParameters& world) {
  switch (p) {
    case JointParameter::lowStop:
      return -HUGE_VAL;
    case JointParameter::highStop:
      return HUGE_VAL;
    case JointParameter::fudgeFactor:
      return 1;
    case JointParameter::cfm:
    case JointParameter::stopCfm:
    case JointParameter::suspensionCfm:
      return world.cfm;
    case JointParameter::stopErp:
    case JointParameter::suspensionErp:
      return world.erp;
    default:
      return 0;
  }
}

/// True for parameters that joints of the type have.
bool has(JointType type, JointParameter p) {
  const bool suspension = p == JointParameter::suspensionErp || p == JointParameter::suspensionCfm;
  if (type == JointType::ball) return p == JointParameter::damping;
  return !suspension || type == JointType::hinge2;
}

}  // namespace

void Joint::expectAsMade() const {
  constexpr double kTolerance = 1e-6;  // rad or m; a transform is in single precision
  const auto moved = [&](const std::string& what) {
    return Error(
        fmt::format("{}: cannot be written: {}; a scene file makes joints at their coordinate 0", where(), what));
  };
  for (int axis = 0; axis < axes() && jointType() != JointType::angularMotor; ++axis)
    if (const double q = angle(axis); std::abs(q) > kTolerance)
      throw moved(fmt::format("its axis {} is at {:.3g}", axis, q));
  if (!attached_ || !physics::hasAnchor(jointType())) return;
  const engine::Joint& j = world()->model().joints[world()->index(joint_)];
  const auto point = [](const RigidBody* b, const Vec3& p) {
    return b ? Vec3(b->state().position + b->state().rotation * p) : p;
  };
  const Vec3 first = point(bodies_[j.reversed ? 1 : 0].get(), j.inA.anchor),
             second = point(bodies_[j.reversed ? 0 : 1].get(), j.inB.anchor);
  if (const double apart = (first - second).norm(); apart > kTolerance)
    throw moved(fmt::format("its anchors are {:.3g} m apart", apart));
}

std::vector<SceneCall> Joint::sceneCalls() const {
  if (!world()) return {};
  expectAsMade();
  std::vector<SceneCall> calls;
  if (bodies_[0] || bodies_[1]) {
    const auto path = [&](const Ref<RigidBody>& b) { return b ? relativePath(*this, *b) : std::string(); };
    calls.push_back({"attach", {path(bodies_[0]), path(bodies_[1])}});
    // In the joint's frame, a matrix in single precision, whose inverse is not its transpose.
    const Pose frame = physics::frameOf(*this);
    const Mat3 inverse = frame.rotation.inverse();
    if (physics::hasAnchor(jointType())) {
      const Vec3 p = inverse * (anchor() - frame.position);
      calls.push_back({"setAnchor", {p.x(), p.y(), p.z()}});
    }
    for (int axis = 0; axis < axes() && jointType() != JointType::angularMotor; ++axis) {
      const Vec3 v = inverse * axisNow(axis);
      calls.push_back({"setLocalAxis", {axis, v.x(), v.y(), v.z()}});
    }
  }
  const int count = jointType() == JointType::ball ? 1 : axes();
  for (int axis = 0; axis < count; ++axis) addParameterCalls(calls, axis);
  return calls;
}

void Joint::addParameterCalls(std::vector<SceneCall>& calls, int axis) const {
  const bool ball = jointType() == JointType::ball;
  const engine::Control* const controller = ball ? nullptr : world()->controlOf(joint_, axis);
  for (const Named& n : kNamed) {
    if (!has(jointType(), n.parameter)) continue;
    // A controller is in the place of the motor.
    if (controller && (n.parameter == JointParameter::velocity || n.parameter == JointParameter::maxForce)) continue;
    const double v = parameter(n.parameter, axis);
    if (v != valueOfNew(n.parameter, world()->model().parameters))
      calls.push_back({std::string("set") + n.name, {axis, v}});
  }
  if (ball) return;
  if (const auto [stiffness, position] = springOf(axis); stiffness != 0 || position != 0)
    calls.push_back({"setSpring", {axis, stiffness, position}});
  if (const engine::Control* c = controller)
    calls.push_back(
        {"setController", {axis, c->stiffness, c->damping, c->position, c->velocity, c->force, c->maxForce}});
  for (int i = 0; controller && i < controller->termCount; ++i) {
    const engine::ControlTerm& t = controller->terms[static_cast<std::size_t>(i)];
    calls.push_back({"addControllerTerm", {axis, t.force, t.stiffness, t.damping, t.least, t.most}});
  }
}

}  // namespace spark
