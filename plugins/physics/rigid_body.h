#pragma once
/// \file
/// Rigid bodies.

#include "api/mass.h"
#include "api/placed_body.h"
#include "api/scene_calls.h"
#include "world.h"

namespace spark {

/// Base of bodies.
class Body : public PhysicsObject {
  SPARK_CLASS(Body, PhysicsObject)
 public:
  static void describe(Description<Body>& d) {
    d.doc("Base of bodies.");
    d.abstract();
  }
};

/// A rigid body. It takes its pose from the nearest transform when it is linked; after each step that transform takes
/// the pose of the body.
class RigidBody : public Body, public IRigidBody, public IPlacedBody, public IFollowsTransform, public ISceneCalls {
  SPARK_CLASS(RigidBody, Body)
 public:
  static void describe(Description<RigidBody>& d);

  Leaf& leaf() override { return *this; }
  std::uint64_t identity() const override;
  engine::BodyState state() const override;
  double mass() const override { return mass_.mass; }
  void setPose(const Pose& pose) override;
  void setPosition(const Vec3& position) override;
  void setVelocity(const Vec3& v) override;
  void setAngularVelocity(const Vec3& w) override;
  void addForce(const Vec3& f) override;
  void addTorque(const Vec3& t) override;
  void addDrag(double linear, double angular) override;
  bool enabled() const override;
  void enable() override;
  Transform* bodyTransform() const override { return transform(); }
  void follow(const Matrix& world) override;
  /// Follows a transform that was moved by hand now, not before the next step: for what is set relative to the body's
  /// place.
  void catchUp();
  const Jumps& jumps() const override { return jumps_; }
  Vec3 worldGravity() const override;
  bool exactReplay() const override { return world_ && world_->model().exactReplay; }
  std::vector<SceneCall> sceneCalls() const override;
  std::vector<std::string_view> setByCalls() const override { return {"mass", "position"}; }

  /// The body in the model; none while the node is not linked.
  physics::BodyHandle handle() const { return body_; }
  /// The world of the body; empty while the node is not linked.
  const std::shared_ptr<physics::WorldModel>& world() const { return world_; }
  const engine::Mass& massDistribution() const { return mass_; }

  /// For the place phase: returns true when the transform must be written, because the body is awake or was moved while
  /// it slept, and clears that mark for a sleeping body.
  bool takeUnplaced();
  /// Returns and clears the offset by which colliders and transforms around the body must move, in its frame [m],
  /// because its origin moved to the centre of mass.
  Vec3 takeShift();
  /// Counts a reset after a fault. Returns true for the 1st, 2nd, 4th, 8th ... of this body, which are logged.
  bool countFault();

 protected:
  void onLink() override;
  void onUnlink() override;
  void saveState(StateWriter& out) const override;
  void loadState(StateReader& in) override;

 private:
  /// Wakes the body and marks its transform as out of date.
  void wake();
  /// Sets the mass. Throws Error, and keeps the old mass, when no body can have it.
  void applyMass(const engine::Mass& mass);
  /// Adds a mass at the pose given by `matrix` and moves the origin to the common centre of mass.
  void add(const engine::Mass& part, const std::vector<double>& matrix);

  void setBox(double density, const Vec3& e) { applyMass(physics::boxMass(density * physics::boxVolume(e), e)); }
  void setBoxTotal(double m, const Vec3& e) { applyMass(physics::boxMass(m, e)); }
  void setSphere(double density, double r) { applyMass(physics::sphereMass(density * physics::sphereVolume(r), r)); }
  void setSphereTotal(double m, double r) { applyMass(physics::sphereMass(m, r)); }
  void setCapsule(double density, double r, double l) {
    applyMass(physics::capsuleMass(density * physics::capsuleVolume(r, l), r, l));
  }
  void setCapsuleTotal(double m, double r, double l) { applyMass(physics::capsuleMass(m, r, l)); }
  void setCylinder(double density, double r, double l) {
    applyMass(physics::cylinderMass(density * physics::cylinderVolume(r, l), r, l));
  }
  void setCylinderTotal(double m, double r, double l) { applyMass(physics::cylinderMass(m, r, l)); }
  void addBox(double density, const Vec3& e, const std::vector<double>& at) {
    add(physics::boxMass(density * physics::boxVolume(e), e), at);
  }
  void addBoxTotal(double m, const Vec3& e, const std::vector<double>& at) { add(physics::boxMass(m, e), at); }
  void addSphere(double density, double r, const std::vector<double>& at) {
    add(physics::sphereMass(density * physics::sphereVolume(r), r), at);
  }
  void addSphereTotal(double m, double r, const std::vector<double>& at) { add(physics::sphereMass(m, r), at); }
  void addCapsule(double density, double r, double l, const std::vector<double>& at) {
    add(physics::capsuleMass(density * physics::capsuleVolume(r, l), r, l), at);
  }
  void addCapsuleTotal(double m, double r, double l) { add(physics::capsuleMass(m, r, l), {}); }
  void addCylinder(double density, double r, double l, const std::vector<double>& at) {
    add(physics::cylinderMass(density * physics::cylinderVolume(r, l), r, l), at);
  }
  void addCylinderTotal(double m, double r, double l, const std::vector<double>& at) {
    add(physics::cylinderMass(m, r, l), at);
  }
  void setMass(double m);
  void setMassParameters(double m, const Vec3& center, const Vec3& diagonal, const Vec3& products);
  double linearDamping() const { return linearDamping_; }
  double angularDamping() const { return angularDamping_; }
  void setLinearDamping(double v) { setDamping(v, angularDamping_); }
  void setAngularDamping(double v) { setDamping(linearDamping_, v); }
  void setDamping(double linear, double angular);
  void addPart(double mass, const Vec3& center, const Vec3& diagonal, const Vec3& products,
               const std::vector<double>& axes);
  void translateMass(const Vec3&) {}

  Vec3 position() const { return state().position; }
  Vec3 velocity() const { return state().linearVelocity; }
  Vec3 angularVelocity() const { return state().angularVelocity; }
  void disable();
  const Vec3& linkOrigin() const { return linkOrigin_; }
  bool connector() const { return connector_; }
  void setConnector(bool on);
  void setLinkOrigin(const Vec3& origin);
  bool usesGravity() const { return gravity_; }
  void useGravity(bool on);
  void setLocalPose(const Vec3& position, const std::vector<double>& rotation);
  void addForceBy(const Vec3& f) { addForce(f); }

  std::shared_ptr<physics::WorldModel> world_;
  physics::BodyHandle body_ = physics::BodyHandle::none;
  engine::Mass mass_;
  Ref<World> worldNode_;
  Vec3 shift_ = Vec3::Zero();         ///< position of the original origin in the body's frame [m]
  Vec3 pendingShift_ = Vec3::Zero();  ///< the part of it that takeShift() has not returned yet [m]
  bool connector_ = false;            ///< see Body::connector
  Vec3 linkOrigin_ = Vec3::Zero();    ///< see Body::linkOrigin
  std::vector<engine::Part> parts_;   ///< see Body::parts
  double linearDamping_ = 0, angularDamping_ = 0;
  bool gravity_ = true;
  bool placed_ = false;  ///< the body sleeps and its transform is up to date
  unsigned faults_ = 0;  ///< resets
  Jumps jumps_;          ///< see IPlacedBody::jumps()
};

}  // namespace spark
