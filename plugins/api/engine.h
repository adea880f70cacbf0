#pragma once
/// \file
/// The interface between the plugin `physics` and an engine: opaque typed handles, contacts as plain data, one call
/// that steps a world. Double precision, SI units, radians. An engine is used by one thread at a time; only the const
/// getters may be called from several threads, between two steps.

#include <span>
#include <vector>

#include "api/math.h"
#include "spark/abi/api/engine.h"
#include "spark/node.h"

namespace spark::engine {

// Handles. Valid from the create call to the destroy call; `none` is no object.
enum class World : std::uintptr_t { none = 0 };
enum class Space : std::uintptr_t { none = 0 };
enum class Body : std::uintptr_t { none = 0 };
enum class Geom : std::uintptr_t { none = 0 };
enum class Joint : std::uintptr_t { none = 0 };

/// Parameters of a world. For erp and cfm see the ODE manual, sections "Joint error and the error reduction parameter
/// (ERP)" and "Soft constraint and constraint force mixing (CFM)".
struct WorldParameters {
  Vec3 gravity{0, 0, -9.81};           ///< m/s^2
  double erp = 0.2;                    ///< fraction of a constraint's error that one step corrects, 0..1
  double cfm = 1e-5;                   ///< constraint force mixing, 0 or more
  bool autoDisable = true;             ///< bodies at rest fall asleep
  double contactSurfaceLayer = 0.001;  ///< allowed penetration depth of contacts [m]
};

/// Mass distribution of a body.
struct Mass {
  double mass = 1;                  ///< kg
  Vec3 center = Vec3::Zero();       ///< centre of mass, body frame [m]
  Mat3 inertia = Mat3::Identity();  ///< about the body's origin, body frame [kg m^2]
};

/// Kinds of collision shapes.
enum class Shape { box, sphere, capsule, cylinder, plane, ray, mesh };
/// A collision shape in its own frame. Capsules and cylinders lie along z.
struct ShapeDescription {
  Shape shape = Shape::box;
  Vec3 lengths{1, 1, 1};           ///< box: full edge lengths [m]
  double radius = 1;               ///< sphere, capsule, cylinder [m]
  double length = 1;               ///< capsule (without the caps), cylinder, ray [m]
  double plane[4] = {0, 0, 1, 0};  ///< a b c d of ax + by + cz = d, world frame; the normal need not have length 1
  Vec3 rayOrigin = Vec3::Zero(), rayDirection{0, 0, 1};
  std::vector<double> vertices;          ///< mesh: x y z of each vertex [m]
  std::vector<std::uint32_t> triangles;  ///< mesh: three vertex indices of each triangle
};

/// Joint types of the ODE manual, section "Joint types and joint functions".
enum class JointType { ball, hinge, hinge2, slider, universal, fixed, angularMotor };
/// Parameters of one axis of a joint, as in the section "Stop and motor parameters" of the ODE manual. The suspension
/// parameters belong to axis 0 of hinge2.
enum class JointParameter {
  lowStop,        ///< rad; slider: m; -infinity: no stop
  highStop,       ///< rad; slider: m; infinity: no stop
  velocity,       ///< target speed of the motor [rad/s; slider: m/s]
  maxForce,       ///< largest force [N] or torque [Nm] of the motor; 0: no motor
  fudgeFactor,    ///< scales the excess force of a motor that moves the joint away from a stop, 0..1
  bounce,         ///< restitution of the stops, 0..1
  cfm,            ///< constraint force mixing of the motor
  stopErp,        ///< error reduction parameter of the stops
  stopCfm,        ///< constraint force mixing of the stops
  suspensionErp,  ///< error reduction parameter of the suspension
  suspensionCfm   ///< constraint force mixing of the suspension
};

/// Contact surface of two colliders, combined (scene-language section 3.3). Bounce, soft ERP, soft CFM and slip count
/// only with their flags.
struct Surface {
  bool bounceOn = false, softErpOn = false, softCfmOn = false, slipOn = false;
  /// True: mu is a coefficient, and friction is bounded by mu times the normal force of a solution without friction
  /// (friction pyramid). False: mu is a force.
  bool pyramid = false;
  double mu = HUGE_VAL;         ///< bound of friction along each tangent: a force [N], or a coefficient
  double bounce = 0;            ///< restitution, 0..1
  double bounceVelocity = 0;    ///< smallest approach speed at which the contact bounces [m/s]
  double softErp = 0;           ///< error reduction parameter of the contact
  double softCfm = 0;           ///< constraint force mixing of the contact
  double slip1 = 0, slip2 = 0;  ///< force-dependent slip along the two tangents [m/(N s)]
};

/// One contact point. detect() creates it, collision handlers complete it, step() solves it.
struct Contact {
  Geom geomA = Geom::none, geomB = Geom::none;
  void* ownerA = nullptr;  ///< the owner of geomA, as given to createGeom()
  void* ownerB = nullptr;  ///< the owner of geomB
  Vec3 position, normal;   ///< world frame [m, unit vector]; the normal points into A
  double depth = 0;        ///< penetration depth [m]
  bool solve = false;      ///< the solver is to treat it as a constraint
  bool feedback = false;   ///< step() is to write forceOnA
  Surface surface;
  Vec3 forceOnA = Vec3::Zero();  ///< force on A, world frame [N]
};

/// The contacts of one step, grouped by geom pair, in the order of detection. Reused for all steps, to keep the
/// capacity.
using Contacts = std::vector<Contact>;

/// Returns whether two geoms may collide at all; called with their owners, for every pair with overlapping bounds.
using PairFilter = bool (*)(void* ownerA, void* ownerB);

/// State of a body, world frame.
struct BodyState {
  Vec3 position;         ///< of the centre of mass [m]
  Vec3 linearVelocity;   ///< m/s
  Vec3 angularVelocity;  ///< rad/s
  Mat3 rotation;
};

/// A rigid-body engine. Vectors are in the world frame unless said otherwise. Setters ignore numbers that are not
/// finite; functions that throw say so.
class IEngine {
 public:
  SPARK_INTERFACE(IEngine, 1);
  virtual ~IEngine() = default;

  /// Creates an empty world with default parameters.
  virtual World createWorld() = 0;
  /// Destroys a world and all that is in it.
  virtual void destroyWorld(World) = 0;
  /// Throws Error for a gravity that is not finite.
  virtual void setWorldParameters(World, const WorldParameters&) = 0;

  /// Creates a collision space. `parent` none: a top-level space of the world.
  virtual Space createSpace(World, Space parent) = 0;
  /// Destroys an empty space.
  virtual void destroySpace(Space) = 0;
  /// False: geoms directly in this space do not collide with each other. True by default.
  virtual void setInnerCollision(Space, bool on) = 0;

  /// Creates a body of 1 kg and unit inertia, awake and at rest in the world's origin.
  virtual Body createBody(World) = 0;
  /// Destroys a body. Its geoms become static, its joints are detached.
  virtual void destroyBody(Body) = 0;
  /// Throws Error for a mass that is not above 0, a centre that is not the origin, and an inertia that is not symmetric
  /// and positive definite.
  virtual void setMass(Body, const Mass&) = 0;
  /// The current state; after step() the new one.
  virtual BodyState state(Body) const = 0;
  /// Reads many bodies in one call: awake[i] is 1 for an awake body, else 0; out[i] is the pose of an awake body and
  /// stays unchanged for others. All spans have the same size.
  virtual void posesOfAwake(std::span<const Body>, std::span<std::uint8_t> awake, std::span<Matrix> out) const = 0;
  /// Centre of mass [m]. This and the three setters below do not wake the body.
  virtual void setPosition(Body, const Vec3&) = 0;
  virtual void setRotation(Body, const Mat3&) = 0;
  virtual void setLinearVelocity(Body, const Vec3&) = 0;   ///< m/s
  virtual void setAngularVelocity(Body, const Vec3&) = 0;  ///< rad/s
  virtual void addForce(Body, const Vec3&) = 0;            ///< at the centre of mass, for the next step [N]
  virtual void addTorque(Body, const Vec3&) = 0;           ///< for the next step [Nm]
  /// Adds the force -linear v and the torque -angular w for the current velocities v and w [N s/m, N m s]; nothing
  /// while the body sleeps.
  virtual void addDrag(Body, double linear, double angular) = 0;
  virtual Vec3 force(Body) const = 0;             ///< accumulated for the next step [N]
  virtual Vec3 torque(Body) const = 0;            ///< accumulated for the next step [Nm]
  virtual void setForce(Body, const Vec3&) = 0;   ///< replaces the accumulated force [N]
  virtual void setTorque(Body, const Vec3&) = 0;  ///< replaces the accumulated torque [Nm]
  virtual void setEnabled(Body, bool) = 0;        ///< true: wakes the body; false: puts it to sleep
  virtual bool enabled(Body) const = 0;           ///< false: the body sleeps
  virtual void setGravityMode(Body, bool) = 0;    ///< false: gravity does not act on the body
  /// Appends the body's dynamic state, the counters of auto-disable included: a fixed number of engine-defined values.
  virtual void saveBody(Body, std::vector<double>& out) const = 0;
  /// Restores what saveBody() wrote, bit for bit. Throws Error for another number of values.
  virtual void loadBody(Body, std::span<const double> in) = 0;

  /// Creates a static geom at the identity pose. `owner` is passed to the pair filter and stored in contacts. Throws
  /// Error for an invalid shape.
  virtual Geom createGeom(Space, const ShapeDescription&, void* owner) = 0;
  virtual void destroyGeom(Geom) = 0;
  /// Throws Error for an invalid shape; the geom keeps the old one.
  virtual void setShape(Geom, const ShapeDescription&) = 0;
  /// Attaches the geom to a body, at an offset in the body's frame; none: static. Throws Error for an offset that is
  /// not finite.
  virtual void setBody(Geom, Body, const Pose& offset) = 0;
  /// Sets the world pose of a static geom. Planes ignore it.
  virtual void setPose(Geom, const Pose&) = 0;
  /// World pose of a geom.
  virtual Pose pose(Geom) const = 0;
  /// False: the geom is left out of detect(). True by default.
  virtual void setCollides(Geom, bool on) = 0;

  /// Creates a joint that is not attached.
  virtual Joint createJoint(World, JointType) = 0;
  virtual void destroyJoint(Joint) = 0;
  /// Attaches the joint to two bodies; none is the static world. Throws Error for one body twice, and for a hinge2 with
  /// only one body.
  virtual void attach(Joint, Body a, Body b) = 0;
  /// The common point of both bodies [m]. Ignored before attach() and by joints without such a point.
  virtual void setAnchor(Joint, const Vec3& world) = 0;
  /// Sets axis 0, 1 or 2 to a world direction of any length above 0; throws Error for a shorter one. Ignored before
  /// attach(). Angular motor: the axis turns with `frame` 0 the world, 1 the first body, 2 the second body.
  virtual void setAxis(Joint, int axis, const Vec3& world, int frame = 0) = 0;
  /// Sets number of axes (0 to 3; throws Error for others) and mode of an angular motor. `euler`: three Euler angles,
  /// computed by the engine.
  virtual void setAngularMotor(Joint, int axes, bool euler) = 0;
  /// Sets the angle [rad] about an axis of an angular motor that is not in Euler mode.
  virtual void setMotorAngle(Joint, int axis, double angle) = 0;
  /// Makes a fixed joint hold the current relative pose of its bodies.
  virtual void setFixed(Joint) = 0;
  virtual Vec3 anchor(Joint) const = 0;          ///< m; zero for joints without one
  virtual Vec3 axis(Joint, int axis) const = 0;  ///< unit vector; zero when the joint has no such axis
  /// Ignored for parameters and axes that the joint does not have.
  virtual void setParameter(Joint, JointParameter, int axis, double v) = 0;
  /// 0 for parameters and axes that the joint does not have.
  virtual double parameter(Joint, JointParameter, int axis) const = 0;
  /// Sets JointParameter::velocity; a speed other than 0 wakes the first body of attach().
  virtual void drive(Joint, int axis, double speed) = 0;
  /// True when the axis is at one of its stops or beyond.
  virtual bool atStop(Joint, int axis) const = 0;
  virtual double angle(Joint, int axis) const = 0;      ///< first body relative to the second [rad; slider: m]
  virtual double angleRate(Joint, int axis) const = 0;  ///< its rate [rad/s; slider: m/s]
  virtual void setFeedback(Joint, bool on) = 0;         ///< true: step() measures forces and torques of the joint
  /// Force [N] and torque [Nm] on the first and the second body in the last step; zero without feedback.
  virtual void feedback(Joint, Vec3& force1, Vec3& torque1, Vec3& force2, Vec3& torque2) const = 0;

  /// Appends contacts to `out`, in a fixed order: at most `perPair` points for each pair of geoms. Skips pairs whose
  /// bodies a joint connects and pairs that the filter rejects.
  virtual void detect(World, PairFilter, int perPair, Contacts& out) = 0;
  /// Advances the world by `dt` [s]: solves all joints and the contacts with `solve`, integrates, clears forces, writes
  /// the requested feedback.
  virtual void step(World, Contacts&, double dt) = 0;
  /// The bodies whose state was not finite, or out of range, after the last step. The engine has reset them to their
  /// last valid pose, at rest. Valid until the next step.
  virtual std::span<const Body> repaired(World) const = 0;
};

}  // namespace spark::engine
