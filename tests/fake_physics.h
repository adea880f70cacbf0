#pragma once
/// \file
/// Bodies, joints and colliders without an engine. A test sets the values that they return.

#include <array>
#include <map>
#include <utility>

#include "api/agents.h"
#include "api/physics.h"

namespace spark::test {

/// A body whose state a test sets. It adds up the forces that are applied to it.
class FakeBody : public SceneNode, public IRigidBody {
  SPARK_CLASS(FakeBody, SceneNode)
 public:
  static void describe(Description<FakeBody>& d) { d.implements<IRigidBody>(); }
  Leaf& leaf() override { return *this; }
  std::uint64_t identity() const override { return 0; }
  engine::BodyState state() const override { return now; }
  double mass() const override { return 1; }
  void setPose(const Pose& pose) override { now.position = pose.position, now.rotation = pose.rotation; }
  void setPosition(const Vec3& p) override { now.position = p; }
  void setVelocity(const Vec3& v) override { now.linearVelocity = v; }
  void setAngularVelocity(const Vec3& w) override { now.angularVelocity = w; }
  void addForce(const Vec3& f) override { force += f; }
  void addTorque(const Vec3&) override {}
  void addDrag(double linear, double) override { force -= linear * now.linearVelocity; }
  bool enabled() const override { return awake; }
  void enable() override { awake = true; }
  Transform* bodyTransform() const override { return transform(); }

  engine::BodyState now{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Mat3::Identity()};
  Vec3 force = Vec3::Zero();
  bool awake = true;
};

/// A joint and a simulated motor whose parameters and angles a test sets.
class FakeJoint : public SceneNode, public IJoint, public IMotor {
  SPARK_CLASS(FakeJoint, SceneNode)
 public:
  static void describe(Description<FakeJoint>& d) {
    d.implements<IJoint>();
    d.implements<IMotor>();
  }
  Leaf& leaf() override { return *this; }
  std::uint64_t identity() const override { return 0; }
  engine::JointType jointType() const override { return type; }
  IRigidBody* body(int index) const override { return bodies[index]; }
  int axes() const override { return count; }
  Vec3 anchor() const override { return point; }
  Vec3 axisNow(int) const override { return Vec3::UnitZ(); }
  void setWorldAnchor(const Vec3&) override {}
  void setWorldAxis(int, const Vec3&) override {}
  double angle(int axis) const override { return angles[axis]; }
  double sensedAngle(int axis) const override { return angles[axis]; }
  double angleRate(int axis) const override { return rates[axis]; }
  double parameter(engine::JointParameter p, int axis) const override {
    const auto found = parameters.find({p, axis});
    if (found != parameters.end()) return found->second;
    return p == engine::JointParameter::lowStop ? -HUGE_VAL : p == engine::JointParameter::highStop ? HUGE_VAL : 0.0;
  }
  void setParameter(engine::JointParameter p, int axis, double v) override { parameters[{p, axis}] = v; }
  void drive(int axis, double speed) override {
    setParameter(engine::JointParameter::velocity, axis, speed);
    if (bodies[0] && speed != 0) bodies[0]->enable();
  }
  void control(int axis, const engine::Control& control) override { controls[axis] = control; }
  bool atStop(int axis) const override {
    return angles[axis] <= parameter(engine::JointParameter::lowStop, axis) ||
           angles[axis] >= parameter(engine::JointParameter::highStop, axis);
  }
  double maxSpeed(int axis) const override { return maxSpeeds[axis]; }
  double feedbackTorque() const override { return torque; }
  bool feedback() const override { return measures; }
  double stiffness() const override { return device.stiffness; }
  void setStiffness(double fraction) override { device.stiffness = fraction; }
  double temperature() const override { return device.temperature; }
  double current() const override { return device.current; }
  bool disabled() const override { return device.disabled; }
  double velocity(int axis) const { return parameter(engine::JointParameter::velocity, axis); }

  engine::JointType type = engine::JointType::hinge;
  int count = 1;  ///< of axes
  std::array<IRigidBody*, 2> bodies{};
  std::array<double, 3> angles{}, rates{}, maxSpeeds{};
  std::array<engine::Control, 3> controls{};
  std::map<std::pair<engine::JointParameter, int>, double> parameters;
  Vec3 point = Vec3::Zero();
  double torque = 0;
  bool measures = false;
  struct {
    double stiffness = 1, temperature = 23, current = 0;
    bool disabled = false;
  } device;
};

/// A collider without a shape.
class FakeCollider : public SceneNode, public ICollider {
  SPARK_CLASS(FakeCollider, SceneNode)
 public:
  static void describe(Description<FakeCollider>& d) { d.implements<ICollider>(); }
  Leaf& leaf() override { return *this; }
  IRigidBody* body() const override { return nullptr; }
  void bounds(Vec3& low, Vec3& high) const override { low = high = Vec3::Zero(); }
  std::optional<engine::ShapeDescription> shape() const override { return std::nullopt; }
  Pose poseInTransform() const override { return {}; }
};

/// A battery that has lost a quarter of its energy.
class FakeBattery : public SceneNode, public IBattery {
  SPARK_CLASS(FakeBattery, SceneNode)
 public:
  static void describe(Description<FakeBattery>& d) { d.implements<IBattery>(); }
  double power() const override { return 750; }
  double capacity() const override { return 1000; }
};

/// Registers the fakes and the bases that sensors and effectors derive from.
inline void registerFakePhysics(Kernel& kernel) {
  kernel.registerClass<SceneNode>();
  kernel.registerClass<Transform>();
  kernel.registerClass<Perceptor>();
  kernel.registerClass<Effector>();
  kernel.registerClass<AgentAspect>();
  kernel.registerClass<CollisionHandler>();
  kernel.registerClass<ContactJointHandler>();
  kernel.registerClass<FakeBody>();
  kernel.registerClass<FakeJoint>();
  kernel.registerClass<FakeCollider>();
  kernel.registerClass<FakeBattery>();
}

/// The predicates as an agent would receive them, with two decimals.
inline std::string sexpOf(const Predicates& predicates) {
  std::string text;
  writeSexp(predicates, 2, text);
  return text;
}

}  // namespace spark::test
