#include <Eigen/Geometry>

#include "ode_engine.h"
#include "spark/prefetch.h"

namespace spark {

using namespace ode;
using engine::Body;
using engine::Joint;
using engine::JointParameter;
using engine::JointType;

namespace {

/// Number of axes with motor and stops.
int axesOf(JointType type) {
  switch (type) {
    case JointType::hinge:
    case JointType::slider:
      return 1;
    case JointType::universal:
    case JointType::hinge2:
      return 2;
    case JointType::angularMotor:
      return 3;
    default:
      return 0;
  }
}

/// ODE's name of a parameter of an axis. The table is in the order of JointParameter.
int odeParameter(JointParameter p, int axis) {
  static constexpr int kNames[] = {dParamLoStop,      dParamHiStop,        dParamVel,          dParamFMax,
                                   dParamFudgeFactor, dParamBounce,        dParamCFM,          dParamStopERP,
                                   dParamStopCFM,     dParamSuspensionERP, dParamSuspensionCFM};
  return kNames[static_cast<int>(p)] + dParamGroup * axis;
}
static_assert(static_cast<int>(JointParameter::stopErp) == 7 && static_cast<int>(JointParameter::suspensionCfm) == 10);

/// World frame [rad/s]; 0 for the static world.
Vec3 angularVelocity(const engine::SolverBody* b) { return b ? toVec(b->angularVelocity) : Vec3(Vec3::Zero()); }

/// The mirrored parameter, for getters and solvers.
double& mirrored(JointData& j, JointParameter p, int axis) {
  using Axis = engine::SolverAxis;
  static constexpr double Axis::*kMembers[] = {&Axis::lowStop,  &Axis::highStop,    &Axis::velocity,
                                               &Axis::maxForce, &Axis::fudgeFactor, &Axis::bounce,
                                               &Axis::cfm,      &Axis::stopErp,     &Axis::stopCfm};
  if (p == JointParameter::suspensionErp) return j.suspensionErp;
  if (p == JointParameter::suspensionCfm) return j.suspensionCfm;
  return j.axes[axis].*kMembers[static_cast<int>(p)];
}

/// An axis of an angular motor, world frame.
Vec3 motorAxis(const JointData& j, int axis) {
  dVector3 v{};
  if (j.attached()) dJointGetAMotorAxis(j.id, axis, v);
  return toVec(v);
}

/// Sets a parameter in ODE.
void setOde(const JointData& j, int name, double v) {
  switch (j.type) {
    case JointType::hinge:
      return dJointSetHingeParam(j.id, name, v);
    case JointType::slider:
      return dJointSetSliderParam(j.id, name, v);
    case JointType::universal:
      return dJointSetUniversalParam(j.id, name, v);
    case JointType::hinge2:
      return dJointSetHinge2Param(j.id, name, v);
    default:
      return dJointSetAMotorParam(j.id, name, v);
  }
}

/// Gets a parameter from ODE.
double getOde(const JointData& j, int name) {
  switch (j.type) {
    case JointType::hinge:
      return dJointGetHingeParam(j.id, name);
    case JointType::slider:
      return dJointGetSliderParam(j.id, name);
    case JointType::universal:
      return dJointGetUniversalParam(j.id, name);
    case JointType::hinge2:
      return dJointGetHinge2Param(j.id, name);
    default:
      return dJointGetAMotorParam(j.id, name);
  }
}

/// Suspension parameters belong to the first axis of hinge2.
bool hasParameter(const JointData& j, JointParameter p, int axis) {
  const bool suspension = p == JointParameter::suspensionErp || p == JointParameter::suspensionCfm;
  return axis >= 0 && axis < axesOf(j.type) && (!suspension || (j.type == JointType::hinge2 && axis == 0));
}

/// The cached angle of a hinge, of the first body of attach() relative to the second [rad]. Several threads may compute
/// it at the same time; they store the same number.
double hingeAngle(const JointData& j) {
  const std::uint64_t now = j.world->angleVersion;
  if (j.angleVersion.load(std::memory_order_acquire) != now) {
    j.cachedAngle.store(dJointGetHingeAngle(j.id), std::memory_order_relaxed);
    j.angleVersion.store(now, std::memory_order_release);
  }
  return j.cachedAngle.load(std::memory_order_relaxed);
}

}  // namespace

void OdeEngine::cacheAngles(WorldData& w) {
  // ODE's solver has evicted joints and bodies from the caches. Sensors read single joints and would wait for memory
  // each time; this loop knows the next joints and prefetches them.
  constexpr std::size_t kFar = 10, kNear = 5;  // prefetch distances [joints]
  constexpr std::size_t kOdeHinge = 448;       // bytes of an ODE hinge
  const std::size_t n = w.joints.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (i + kFar < n) prefetch(w.joints[i + kFar].get(), kCacheLine);
    if (i + kNear < n) prefetch(w.joints[i + kNear]->id, kOdeHinge);

    // Only hinges whose angle was read since the last step.
    const JointData& j = *w.joints[i];
    if (j.type == JointType::hinge && j.attached() &&
        j.angleVersion.load(std::memory_order_relaxed) >= w.stepAngleVersion)
      hingeAngle(j);
  }
  w.stepAngleVersion = w.angleVersion;
}

Joint OdeEngine::createJoint(engine::World world, JointType type) {
  const MessageCapture capture(odeMessage_);
  WorldData& w = *data(world);
  auto j = std::make_unique<JointData>();
  j->world = &w;
  j->type = type;
  switch (type) {
    case JointType::ball:
      j->id = dJointCreateBall(w.id, nullptr);
      break;
    case JointType::hinge:
      j->id = dJointCreateHinge(w.id, nullptr);
      break;
    case JointType::hinge2:
      j->id = dJointCreateHinge2(w.id, nullptr);
      break;
    case JointType::slider:
      j->id = dJointCreateSlider(w.id, nullptr);
      break;
    case JointType::universal:
      j->id = dJointCreateUniversal(w.id, nullptr);
      break;
    case JointType::fixed:
      j->id = dJointCreateFixed(w.id, nullptr);
      break;
    case JointType::angularMotor:
      j->id = dJointCreateAMotor(w.id, nullptr);
      break;
  }
  mirror::created(*j);
  w.structure = ++structures_;
  const Joint created = handle(*j);
  w.joints.push_back(std::move(j));
  return created;
}

void OdeEngine::destroyJoint(Joint joint) {
  JointData* j = data(joint);
  if (j->a) --data(j->a)->joints;
  if (j->b) --data(j->b)->joints;
  j->world->structure = ++structures_;
  dJointDestroy(j->id);
  removeFrom(j->world->joints, j);
}

void OdeEngine::attach(Joint joint, engine::Body a, engine::Body b) {
  if (a == b && a != engine::Body::none)
    throw Error("a joint cannot connect a body with itself: name two bodies, or one and the world");
  // ODE ends the process for a hinge2 with one body.
  if (data(joint)->type == JointType::hinge2 && (a == Body::none) != (b == Body::none))
    throw Error("a wheel's joint (hinge2) needs two bodies, found one: name the chassis and the wheel");
  const MessageCapture capture(odeMessage_);
  JointData& j = *data(joint);
  if (j.a) --data(j.a)->joints;
  if (j.b) --data(j.b)->joints;
  BodyData* const first = data(a);
  BodyData* const second = data(b);
  if (first) ++first->joints;
  if (second) ++second->joints;
  dJointAttach(j.id, first ? first->id : nullptr, second ? second->id : nullptr);
  j.reversed = !first && second;
  j.a = first ? first : second;
  j.b = first ? second : nullptr;
  j.world->structure = ++structures_;
  mirror::attached(j);
}

void OdeEngine::setAnchor(Joint joint, const Vec3& wanted) {
  const MessageCapture capture(odeMessage_);
  JointData& j = *data(joint);
  if (!j.attached() || !inRange(wanted)) return;
  const Vec3 p = rounded(*j.world, wanted);
  switch (j.type) {
    case JointType::ball:
      dJointSetBallAnchor(j.id, p.x(), p.y(), p.z());
      break;
    case JointType::hinge:
      dJointSetHingeAnchor(j.id, p.x(), p.y(), p.z());
      break;
    case JointType::hinge2:
      dJointSetHinge2Anchor(j.id, p.x(), p.y(), p.z());
      break;
    case JointType::universal:
      dJointSetUniversalAnchor(j.id, p.x(), p.y(), p.z());
      break;
    default:
      return;
  }
  mirror::anchorSet(j, p);
}

void OdeEngine::setAxis(Joint joint, int axis, const Vec3& wanted, int frame) {
  const MessageCapture capture(odeMessage_);
  JointData& j = *data(joint);
  if (axis < 0 || axis >= axesOf(j.type) || !j.attached()) return;
  const Vec3 v = rounded(*j.world, wanted);
  if (!inRange(v) || v.norm() < 1e-9) throw Error("expected an axis longer than 0");
  const dReal direction[4] = {v.x(), v.y(), v.z(), 0};
  switch (j.type) {
    case JointType::hinge:
      dJointSetHingeAxis(j.id, v.x(), v.y(), v.z());
      break;
    case JointType::slider:
      dJointSetSliderAxis(j.id, v.x(), v.y(), v.z());
      break;
    case JointType::universal:
      if (axis == 0)
        dJointSetUniversalAxis1(j.id, v.x(), v.y(), v.z());
      else
        dJointSetUniversalAxis2(j.id, v.x(), v.y(), v.z());
      break;
    case JointType::hinge2: {
      // ODE ends the process for parallel axes. If the new axis is parallel to the other one, that one is moved to a
      // perpendicular direction; the caller usually sets it next.
      const bool parallel = v.normalized().cross(OdeEngine::axis(joint, 1 - axis)).norm() < 1e-9;
      const Vec3 lateral = v.unitOrthogonal();
      const dReal lateralAxis[4] = {lateral.x(), lateral.y(), lateral.z(), 0};
      const dReal* const other = parallel ? lateralAxis : nullptr;
      dJointSetHinge2Axes(j.id, axis == 0 ? direction : other, axis == 1 ? direction : other);
      if (parallel) mirror::axisSet(j, 1 - axis, lateral, frame);
      break;
    }
    case JointType::angularMotor:
      if ((frame == 1 && j.reversed) || (frame == 2 && !j.b && !j.reversed) || frame < 0 || frame > 2)
        frame = 0;  // that body is the world
      if (axis >= j.motorAxes) return;
      dJointSetAMotorAxis(j.id, axis, frame, v.x(), v.y(), v.z());
      break;
    default:
      return;
  }
  mirror::axisSet(j, axis, v, frame);
}

void OdeEngine::setAngularMotor(Joint joint, int axes, bool euler) {
  const MessageCapture capture(odeMessage_);
  JointData& j = *data(joint);
  if (j.type != JointType::angularMotor) return;
  if (axes < 0 || axes > 3) throw Error(fmt::format("expected 0 to 3 axes of an angular motor, found {}", axes));
  dJointSetAMotorMode(j.id, euler ? dAMotorEuler : dAMotorUser);
  if (!euler) dJointSetAMotorNumAxes(j.id, axes);
  mirror::motorModeSet(j, axes, euler);
}

void OdeEngine::setMotorAngle(Joint joint, int axis, double angle) {
  JointData& j = *data(joint);
  if (j.type != JointType::angularMotor || j.euler || axis < 0 || axis >= 3 || !std::isfinite(angle)) return;
  dJointSetAMotorAngle(j.id, axis, angle);
  j.angle[axis] = angle;
}

void OdeEngine::setFixed(Joint joint) {
  const MessageCapture capture(odeMessage_);
  JointData& j = *data(joint);
  if (j.type != JointType::fixed || !j.attached()) return;
  dJointSetFixed(j.id);
  mirror::fixedSet(j);
}

Vec3 OdeEngine::anchor(Joint joint) const {
  const JointData& j = *data(joint);
  dVector3 v{};
  if (!j.attached()) return Vec3::Zero();
  switch (j.type) {
    case JointType::ball:
      dJointGetBallAnchor(j.id, v);
      break;
    case JointType::hinge:
      dJointGetHingeAnchor(j.id, v);
      break;
    case JointType::hinge2:
      dJointGetHinge2Anchor(j.id, v);
      break;
    case JointType::universal:
      dJointGetUniversalAnchor(j.id, v);
      break;
    default:
      break;
  }
  return toVec(v);
}

Vec3 OdeEngine::axis(Joint joint, int axis) const {
  const JointData& j = *data(joint);
  dVector3 v{};
  if (axis < 0 || axis >= axesOf(j.type) || !j.attached()) return Vec3::Zero();
  switch (j.type) {
    case JointType::hinge:
      dJointGetHingeAxis(j.id, v);
      break;
    case JointType::slider:
      dJointGetSliderAxis(j.id, v);
      break;
    case JointType::universal:
      axis == 0 ? dJointGetUniversalAxis1(j.id, v) : dJointGetUniversalAxis2(j.id, v);
      break;
    case JointType::hinge2:
      axis == 0 ? dJointGetHinge2Axis1(j.id, v) : dJointGetHinge2Axis2(j.id, v);
      break;
    default:
      return motorAxis(j, axis);
  }
  return toVec(v);
}

void OdeEngine::setParameter(Joint joint, JointParameter p, int axis, double wanted) {
  JointData& j = *data(joint);
  if (!hasParameter(j, p, axis) || std::isnan(wanted)) return;
  // An infinite stop means that there is none.
  const bool noStop = std::isinf(wanted) && (p == JointParameter::lowStop || p == JointParameter::highStop);
  const double v = rounded(*j.world, noStop ? wanted : bounded(wanted));
  const int name = odeParameter(p, axis);
  setOde(j, name, v);
  mirrored(j, p, axis) = getOde(j, name);  // ODE may reject or clamp a value
}

void OdeEngine::drive(Joint joint, int axis, double speed) {
  JointData& j = *data(joint);
  if (!hasParameter(j, JointParameter::velocity, axis) || std::isnan(speed)) return;
  const double v = rounded(*j.world, bounded(speed));
  setOde(j, odeParameter(JointParameter::velocity, axis), v);
  j.axes[axis].velocity = v;

  // Wake the first body of attach().
  if (speed == 0 || j.reversed || !j.a || j.a->awake) return;
  OdeEngine::setEnabled(handle(*data(j.a)), true);
}

bool OdeEngine::atStop(Joint joint, int axis) const {
  const JointData& j = *data(joint);
  if (axis < 0 || axis >= axesOf(j.type)) return false;
  const engine::SolverAxis& a = j.axes[axis];
  const double angle = OdeEngine::angle(joint, axis);
  if (!j.world->exactReplay || j.type == JointType::slider) return angle <= a.lowStop || angle >= a.highStop;
  // Exact replay compares in degrees, rounded where the installed base rounds: a foot may rest at its stop for many
  // cycles, and the last bit decides whether its motor accepts commands (protocol, section 2.1).
  const double angleDeg = roundToFloat(radToDeg(angle));
  const auto stopDeg = [](double stop) { return stop * 180.0 / kPi; };
  return angleDeg <= stopDeg(a.lowStop) || angleDeg >= stopDeg(a.highStop);
}

double OdeEngine::parameter(Joint joint, JointParameter p, int axis) const {
  JointData& j = *data(joint);
  return hasParameter(j, p, axis) ? mirrored(j, p, axis) : 0;
}

double OdeEngine::angle(Joint joint, int axis) const {
  const JointData& j = *data(joint);
  if (axis < 0 || axis >= axesOf(j.type) || !j.attached()) return 0;
  switch (j.type) {
    case JointType::hinge:
      return hingeAngle(j);
    case JointType::slider:
      return dJointGetSliderPosition(j.id);
    case JointType::universal:
      return axis == 0 ? dJointGetUniversalAngle1(j.id) : dJointGetUniversalAngle2(j.id);
    case JointType::hinge2:
      return axis == 0 ? dJointGetHinge2Angle1(j.id) : dJointGetHinge2Angle2(j.id);
    default:
      return axis < j.motorAxes ? dJointGetAMotorAngle(j.id, axis) : 0;
  }
}

double OdeEngine::angleRate(Joint joint, int axis) const {
  const JointData& j = *data(joint);
  if (axis < 0 || axis >= axesOf(j.type) || !j.attached()) return 0;
  switch (j.type) {
    case JointType::hinge:
      return dJointGetHingeAngleRate(j.id);
    case JointType::slider:
      return dJointGetSliderPositionRate(j.id);
    case JointType::universal:
      return axis == 0 ? dJointGetUniversalAngle1Rate(j.id) : dJointGetUniversalAngle2Rate(j.id);
    case JointType::hinge2:
      return axis == 0 ? dJointGetHinge2Angle1Rate(j.id) : dJointGetHinge2Angle2Rate(j.id);
    default:
      break;
  }
  // ODE does not compute the rates of angular motors: project the relative angular velocity on the axis.
  if (axis >= j.motorAxes) return 0;
  const double rate = motorAxis(j, axis).dot(angularVelocity(j.a) - angularVelocity(j.b));
  return j.reversed ? -rate : rate;
}

void OdeEngine::setFeedback(Joint joint, bool on) {
  JointData& j = *data(joint);
  j.wantsFeedback = on;
  j.feedback = {};
  dJointSetFeedback(j.id, on ? &j.feedback : nullptr);
}

void OdeEngine::feedback(Joint joint, Vec3& force1, Vec3& torque1, Vec3& force2, Vec3& torque2) const {
  const JointData& j = *data(joint);
  force1 = toVec(j.feedback.f1), torque1 = toVec(j.feedback.t1);
  force2 = toVec(j.feedback.f2), torque2 = toVec(j.feedback.t2);
  if (!j.reversed) return;
  // ODE reverses a joint whose first body is the world.
  std::swap(force1, force2);
  std::swap(torque1, torque2);
}

}  // namespace spark
