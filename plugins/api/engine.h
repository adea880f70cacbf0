#pragma once
/// \file
/// The one interface between `physics` and an engine. Opaque typed handles; contacts as plain data; one call steps a
/// world, so that an engine may solve whole islands itself. Double precision, SI, radians. An engine is used by one
/// thread at a time.

#include <span>
#include <vector>

#include "api/math.h"
#include "spark/abi/api/engine.h"
#include "spark/node.h"

namespace spark::engine {

enum class World : std::uintptr_t { none = 0 };
enum class Space : std::uintptr_t { none = 0 };
enum class Body : std::uintptr_t { none = 0 };
enum class Geom : std::uintptr_t { none = 0 };
enum class Joint : std::uintptr_t { none = 0 };

struct WorldParameters {
  Vec3 gravity{0, 0, -9.81};  ///< m/s^2
  double erp = 0.2, cfm = 1e-5;
  bool autoDisable = true;
  double contactSurfaceLayer = 0.001;  ///< m
};

struct Mass {
  double mass = 1;                  ///< kg
  Vec3 center = Vec3::Zero();       ///< m, body frame
  Mat3 inertia = Mat3::Identity();  ///< kg m^2, about the body's origin
};

enum class Shape { box, sphere, capsule, cylinder, plane, ray, mesh };
/// A collision shape in its own frame; axis of capsule and cylinder is z.
struct ShapeDescription {
  Shape shape = Shape::box;
  Vec3 lengths{1, 1, 1};           ///< box: full edges [m]
  double radius = 1, length = 1;   ///< sphere, capsule (without caps), cylinder, ray length [m]
  double plane[4] = {0, 0, 1, 0};  ///< a b c d, normal of length 1: ax + by + cz = d, in the world
  Vec3 rayOrigin = Vec3::Zero(), rayDirection{0, 0, 1};
  std::vector<double> vertices;          ///< mesh: x y z each
  std::vector<std::uint32_t> triangles;  ///< mesh: three indices each
};

enum class JointType { ball, hinge, hinge2, slider, universal, fixed, angularMotor };
enum class JointParameter {
  lowStop,
  highStop,
  velocity,
  maxForce,
  fudgeFactor,
  bounce,
  cfm,
  stopErp,
  stopCfm,
  suspensionErp,
  suspensionCfm
};

/// Contact surface after combination (scene-language section 3.3). A flag says that the value counts.
struct Surface {
  bool bounceOn = false, softErpOn = false, softCfmOn = false, slipOn = false;
  bool pyramid =
      false;  ///< mu is a coefficient: friction is bounded by mu times the normal force that acts without friction
  double mu = HUGE_VAL;  ///< bound of friction along each tangent [N], or its coefficient; infinite by default
  double bounce = 0, bounceVelocity = 0;  ///< restitution 0..1; least speed [m/s]
  double softErp = 0, softCfm = 0, slip1 = 0, slip2 = 0;
};

/// One contact point, made by detect(), completed by collision handlers, consumed by step().
struct Contact {
  Geom geomA = Geom::none, geomB = Geom::none;  ///< as reported (outermost of a transform geom)
  void* ownerA = nullptr;                       ///< what createGeom was given
  void* ownerB = nullptr;
  Vec3 position, normal;  ///< world; the normal points into A
  double depth = 0;       ///< m
  bool solve = false;     ///< a handler wants a contact joint
  bool feedback = false;  ///< a handler wants the force
  Surface surface;
  Vec3 forceOnA = Vec3::Zero();  ///< N, world: set by step() when feedback
};

/// The contacts of one step, grouped by geom pair in detection order. Reused: capacity stays.
using Contacts = std::vector<Contact>;

/// Says whether a pair may collide at all; gets the owners. Plain function: called for every close pair.
using PairFilter = bool (*)(void* ownerA, void* ownerB);

/// Motion of a body.
struct BodyState {
  Vec3 position, linearVelocity, angularVelocity;
  Mat3 rotation;
};

class IEngine {
 public:
  SPARK_INTERFACE(IEngine, 1);
  virtual ~IEngine() = default;

  virtual World createWorld() = 0;
  virtual void destroyWorld(World) = 0;
  virtual void setWorldParameters(World, const WorldParameters&) = 0;

  /// `parent` none: a top-level space of the world.
  virtual Space createSpace(World, Space parent) = 0;
  virtual void destroySpace(Space) = 0;
  /// False: geoms directly in this space never collide with each other.
  virtual void setInnerCollision(Space, bool on) = 0;

  virtual Body createBody(World) = 0;
  virtual void destroyBody(Body) = 0;
  virtual void setMass(Body, const Mass&) = 0;
  virtual BodyState state(Body) const = 0;
  /// For many, without a call per body: 1 for each that is awake, else 0; and where those stand, as state() says. `out`
  /// of others stays as it is.
  virtual void posesOfAwake(std::span<const Body>, std::span<std::uint8_t> awake, std::span<Matrix> out) const = 0;
  virtual void setPosition(Body, const Vec3&) = 0;
  virtual void setRotation(Body, const Mat3&) = 0;
  virtual void setLinearVelocity(Body, const Vec3&) = 0;
  virtual void setAngularVelocity(Body, const Vec3&) = 0;
  virtual void addForce(Body, const Vec3&) = 0;   ///< world frame, at the centre of mass, for the next step
  virtual void addTorque(Body, const Vec3&) = 0;  ///< world frame
  /// Adds the force -linear v and the torque -angular w of its speeds [N s/m, N m s]; nothing while it sleeps.
  virtual void addDrag(Body, double linear, double angular) = 0;
  virtual Vec3 force(Body) const = 0;  ///< accumulated so far
  virtual Vec3 torque(Body) const = 0;
  virtual void setForce(Body, const Vec3&) = 0;
  virtual void setTorque(Body, const Vec3&) = 0;
  virtual void setEnabled(Body, bool) = 0;
  virtual bool enabled(Body) const = 0;
  virtual void setGravityMode(Body, bool) = 0;
  /// What auto-disable remembers; part of saved state. Raw numbers, engine-defined, fixed length.
  virtual void saveBody(Body, std::vector<double>& out) const = 0;
  virtual void loadBody(Body, std::span<const double> in) = 0;

  /// `owner` comes back in contacts. Throws Error for shapes or pairs it cannot do.
  virtual Geom createGeom(Space, const ShapeDescription&, void* owner) = 0;
  virtual void destroyGeom(Geom) = 0;
  virtual void setShape(Geom, const ShapeDescription&) = 0;
  /// Attaches to a body, at an offset in the body's frame; none: static.
  virtual void setBody(Geom, Body, const Pose& offset) = 0;
  /// World pose of a static geom; ignored for planes.
  virtual void setPose(Geom, const Pose&) = 0;
  virtual Pose pose(Geom) const = 0;
  virtual void setCollides(Geom, bool on) = 0;

  virtual Joint createJoint(World, JointType) = 0;
  virtual void destroyJoint(Joint) = 0;
  /// none means the static world.
  virtual void attach(Joint, Body a, Body b) = 0;
  virtual void setAnchor(Joint, const Vec3& world) = 0;
  /// axis 0 (1, 2): world direction. Angular motor: `frame` 0 world, 1 first body, 2 second body.
  virtual void setAxis(Joint, int axis, const Vec3& world, int frame = 0) = 0;
  virtual void setAngularMotor(Joint, int axes, bool euler) = 0;
  virtual void setMotorAngle(Joint, int axis, double angle) = 0;
  virtual void setFixed(Joint) = 0;
  virtual Vec3 anchor(Joint) const = 0;
  virtual Vec3 axis(Joint, int axis) const = 0;
  virtual void setParameter(Joint, JointParameter, int axis, double v) = 0;
  virtual double parameter(Joint, JointParameter, int axis) const = 0;
  /// Sets JointParameter::velocity; the first body that attach() was given wakes when the speed is not 0.
  virtual void drive(Joint, int axis, double speed) = 0;
  /// The axis is at one of its stops or beyond.
  virtual bool atStop(Joint, int axis) const = 0;
  virtual double angle(Joint, int axis) const = 0;      ///< rad; slider: m
  virtual double angleRate(Joint, int axis) const = 0;  ///< rad/s; slider: m/s
  virtual void setFeedback(Joint, bool on) = 0;
  /// Force [N] and torque [Nm] on the first and second body in the last step; zero without feedback.
  virtual void feedback(Joint, Vec3& force1, Vec3& torque1, Vec3& force2, Vec3& torque2) const = 0;

  /// Finds contacts: at most `perPair` points a pair, no pair connected by a joint, none the filter refuses. Appends in
  /// a fixed order.
  virtual void detect(World, PairFilter, int perPair, Contacts& out) = 0;
  /// Solves the contacts that say `solve` and all joints, integrates by `dt` [s], clears forces, writes wanted
  /// feedback.
  virtual void step(World, Contacts&, double dt) = 0;
  /// Bodies whose state was not finite (or beyond all reason) after the last step: they were put back to their last
  /// good pose, at rest. Valid until the next step.
  virtual std::span<const Body> repaired(World) const = 0;
};

}  // namespace spark::engine
