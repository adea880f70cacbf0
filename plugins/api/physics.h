#pragma once
/// \file
/// Interfaces of bodies, joints and colliders for other plugins, and the base classes of collision handlers and body
/// controllers. Double precision, SI units, radians, world frame unless a name says otherwise. Used in the simulation's
/// thread; in the sense phase several threads may call the const functions.

#include <optional>
#include <span>

#include "api/engine.h"
#include "api/phases.h"
#include "api/scene.h"
#include "api/scene_joint.h"
#include "spark/abi/api/physics.h"

namespace spark {

/// A rigid body. Offered by RigidBody. Find it as `childOf<IRigidBody>()` of its transform, or as ancestor of a body
/// controller.
class IRigidBody {
 public:
  SPARK_INTERFACE(IRigidBody, 3);
  virtual ~IRigidBody() = default;
  /// The node that offers it.
  virtual Leaf& leaf() = 0;
  /// Body::id in the model of its world; 0: it is in none.
  virtual std::uint64_t identity() const = 0;
  /// The current state in the engine; after the physics phase that of the new step.
  virtual engine::BodyState state() const = 0;
  /// kg.
  virtual double mass() const = 0;
  /// Moves the body at once and wakes it; its transform follows in the next place phase.
  virtual void setPose(const Pose& pose) = 0;
  /// Moves the centre of mass [m], like setPose(). The rotation is unchanged, to the last bit.
  virtual void setPosition(const Vec3& position) = 0;
  /// Sets the velocity of the centre of mass [m/s]. A velocity other than 0 wakes the body.
  virtual void setVelocity(const Vec3& v) = 0;
  /// Sets the angular velocity [rad/s]. A velocity other than 0 wakes the body.
  virtual void setAngularVelocity(const Vec3& w) = 0;
  /// Adds a force at the centre of mass for the next step [N]. A force other than 0 wakes the body.
  virtual void addForce(const Vec3& f) = 0;
  /// Adds a torque for the next step [Nm]. A torque other than 0 wakes the body.
  virtual void addTorque(const Vec3& t) = 0;
  /// Adds the force -linear v and the torque -angular w for the next step, with the current velocities v and w
  /// [N s/m, N m s]; nothing while the body sleeps.
  virtual void addDrag(double linear, double angular) = 0;
  /// False while the body sleeps: it has been at rest for a while, and the solver skips it.
  virtual bool enabled() const = 0;
  /// Wakes the body.
  virtual void enable() = 0;
  /// The transform that the body moves, the nearest above it.
  virtual Transform* bodyTransform() const = 0;
};

/// True if the transform has a body of its own.
inline bool hasBody(const Transform& transform) { return transform.childOf<IRigidBody>() != nullptr; }
/// Route to the body that a sensor or an effector belongs to: that of the nearest transform above it that has one.
inline Route<IRigidBody> BodyAround() {
  return Above<Transform>().where<hasBody>("Transform with a body").child<IRigidBody>();
}

/// A joint, for sensors and effectors. Offered by HingeJoint and all other joint classes.
class IJoint {
 public:
  SPARK_INTERFACE(IJoint, 6);
  virtual ~IJoint() = default;
  /// The node that offers it.
  virtual Leaf& leaf() = 0;
  /// Joint::id in the model of its world; 0: it is in none.
  virtual std::uint64_t identity() const = 0;
  virtual engine::JointType jointType() const = 0;
  /// Body 0 (child link) or 1 (parent link); nullptr: the static world.
  virtual IRigidBody* body(int index) const = 0;
  /// Number of axes with motor and stops, 0 to 3.
  virtual int axes() const = 0;
  /// The common point of both bodies, world frame [m]; zero for joints without one.
  virtual Vec3 anchor() const = 0;
  /// Unit vector along an axis, world frame; zero when there is no such axis.
  virtual Vec3 axisNow(int axis) const = 0;
  /// Sets the common point of both bodies, world frame [m]. Throws RefusedValue when it is not finite.
  virtual void setWorldAnchor(const Vec3& world) = 0;
  /// Sets the direction of an axis, world frame. Throws Error when its length is 0.
  virtual void setWorldAxis(int axis, const Vec3& world) = 0;
  /// Continuous: a hinge that has turned once is at 2 pi [rad; slider: m].
  virtual double angle(int axis) const = 0;
  /// The angle as a perceptor of the installed base has it: with exactReplay within one turn, -pi..pi; else angle().
  virtual double sensedAngle(int axis) const = 0;
  virtual double angleRate(int axis) const = 0;  ///< rad/s; slider: m/s
  /// A parameter of an axis; 0 where the joint does not have it.
  virtual double parameter(engine::JointParameter p, int axis) const = 0;
  /// Sets a parameter of an axis; ignored where the joint does not have it.
  virtual void setParameter(engine::JointParameter p, int axis, double v) = 0;
  /// Sets the target speed of the motor [rad/s; slider: m/s]. A speed other than 0 wakes the child link.
  virtual void drive(int axis, double speed) = 0;
  /// Puts a controller in place of the axis' motor, or changes its targets. Wakes the child link.
  virtual void control(int axis, const engine::Control& control) = 0;
  /// True when the axis is at its lower or upper stop, or beyond.
  virtual bool atStop(int axis) const = 0;
  /// Largest speed that effectors may command [rad/s]; 0: unlimited.
  virtual double maxSpeed(int axis) const = 0;
  /// Sum of the magnitudes of the torques on both bodies in the last step [Nm]; of an angular motor on the first body
  /// alone. 0 without feedback.
  virtual double feedbackTorque() const = 0;
  /// True when the joint measures that torque.
  virtual bool feedback() const = 0;
};

/// An actuator with one control that is no controller of a joint: one that only the engine in use has. For effectors.
class IActuator {
 public:
  SPARK_INTERFACE(IActuator, 1);
  virtual ~IActuator() = default;
  /// Sets its control, from the next step on. The actuator clamps it to its range.
  virtual void setControl(double u) = 0;
};

/// A motor modelled as a device, with current, heat and stiffness. Offered beside IJoint by AngularMotor, for sensors
/// and effectors.
class IMotor {
 public:
  SPARK_INTERFACE(IMotor, 1);
  virtual ~IMotor() = default;
  /// Fraction of its maximum torque that the motor may use, 0..1.
  virtual double stiffness() const = 0;
  /// Sets that fraction, clamped to 0..1, from the next step on.
  virtual void setStiffness(double fraction) = 0;
  /// Temperature of the winding [deg C].
  virtual double temperature() const = 0;
  /// Current in the last step [A].
  virtual double current() const = 0;
  /// True when the motor accepts no commands: it is too hot, or its battery is empty.
  virtual bool disabled() const = 0;
};

/// A battery, for sensors. Offered by Battery.
class IBattery {
 public:
  SPARK_INTERFACE(IBattery, 1);
  virtual ~IBattery() = default;
  /// Stored energy [J].
  virtual double power() const = 0;
  /// Stored energy when full [J]; 0: unknown.
  virtual double capacity() const = 0;
};

/// Collision geometry. Offered by all collider classes.
class ICollider {
 public:
  SPARK_INTERFACE(ICollider, 2);
  virtual ~ICollider() = default;
  /// The node that offers it.
  virtual Leaf& leaf() = 0;
  /// Geom::id in the model of its world; 0: it has no geometry there.
  virtual std::uint64_t identity() const { return 0; }
  /// The body that it moves with; nullptr: static.
  virtual IRigidBody* body() const = 0;
  /// Axis-aligned bounding box, world frame [m]; infinite for planes.
  virtual void bounds(Vec3& low, Vec3& high) const = 0;
  /// The shape; nullopt for colliders that only contain others or have no geometry.
  virtual std::optional<engine::ShapeDescription> shape() const = 0;
  /// Pose of that shape in the frame of the nearest transform above; of a plane in the world frame.
  virtual Pose poseInTransform() const = 0;
};

/// A list of the colliders that touched. Offered by RecorderHandler.
class ICollisionRecorder {
 public:
  SPARK_INTERFACE(ICollisionRecorder, 1);
  virtual ~ICollisionRecorder() = default;
  /// The colliders that touched the handler's collider since clear(), each once. References to removed ones are empty.
  virtual const std::vector<Ref<Leaf>>& colliders() const = 0;
  /// Empties the list.
  virtual void clear() = 0;
};

/// One contact point, from the point of view of one of its colliders.
struct Collision {
  ICollider& self;   ///< the collider of the handler
  ICollider& other;  ///< the collider that it touches
  engine::Contact& contact;
  bool direct;  ///< true: `self` is A of the contact
};

/// Base of collision handlers, children of a collider. Registered by `physics`.
class CollisionHandler : public SceneNode {
  SPARK_CLASS(CollisionHandler, SceneNode)
 public:
  static void describe(Description<CollisionHandler>& d) {
    d.doc("Reacts to the contacts of the collider above it.");
    d.abstract();
  }
  /// Called before the solver for each contact point of the collider, in the physics phase. It may change the contact,
  /// but not the tree.
  virtual void onCollision(const Collision& collision) = 0;
  /// Called after the solver for each contact point with feedback. Where a step of the simulation has several of the
  /// engine's, it is called after each, with a force that is divided by their number: their sum is the mean.
  virtual void onSolved(const Collision&) {}
  /// The contact surface of the collider; nullptr: this handler does not make contacts solid.
  virtual const engine::Surface* surface() const { return nullptr; }
};

/// Makes contacts solid and holds the surface. A contact is solid when both colliders have one, or no handler at all
/// (a bouncy default). Registered by `physics`.
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
    d.doc("Makes the contacts of its collider solid and holds the surface.");
    d.property("contactBounceMode", &H::bounceMode, &H::setBounceMode).doc("Contacts bounce.");
    d.property("contactBounceValue", &H::bounce, &H::setBounce).range(0, 1e6).doc("Coefficient of restitution.");
    d.property("minBounceVel", &H::bounceVelocity, &H::setBounceVelocity)
        .unit("m/s")
        .range(0, 1e8)
        .doc("Smallest approach speed at which contacts bounce.");
    d.property("contactSoftERPMode", &H::erpMode, &H::setErpMode)
        .doc("Contacts use contactSoftERP instead of the world's ERP.");
    d.property("contactSoftERP", &H::erp, &H::setErp).range(0, 1).doc("Error reduction parameter of contacts.");
    d.property("contactSoftCFMMode", &H::cfmMode, &H::setCfmMode)
        .doc("Contacts use contactSoftCFM instead of the world's CFM.");
    d.property("contactSoftCFM", &H::cfm, &H::setCfm).range(0, kSoftest).doc("Constraint force mixing of contacts.");
    d.property("contactSlipMode", &H::slipMode, &H::setSlipMode)
        .doc("Contacts slip in proportion to the force, along both tangents.");
    d.property("contactSlip", &H::slip, &H::setSlip)
        .range(0, kSoftest)
        .doc("Slip per force, along both tangents [m/(N s)].");
    d.property("contactMu", &H::mu, &H::setMu)
        .unit("N")
        .min(0)
        .doc("Maximum friction force along each tangent [N]; infinite by default.");
    d.property("contactPyramid", &H::pyramid, &H::setPyramid)
        .doc("contactMu is a coefficient: friction is bounded by it times the normal force.");
  }
  void onCollision(const Collision&) override {}
  const engine::Surface* surface() const override { return &surface_; }
  /// The surface, to be changed in place.
  engine::Surface& editSurface() { return surface_; }

  /// The largest compliance, per force [m/(N s)], that engines can compute with.
  static constexpr double kSoftest = 1e9;

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
  bool pyramid() const { return surface_.pyramid; }
  void setPyramid(bool on) { surface_.pyramid = on; }
  engine::Surface surface_;
};

/// Base of nodes that act on the body above them in the prepare phase. Registered by `physics`.
class BodyController : public SceneNode {
  SPARK_CLASS(BodyController, SceneNode)
 public:
  static void describe(Description<BodyController>& d) {
    d.doc("Acts on the body above it before each step.");
    d.abstract();
    d.link(&BodyController::body_, Above<IRigidBody>());
    d.on<&BodyController::prepare>(phase::kPrepare);
  }
  /// Acts on the body. The next step integrates `event.step` seconds.
  virtual void control(IRigidBody& body, const Event& event) = 0;

 private:
  void prepare(const Event& event) {
    if (IRigidBody* body = body_.get()) control(*body, event);
  }
  Link<IRigidBody> body_;
};

/// Where a ray meets a collider first.
struct RayHit {
  ICollider* collider;
  double distance;  ///< from the ray's origin [m]
  Vec3 position;    ///< world frame [m]
  Vec3 normal;      ///< of the surface, against the ray; length 1
};

/// The physics server, at /sys/server/physics.
class IPhysicsServer {
 public:
  SPARK_INTERFACE(IPhysicsServer, 4);
  static constexpr const char* kPath = "/sys/server/physics";
  virtual ~IPhysicsServer() = default;
  /// The model and the state of the active scene's world. Throw Error when there is none. Valid until the tree changes;
  /// in the sense phase several threads may read them.
  virtual const engine::Model& model() = 0;
  virtual const engine::State& state() = 0;
  /// Appends all bodies of a subtree, `root` included, in tree order.
  virtual void bodies(Node& root, std::vector<IRigidBody*>& out) = 0;
  /// All contacts of the last step, solved or not. `forceOnA` is valid where `feedback` is set; the property
  /// measureForces sets it for every solved contact. Valid until the next step or change of the tree; empty after such
  /// a change.
  virtual std::span<const engine::Contact> contacts() const = 0;
  /// The first collider on the way from `from` along `direction` (any length above 0), at most `length` far [m]; below
  /// `except` only what is static and does not contain `from`. A collider around it is met where the ray leaves. Throws
  /// Error when there is no world. Several threads may call it at once in the sense phase; so for overlaps().
  virtual std::optional<RayHit> castRay(const Vec3& from, const Vec3& direction, double length,
                                        const Node* except = nullptr) = 0;
  /// True if a collider is between two points [m]. Those that contain `to` (within 1 mm), those that move with `own`
  /// and those below `except` do not count: they are the object that is looked at, and the one that looks. Otherwise
  /// as castRay().
  virtual bool isHidden(const Vec3& from, const Vec3& to, const IRigidBody* own, const Node* except) = 0;
  /// Prepares for many calls of castRay() and isHidden(): they find the same, faster, until a body is moved. Sensors
  /// that cast rays call it in ISharedView::share(). Simulation thread.
  virtual void prepareRays() = 0;
  /// True if the active scene has a world.
  virtual bool hasWorld() = 0;
  /// Appends the colliders that a sphere touches, in order of creation.
  virtual void overlaps(const Vec3& center, double radius, std::vector<ICollider*>& out) = 0;
  /// The collider that is the `owner` of a contact.
  virtual ICollider& colliderOf(void* owner) const = 0;
};

}  // namespace spark
