#include <algorithm>
#include <limits>

#include "api/joint_stops.h"
#include "api/joint_trees.h"
#include "ode_world.h"

// ODE takes anchors and axes in world coordinates, at the poses that the bodies have at that time, and gives no access
// to what it computes from them. So a joint is set by calls that give it the frames of the model, with its bodies put
// where its coordinates are 0; in exact replay by repeating the calls of the scene (engine::JointCall), with its bodies
// put where they were.

namespace spark::ode {

using engine::Index;
using engine::JointAxis;
using engine::JointCall;
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

void passParameters(JointData& j, const engine::Joint& from, const engine::JointSoftness& soft,
                    const engine::JointCoordinates& coordinates) {
  for (int axis = 0; axis < engine::axesOf(j.type); ++axis) {
    const engine::JointSoftness::Axis& a = soft.axes[axis];
    engine::JointSoftness::Axis& known = j.soft.axes[axis];
    const int group = dParamGroup * axis;
    passStops(j, from, axis, coordinates.turns[axis]);
    pass(j, dParamFudgeFactor + group, a.fudgeFactor, known.fudgeFactor);
    pass(j, dParamBounce + group, a.bounce, known.bounce);
    pass(j, dParamCFM + group, a.cfm, known.cfm);
    pass(j, dParamStopERP + group, a.stopErp, known.stopErp);
    pass(j, dParamStopCFM + group, a.stopCfm, known.stopCfm);
  }
  if (j.type == JointType::ball || j.type == JointType::fixed) {
    pass(j, dParamERP, soft.erp, j.soft.erp);
    pass(j, dParamCFM, soft.cfm, j.soft.cfm);
  } else if (j.type == JointType::hinge2) {
    pass(j, dParamSuspensionERP, soft.suspensionErp, j.soft.suspensionErp);
    pass(j, dParamSuspensionCFM, soft.suspensionCfm, j.soft.suspensionCfm);
  }
  if (j.wantsFeedback != from.wantsFeedback) {
    j.wantsFeedback = from.wantsFeedback;
    j.feedback = {};
    dJointSetFeedback(j.joint, j.wantsFeedback ? &j.feedback : nullptr);
  }
}

/// Puts a body where it was when a joint was set.
void put(const WorldData& w, Index body, const JointCall::Place& place) {
  if (body == kNone) return;
  const BodyData& b = w.bodies[body];
  std::copy(place.position.begin(), place.position.end(), b.position);
  std::copy(place.quaternion.begin(), place.quaternion.end(), b.quaternion);
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t column = 0; column < 3; ++column) b.rotation[4 * row + column] = place.rotation[3 * column + row];
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

/// The calls that give a joint the frames of the model: with b, or the world, in the origin and the coordinates at 0.
std::vector<JointCall> callsOf(const engine::Joint& from) {
  const Pose a = inverse(engine::zeroPose(from));
  const Eigen::Quaterniond q(a.rotation);
  JointCall base;
  std::copy_n(a.position.data(), 3, base.a.position.begin());
  base.a.quaternion = {q.w(), q.x(), q.y(), q.z()};
  std::copy_n(a.rotation.data(), 9, base.a.rotation.begin());
  std::vector<JointCall> calls;
  const auto add = [&](JointCall::Kind kind, int axis, const Vec3& world, int frame = 0) {
    JointCall& call = calls.emplace_back(base);
    call.kind = kind, call.axis = axis, call.frame = frame;
    std::copy_n(world.data(), 3, call.world.begin());
  };
  // The axis that is `inA` in a, or `inB` in b.
  const auto addAxis = [&](int axis, bool ofA, const Vec3& inA, const Vec3& inB, int frame = 0) {
    const Vec3 world = ofA ? Vec3(a.rotation * inA) : inB;
    if (!world.isZero(0)) add(JointCall::setAxis, axis, world, frame);
  };
  switch (from.type) {
    case JointType::fixed:
      // One that was never set drifts.
      if (from.inA.rotation != std::array<double, 4>{}) add(JointCall::setFixed, 0, Vec3::Zero());
      break;
    case JointType::angularMotor: {
      const engine::AngularMotor& m = from.motor;
      add(JointCall::setMotor, m.axes, Vec3::Zero(), m.euler);
      for (int axis = 0; axis < m.axes; ++axis) {
        // ODE counts bodies as they were attached.
        const std::size_t i = static_cast<std::size_t>(axis);
        const bool ofA = m.euler ? axis == (from.reversed ? 2 : 0) : m.frame[i] == 1;
        addAxis(axis, ofA, from.inA.axis[i], from.inB.axis[i],
                from.reversed && m.frame[i] != 0 ? 3 - m.frame[i] : m.frame[i]);
        if (!m.euler) add(JointCall::setAngle, axis, Vec3(m.angle[i], 0, 0));
      }
      break;
    }
    case JointType::slider:
      addAxis(0, true, from.inA.axis[0], from.inB.axis[0]);
      break;
    case JointType::hinge:
      add(JointCall::anchor, 0, from.inB.anchor);
      addAxis(0, true, from.inA.axis[0], from.inB.axis[0]);
      break;
    case JointType::ball:
      add(JointCall::anchor, 0, from.inB.anchor);
      break;
    default:
      add(JointCall::anchor, 0, from.inB.anchor);
      // Axis 0 is that of the first attached body.
      for (const int axis : {0, 1}) addAxis(axis, (axis == 0) != from.reversed, from.inA.axis[0], from.inB.axis[1]);
  }
  return calls;
}

/// The calls that set a joint; none if it was never set.
std::vector<JointCall> callsFor(const Model& model, Index joint) {
  if (model.exactReplay) {
    std::vector<JointCall> calls;
    for (const auto& [number, call] : model.extensions.sceneJoints[joint].all<JointCall>(JointCall::kNumbers))
      calls.push_back(call);
    return calls;
  }
  const engine::Joint& from = model.joints[joint];
  return from.setAt == 0 || from.a == kNone ? std::vector<JointCall>{} : callsOf(from);
}

/// Makes the calls that set a joint. The bodies' poses in ODE are those of the last call afterwards.
void assemble(const WorldData& w, const JointData& j, const engine::Joint& from, std::vector<JointCall> calls) {
  std::stable_partition(calls.begin(), calls.end(), [](const JointCall& c) { return c.kind == JointCall::setMotor; });
  const auto toVec = [](const std::array<double, 3>& v) { return Vec3(v[0], v[1], v[2]); };
  // A wheel's axes are set as a pair: ODE ends the process for parallel ones.
  if (j.type == JointType::hinge2) {
    const JointCall* axes[2] = {};
    for (const JointCall& call : calls)
      if (call.kind == JointCall::setAxis) axes[call.axis] = &call;
    if (axes[0] && axes[1]) {
      const dReal first[4] = {axes[0]->world[0], axes[0]->world[1], axes[0]->world[2], 0};
      const dReal second[4] = {axes[1]->world[0], axes[1]->world[1], axes[1]->world[2], 0};
      put(w, from.a, axes[0]->a), put(w, from.b, axes[0]->b);
      dJointSetHinge2Axes(j.joint, first, second);
    }
  }
  for (const JointCall& call : calls) {
    put(w, from.a, call.a);
    put(w, from.b, call.b);
    const int axis = static_cast<int>(call.axis), frame = static_cast<int>(call.frame);
    switch (call.kind) {
      case JointCall::anchor:
        setAnchor(j, toVec(call.world));
        break;
      case JointCall::setAxis:
        setAxis(j, axis, toVec(call.world), frame);
        break;
      case JointCall::setMotor:
        dJointSetAMotorMode(j.joint, frame ? dAMotorEuler : dAMotorUser);
        if (!frame) dJointSetAMotorNumAxes(j.joint, axis);
        break;
      case JointCall::setAngle:
        dJointSetAMotorAngle(j.joint, axis, call.world[0]);
        break;
      default:
        dJointSetFixed(j.joint);
    }
  }
}

/// Lists the axes of a joint whose stops may have to move them back. In exact replay none do: see stopReturn().
void listLimited(WorldData& w, const engine::Joint& from, const engine::JointSoftness& soft, Index joint) {
  if (w.exactReplay || from.a == kNone || from.type == JointType::angularMotor) return;
  for (int axis = 0; axis < engine::axesOf(from.type); ++axis) {
    const JointAxis& a = from.axes[axis];
    if ((std::isfinite(a.lowStop) || std::isfinite(a.highStop)) && a.lowStop <= a.highStop)
      w.limited.push_back({joint, axis, soft.axes[axis].stopErp});
  }
}

/// The place of an axis, as its stops count it.
double placeOf(const engine::Step& step, Index joint, int axis) {
  const engine::Joint& j = step.model.joints[joint];
  if (j.type != JointType::slider) return step.state.coordinates[joint].at(static_cast<std::size_t>(axis));
  static const engine::DynamicState world;
  const engine::DynamicState &a = step.state.bodies[j.a], &b = j.b == kNone ? world : step.state.bodies[j.b];
  const Vec3 offset = b.position + b.rotation * j.inB.anchor - a.position;
  return (j.reversed ? 1 : -1) * (a.rotation * j.inA.axis[0]).dot(offset);
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
    for (JointAxis& a : j->axes) a.lowStop = a.highStop = kUnknown;
    j->soft = {{}, kUnknown, kUnknown, kUnknown, kUnknown};
    j->soft.axes.fill({kUnknown, kUnknown, kUnknown, kUnknown, kUnknown});
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
    if (const auto calls = callsFor(model, i); !calls.empty()) put(w, from.a, calls[0].a), put(w, from.b, calls[0].b);
    from.reversed ? dJointAttach(w.joints[i]->joint, nullptr, a) : dJointAttach(w.joints[i]->joint, a, b);
    w.joints[i]->attachedAt = from.attachedAt;
    w.joints[i]->setAt = 0;
  }
  w.links.clear();
  w.measured.clear();
  w.limited.clear();
  for (Index i = 0; i < w.joints.size(); ++i) {
    JointData& j = *w.joints[i];
    const engine::Joint& from = model.joints[i];
    const auto& soft = model.extensions.sceneJoints[i].get<engine::JointSoftness>();
    passParameters(j, from, soft, state.coordinates[i]);
    listLimited(w, from, soft, i);
    if (from.wantsFeedback) w.measured.push_back(i);
    if (from.b != kNone) w.links.push_back({from.a, from.b});
    if (j.setAt == from.setAt || from.a == kNone) continue;
    assemble(w, j, from, callsFor(model, i));
    j.setAt = from.setAt;
  }
}

void passTurns(WorldData& w, const Model& model, const engine::State& state) {
  if (state.turned == 0 && !w.turned) return;
  w.turned = state.turned > 0;
  for (Index i = 0; i < w.joints.size(); ++i)
    for (int axis = 0; axis < engine::axesOf(w.joints[i]->type); ++axis)
      passStops(*w.joints[i], model.joints[i], axis, state.coordinates[i].turns[axis]);
}

void passStopReturns(WorldData& w, const engine::Step& step) {
  for (const auto& [joint, axis, stopErp] : w.limited) {
    JointData& j = *w.joints[joint];
    const JointAxis& a = step.model.joints[joint].axes[axis];
    const double place = placeOf(step, joint, axis), excess = std::max(a.lowStop - place, place - a.highStop);
    // ODE moves the axis back by a fraction of the excess.
    const double most = excess > 0 ? engine::kStopReturn * step.dt / excess : HUGE_VAL;
    pass(j, dParamStopERP + dParamGroup * axis, std::min(stopErp, most), j.soft.axes[axis].stopErp);
  }
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

// A law, force - resistance v', is a row J v' + x / resistance = force / resistance: a motor with that speed and CFM.

void clearLaws(WorldData& w) {
  for (const LawJoint& l : w.laws) dJointDestroy(l.joint);
  w.laws.clear();
  w.jointRowsCounted = false;
}

namespace {

void addLawJoint(WorldData& w, const engine::Joint& from) {
  LawJoint l{from.id, from.type == JointType::slider, from.a, from.b, nullptr};
  l.joint = l.slides ? dJointCreateLMotor(w.id, nullptr) : dJointCreateAMotor(w.id, nullptr);
  dJointAttach(l.joint, w.bodies[l.a].body, l.b == kNone ? nullptr : w.bodies[l.b].body);
  l.slides ? dJointSetLMotorNumAxes(l.joint, 1) : dJointSetAMotorNumAxes(l.joint, 1);
  w.laws.push_back(l);
}

}  // namespace

void passLaws(WorldData& w, const engine::Step& step) {
  const auto& laws = step.state.laws;
  const auto of = [&](const engine::AxisLaw& law) -> const engine::Joint& { return step.model.joints[law.joint]; };
  if (!std::equal(w.laws.begin(), w.laws.end(), laws.begin(), laws.end(),
                  [&](const LawJoint& l, const engine::AxisLaw& law) { return l.isOf(of(law)); })) {
    clearLaws(w);
    for (const engine::AxisLaw& law : laws) addLawJoint(w, of(law));
  }
  for (std::size_t i = 0; i < laws.size(); ++i) {
    const auto& [joint, axis, along, force, resistance, maxForce] = laws[i];
    const LawJoint& l = w.laws[i];
    const auto setAxis = l.slides ? dJointSetLMotorAxis : dJointSetAMotorAxis;
    const auto set = l.slides ? dJointSetLMotorParam : dJointSetAMotorParam;
    setAxis(l.joint, 0, 0, along.x(), along.y(), along.z());
    set(l.joint, dParamVel, force / resistance);
    set(l.joint, dParamCFM, 1 / resistance);
    set(l.joint, dParamFMax, maxForce);
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
