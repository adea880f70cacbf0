#pragma once
/// \file
/// What other plugins see of bodies, colliders and joints, and the bases of collision handlers and body controllers.
/// Double precision, SI, radians, world frame unless a name says otherwise. Used in the simulation's thread; readers in
/// the sense phase may be several.

#include <optional>
#include <span>

#include "api/engine.h"
#include "api/phases.h"
#include "api/scene.h"
#include "spark/abi/api/physics.h"

namespace spark {

/// A body: what RigidBody offers. Found by `childOf<IRigidBody>()` of its transform, or as ancestor of controllers.
class IRigidBody {
 public:
  SPARK_INTERFACE(IRigidBody, 2);
  virtual ~IRigidBody() = default;
  virtual Leaf& leaf() = 0;
  /// The engine's state now: after physics the new one.
  virtual engine::BodyState state() const = 0;
  /// kg.
  virtual double mass() const = 0;
  /// Immediately; the transform follows at the next place phase.
  virtual void setPose(const Pose& pose) = 0;
  /// m, the centre of mass in the world; as setPose, but its rotation stays as it is, to the last bit.
  virtual void setPosition(const Vec3& position) = 0;
  /// m/s of the centre of mass, at once. Not zero: wakes the body.
  virtual void setVelocity(const Vec3& v) = 0;
  /// rad/s, at once. Not zero: wakes the body.
  virtual void setAngularVelocity(const Vec3& w) = 0;
  /// N at the centre of mass, for the next step only, added to what others add. Not zero: wakes the body.
  virtual void addForce(const Vec3& f) = 0;
  /// Nm, likewise.
  virtual void addTorque(const Vec3& t) = 0;
  /// Force -linear v and torque -angular w for the next step, of its speeds now [N s/m, N m s]; nothing while it
  /// sleeps.
  virtual void addDrag(double linear, double angular) = 0;
  /// False while it sleeps: nothing moved it for a while, and the solver leaves it out.
  virtual bool enabled() const = 0;
  /// Wakes it.
  virtual void enable() = 0;
  /// The transform that the body moves: its nearest.
  virtual Transform* bodyTransform() const = 0;
};

/// A joint: what HingeJoint and the others offer to sensors and effectors.
class IJoint {
 public:
  SPARK_INTERFACE(IJoint, 2);
  virtual ~IJoint() = default;
  virtual Leaf& leaf() = 0;
  virtual engine::JointType jointType() const = 0;
  /// 0: child link, 1: parent link; nullptr is the static world.
  virtual IRigidBody* body(int index) const = 0;
  /// Axes that have a motor and stops, 0 to 3.
  virtual int axes() const = 0;
  /// Where it holds its bodies together, in the world [m]; zero for joints without such a point.
  virtual Vec3 anchor() const = 0;
  /// Direction of an axis in the world, of length 1; zero when there is none.
  virtual Vec3 axisNow(int axis) const = 0;
  virtual double angle(int axis) const = 0;      ///< rad; slider m
  virtual double angleRate(int axis) const = 0;  ///< rad/s; slider m/s
  virtual double parameter(engine::JointParameter p, int axis) const = 0;
  virtual void setParameter(engine::JointParameter p, int axis, double v) = 0;
  /// Sets the motor's speed [rad/s; slider m/s]; the child link wakes when it is to move.
  virtual void drive(int axis, double speed) = 0;
  /// The axis is at its least or greatest angle, or beyond.
  virtual bool atStop(int axis) const = 0;
  /// rad/s; 0 when unlimited. Clamps effector commands only.
  virtual double maxSpeed(int axis) const = 0;
  /// Sum of the torque's magnitudes on both bodies in the last step [Nm]; 0 without feedback.
  virtual double feedbackTorque() const = 0;
  /// True when it measures that torque.
  virtual bool feedback() const = 0;
};

/// A motor that is modelled as a device, with current, heat and stiffness. Offered beside IJoint by AngularMotor, for
/// sensors and effectors.
class IMotor {
 public:
  SPARK_INTERFACE(IMotor, 1);
  virtual ~IMotor() = default;
  /// The fraction of its greatest torque that it may use, from 0 to 1.
  virtual double stiffness() const = 0;
  /// `fraction`: 0 to 1. It holds from the next step on.
  virtual void setStiffness(double fraction) = 0;
  /// Of the winding [deg C].
  virtual double temperature() const = 0;
  /// In the last step [A].
  virtual double current() const = 0;
  /// It takes no commands: it is too hot, or its battery is empty.
  virtual bool disabled() const = 0;
};

/// A store of energy. Offered by Battery, for sensors.
class IBattery {
 public:
  SPARK_INTERFACE(IBattery, 1);
  virtual ~IBattery() = default;
  /// The energy that it holds now [J].
  virtual double power() const = 0;
  /// The energy that it holds when full [J]; 0: unknown.
  virtual double capacity() const = 0;
};

/// Geometry that touches.
class ICollider {
 public:
  SPARK_INTERFACE(ICollider, 1);
  virtual ~ICollider() = default;
  virtual Leaf& leaf() = 0;
  /// nullptr when static.
  virtual IRigidBody* body() const = 0;
  /// World axis-aligned bounds; infinite for planes.
  virtual void bounds(Vec3& low, Vec3& high) const = 0;
  /// The shape it has; nothing for colliders that only group or are not supported.
  virtual std::optional<engine::ShapeDescription> shape() const = 0;
  /// Where that shape is in the frame of the nearest transform above, wherever that is now; planes are in the world's.
  virtual Pose poseInTransform() const = 0;
};

/// Lists the colliders that touched the handler's own since clear(). Offered by RecorderHandler.
class ICollisionRecorder {
 public:
  SPARK_INTERFACE(ICollisionRecorder, 1);
  virtual ~ICollisionRecorder() = default;
  virtual const std::vector<Ref<Leaf>>& colliders() const = 0;
  virtual void clear() = 0;
};

/// One contact point as a handler sees it.
struct Collision {
  ICollider& self;
  ICollider& other;
  engine::Contact& contact;
  bool direct;  ///< self is the contact's A
};

/// Child of a collider; runs for each contact point, before the solver. Registered by `physics`.
class CollisionHandler : public SceneNode {
  SPARK_CLASS(CollisionHandler, SceneNode)
 public:
  static void describe(Description<CollisionHandler>& d) {
    d.doc("Reacts to the contacts of the collider above it.");
    d.abstract();
  }
  virtual void onCollision(const Collision& collision) = 0;
  /// Runs after the solver for handlers that asked for feedback.
  virtual void onSolved(const Collision&) {}
  /// The surface it wants contacts to have; nullptr: contacts are not solved for its sake.
  virtual const engine::Surface* surface() const { return nullptr; }
};

/// Makes contacts solid. Both colliders need one (or none at all: a bouncy default). Registered by `physics`.
class ContactJointHandler : public CollisionHandler {
  SPARK_CLASS(ContactJointHandler, CollisionHandler)
 public:
  ContactJointHandler() {
    surface_.bounceOn = true;
    surface_.bounce = 0.8;
    surface_.bounceVelocity = 2.0;
    surface_.slip1 = surface_.slip2 = 5e-3;
  }
  static void describe(Description<ContactJointHandler>& d) {
    using H = ContactJointHandler;
    d.doc("Makes contacts of its collider solid; holds the surface.");
    d.property("contactBounceMode", &H::bounceMode, &H::setBounceMode).doc("Contacts bounce.");
    d.property("contactBounceValue", &H::bounce, &H::setBounce).min(0).doc("Restitution.");
    d.property("minBounceVel", &H::bounceVelocity, &H::setBounceVelocity)
        .unit("m/s")
        .min(0)
        .doc("Least speed at which contacts bounce.");
    d.property("contactSoftERPMode", &H::erpMode, &H::setErpMode).doc("Contacts have their own error reduction.");
    d.property("contactSoftERP", &H::erp, &H::setErp).range(0, 1).doc("Error reduction of contacts.");
    d.property("contactSoftCFMMode", &H::cfmMode, &H::setCfmMode)
        .doc("Contacts have their own constraint force mixing.");
    d.property("contactSoftCFM", &H::cfm, &H::setCfm).min(0).doc("Constraint force mixing of contacts.");
    d.property("contactSlipMode", &H::slipMode, &H::setSlipMode).doc("Force-dependent slip in both directions.");
    d.property("contactSlip", &H::slip, &H::setSlip).min(0).doc("Slip of contacts, both directions.");
    d.property("contactMu", &H::mu, &H::setMu)
        .unit("N")
        .min(0)
        .doc("Greatest friction along each tangent [N]; infinite by default.");
  }
  void onCollision(const Collision&) override {}
  const engine::Surface* surface() const override { return &surface_; }
  engine::Surface& editSurface() { return surface_; }

 private:
  bool bounceMode() const { return surface_.bounceOn; }
  void setBounceMode(bool on) { surface_.bounceOn = on; }
  double bounce() const { return surface_.bounce; }
  void setBounce(double v) { surface_.bounce = v; }
  double bounceVelocity() const { return surface_.bounceVelocity; }
  void setBounceVelocity(double v) { surface_.bounceVelocity = v; }
  bool erpMode() const { return surface_.softErpOn; }
  void setErpMode(bool on) { surface_.softErpOn = on; }
  double erp() const { return surface_.softErp; }
  void setErp(double v) { surface_.softErp = v; }
  bool cfmMode() const { return surface_.softCfmOn; }
  void setCfmMode(bool on) { surface_.softCfmOn = on; }
  double cfm() const { return surface_.softCfm; }
  void setCfm(double v) { surface_.softCfm = v; }
  bool slipMode() const { return surface_.slipOn; }
  void setSlipMode(bool on) { surface_.slipOn = on; }
  double slip() const { return surface_.slip1; }
  void setSlip(double v) { surface_.slip1 = surface_.slip2 = v; }
  double mu() const { return surface_.mu; }
  void setMu(double v) { surface_.mu = v; }
  engine::Surface surface_;
};

/// Acts on the body above it in the prepare phase. Registered by `physics`.
class BodyController : public SceneNode {
  SPARK_CLASS(BodyController, SceneNode)
 public:
  static void describe(Description<BodyController>& d) {
    d.doc("Acts on the body above it before each step.");
    d.abstract();
    d.link(&BodyController::body_, Above<IRigidBody>());
    d.on<&BodyController::prepare>(phase::kPrepare);
  }
  /// `event.step` seconds will be integrated next.
  virtual void control(IRigidBody& body, const Event& event) = 0;

 private:
  void prepare(const Event& event) {
    if (IRigidBody* body = body_.get()) control(*body, event);
  }
  Link<IRigidBody> body_;
};

/// The physics server, at /sys/server/physics.
class IPhysicsServer {
 public:
  SPARK_INTERFACE(IPhysicsServer, 1);
  static constexpr const char* kPath = "/sys/server/physics";
  virtual ~IPhysicsServer() = default;
  virtual engine::IEngine& engine() = 0;
  /// The world of the active scene; throws Error when there is none.
  virtual engine::World world() = 0;
  /// All bodies of a subtree in tree order.
  virtual void bodies(Node& root, std::vector<IRigidBody*>& out) = 0;
  /// The contacts of the last step, whether they were solved or not; owners are ICollider (see colliderOf). `forceOnA`
  /// counts where `feedback` says so: property measureForces asks for all. Valid until the next step or change of the
  /// tree; empty since such a change.
  virtual std::span<const engine::Contact> contacts() const = 0;
  /// The collider that an owner of these contacts is.
  virtual ICollider& colliderOf(void* owner) const = 0;
};

}  // namespace spark
