#include <algorithm>
#include <limits>

#include "ode_world.h"

// ODE takes anchors and axes in world coordinates, at the poses that the bodies have at that time, and gives no access
// to what it computes from them. So a joint is set by repeating the calls that set it in the model (Joint::assembly),
// with its bodies put where they were.

namespace spark::ode {

using engine::Assembly;
using engine::Index;
using engine::JointAxis;
using engine::JointType;
using engine::kNone;
using engine::Model;

namespace {

dJointID createJoint(dWorldID world, JointType type) {
  switch (type) {
    case JointType::ball:
      return dJointCreateBall(world, nullptr);
    case JointType::hinge:
      return dJointCreateHinge(world, nullptr);
    case JointType::hinge2:
      return dJointCreateHinge2(world, nullptr);
    case JointType::slider:
      return dJointCreateSlider(world, nullptr);
    case JointType::universal:
      return dJointCreateUniversal(world, nullptr);
    case JointType::fixed:
      return dJointCreateFixed(world, nullptr);
    default:
      return dJointCreateAMotor(world, nullptr);
  }
}

/// Sets a parameter in ODE.
void setParameter(const JointData& j, int name, double v) {
  switch (j.type) {
    case JointType::ball:
      return dJointSetBallParam(j.joint, name, v);
    case JointType::hinge:
      return dJointSetHingeParam(j.joint, name, v);
    case JointType::hinge2:
      return dJointSetHinge2Param(j.joint, name, v);
    case JointType::slider:
      return dJointSetSliderParam(j.joint, name, v);
    case JointType::universal:
      return dJointSetUniversalParam(j.joint, name, v);
    case JointType::fixed:
      return dJointSetFixedParam(j.joint, name, v);
    default:
      return dJointSetAMotorParam(j.joint, name, v);
  }
}

/// Passes a parameter where it is another than before.
void pass(const JointData& j, int name, double wanted, double& known) {
  if (wanted == known) return;
  known = wanted;
  setParameter(j, name, wanted);
}

/// Passes the stops of an axis. ODE compares them with an angle within one turn: those of an axis that has turned move
/// back by its turns.
void passStops(JointData& j, const engine::Joint& from, int axis, std::int32_t turns) {
  const JointAxis& a = from.axes[axis];
  const double turned = 2 * kPi * turns;
  pass(j, dParamLoStop + dParamGroup * axis, turns == 0 ? a.lowStop : a.lowStop - turned, j.axes[axis].lowStop);
  pass(j, dParamHiStop + dParamGroup * axis, turns == 0 ? a.highStop : a.highStop - turned, j.axes[axis].highStop);
}

void passParameters(JointData& j, const engine::Joint& from, const engine::JointCoordinates& coordinates) {
  for (int axis = 0; axis < engine::axesOf(j.type); ++axis) {
    const JointAxis& a = from.axes[axis];
    JointAxis& known = j.axes[axis];
    const int group = dParamGroup * axis;
    passStops(j, from, axis, coordinates.turns[axis]);
    pass(j, dParamFudgeFactor + group, a.soft.fudgeFactor, known.soft.fudgeFactor);
    pass(j, dParamBounce + group, a.soft.bounce, known.soft.bounce);
    pass(j, dParamCFM + group, a.soft.cfm, known.soft.cfm);
    pass(j, dParamStopERP + group, a.soft.stopErp, known.soft.stopErp);
    pass(j, dParamStopCFM + group, a.soft.stopCfm, known.soft.stopCfm);
  }
  if (j.type == JointType::ball || j.type == JointType::fixed) {
    pass(j, dParamERP, from.soft.erp, j.soft.erp);
    pass(j, dParamCFM, from.soft.cfm, j.soft.cfm);
  } else if (j.type == JointType::hinge2) {
    pass(j, dParamSuspensionERP, from.soft.suspensionErp, j.soft.suspensionErp);
    pass(j, dParamSuspensionCFM, from.soft.suspensionCfm, j.soft.suspensionCfm);
  }
  if (j.wantsFeedback != from.wantsFeedback) {
    j.wantsFeedback = from.wantsFeedback;
    j.feedback = {};
    dJointSetFeedback(j.joint, j.wantsFeedback ? &j.feedback : nullptr);
  }
}

/// Puts a body where it was when a joint was set.
void put(const WorldData& w, Index body, const engine::AssemblyPose& pose) {
  if (body == kNone) return;
  const BodyData& b = w.bodies[body];
  std::copy_n(pose.position.data(), 3, b.position);
  std::copy_n(pose.quaternion.data(), 4, b.quaternion);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) b.rotation[4 * row + column] = pose.rotation(row, column);
}

void setAnchor(const JointData& j, const Vec3& p) {
  switch (j.type) {
    case JointType::ball:
      return dJointSetBallAnchor(j.joint, p.x(), p.y(), p.z());
    case JointType::hinge:
      return dJointSetHingeAnchor(j.joint, p.x(), p.y(), p.z());
    case JointType::hinge2:
      return dJointSetHinge2Anchor(j.joint, p.x(), p.y(), p.z());
    default:
      return dJointSetUniversalAnchor(j.joint, p.x(), p.y(), p.z());
  }
}

void setAxis(const JointData& j, int axis, const Vec3& v, int frame) {
  const dReal direction[4] = {v.x(), v.y(), v.z(), 0};
  switch (j.type) {
    case JointType::hinge:
      return dJointSetHingeAxis(j.joint, v.x(), v.y(), v.z());
    case JointType::slider:
      return dJointSetSliderAxis(j.joint, v.x(), v.y(), v.z());
    case JointType::universal:
      return axis == 0 ? dJointSetUniversalAxis1(j.joint, v.x(), v.y(), v.z())
                       : dJointSetUniversalAxis2(j.joint, v.x(), v.y(), v.z());
    case JointType::hinge2:
      return dJointSetHinge2Axes(j.joint, axis == 0 ? direction : nullptr, axis == 1 ? direction : nullptr);
    default:
      return dJointSetAMotorAxis(j.joint, axis, frame, v.x(), v.y(), v.z());
  }
}

/// Repeats the calls that set a joint. The bodies' poses in ODE are those of the last call afterwards.
void assemble(const WorldData& w, const JointData& j, const engine::Joint& from) {
  // A wheel's axes are set as a pair: ODE ends the process for parallel ones.
  if (j.type == JointType::hinge2) {
    const Assembly* calls[2] = {};
    for (const Assembly& call : from.assembly)
      if (call.kind == Assembly::Kind::axis) calls[call.axis] = &call;
    if (calls[0] && calls[1]) {
      const dReal first[4] = {calls[0]->world.x(), calls[0]->world.y(), calls[0]->world.z(), 0};
      const dReal second[4] = {calls[1]->world.x(), calls[1]->world.y(), calls[1]->world.z(), 0};
      put(w, from.a, calls[0]->a), put(w, from.b, calls[0]->b);
      dJointSetHinge2Axes(j.joint, first, second);
    }
  }
  for (const Assembly& call : from.assembly) {
    put(w, from.a, call.a);
    put(w, from.b, call.b);
    switch (call.kind) {
      case Assembly::Kind::anchor:
        setAnchor(j, call.world);
        break;
      case Assembly::Kind::axis:
        setAxis(j, call.axis, call.world, call.frame);
        break;
      case Assembly::Kind::motor:
        dJointSetAMotorMode(j.joint, call.frame ? dAMotorEuler : dAMotorUser);
        if (!call.frame) dJointSetAMotorNumAxes(j.joint, call.axis);
        break;
      case Assembly::Kind::angle:
        dJointSetAMotorAngle(j.joint, call.axis, call.world.x());
        break;
      case Assembly::Kind::fixed:
        dJointSetFixed(j.joint);
        break;
    }
  }
}

}  // namespace

void compileJoints(WorldData& w, const Model& model, const engine::State& state) {
  while (w.joints.size() < model.joints.size()) {
    const engine::Joint& from = model.joints[w.joints.size()];
    auto j = std::make_unique<JointData>();
    j->id = from.id;
    j->type = from.type;
    j->joint = createJoint(w.id, from.type);
    // All parameters are passed once.
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    for (JointAxis& a : j->axes) {
      a.lowStop = a.highStop = kUnknown;
      a.soft = {kUnknown, kUnknown, kUnknown, kUnknown, kUnknown};
    }
    j->soft = {kUnknown, kUnknown, kUnknown, kUnknown};
    w.joints.push_back(std::move(j));
    w.motors.emplace_back();
  }

  // Attach in the order of the calls: it is that of the joints of a body, which decides the order in which ODE solves.
  std::vector<Index> attach;
  for (Index i = 0; i < w.joints.size(); ++i)
    if (w.joints[i]->attachedAt != model.joints[i].attachedAt) attach.push_back(i);
  std::sort(attach.begin(), attach.end(),
            [&](Index a, Index b) { return model.joints[a].attachedAt < model.joints[b].attachedAt; });
  for (const Index i : attach) {
    const engine::Joint& from = model.joints[i];
    const dBodyID a = from.a != kNone ? w.bodies[from.a].body : nullptr;
    const dBodyID b = from.b != kNone ? w.bodies[from.b].body : nullptr;
    if (!from.assembly.empty()) put(w, from.a, from.assembly.front().a), put(w, from.b, from.assembly.front().b);
    from.reversed ? dJointAttach(w.joints[i]->joint, nullptr, a) : dJointAttach(w.joints[i]->joint, a, b);
    w.joints[i]->attachedAt = from.attachedAt;
    w.joints[i]->assembledAt = 0;
  }
  w.links.clear();
  w.measured.clear();
  for (Index i = 0; i < w.joints.size(); ++i) {
    JointData& j = *w.joints[i];
    const engine::Joint& from = model.joints[i];
    passParameters(j, from, state.coordinates[i]);
    if (from.wantsFeedback) w.measured.push_back(i);
    if (from.b != kNone) w.links.push_back({from.a, from.b});
    if (j.assembledAt == from.assembledAt || from.a == kNone) continue;
    assemble(w, j, from);
    j.assembledAt = from.assembledAt;
  }
}

void passTurns(WorldData& w, const Model& model, const engine::State& state) {
  if (state.turned == 0 && !w.turned) return;
  w.turned = state.turned > 0;
  for (Index i = 0; i < w.joints.size(); ++i)
    for (int axis = 0; axis < engine::axesOf(w.joints[i]->type); ++axis)
      passStops(*w.joints[i], model.joints[i], axis, state.coordinates[i].turns[axis]);
}

void passMotors(WorldData& w, const engine::State& state) {
  for (std::size_t i = 0; i < w.motors.size(); ++i)
    for (int axis = 0; axis < 3; ++axis) {
      const engine::Motor& wanted = state.motors[i][axis];
      engine::Motor& known = w.motors[i][axis];
      if (wanted.velocity == known.velocity && wanted.maxForce == known.maxForce) continue;
      pass(*w.joints[i], dParamVel + dParamGroup * axis, wanted.velocity, known.velocity);
      pass(*w.joints[i], dParamFMax + dParamGroup * axis, wanted.maxForce, known.maxForce);
    }
}

void readJoints(const WorldData& w, const engine::Step& step) {
  for (const Index i : w.measured) {
    const Index a = step.model.joints[i].a;
    if (a == kNone || !step.steps(a) || !step.state.bodies[a].awake) continue;
    const dJointFeedback& f = w.joints[i]->feedback;
    step.state.joints[i] = {toVec(f.f1), toVec(f.t1), toVec(f.f2), toVec(f.t2)};
  }
}

}  // namespace spark::ode
