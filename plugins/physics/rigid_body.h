#pragma once
/// \file
/// Bodies.

#include "mass.h"
#include "world.h"

namespace spark {

/// Base of what moves.
class Body : public PhysicsObject {
  SPARK_CLASS(Body, PhysicsObject)
 public:
  static void describe(Description<Body>& d) {
    d.doc("Base of what moves.");
    d.abstract();
  }
};

/// A rigid body. Takes its pose from the nearest transform when it is linked; after each step the transform takes its
/// pose.
class RigidBody : public Body, public IRigidBody, public IFollowsTransform {
  SPARK_CLASS(RigidBody, Body)
 public:
  static void describe(Description<RigidBody>& d);

  Leaf& leaf() override { return *this; }
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

  engine::Body handle() const { return body_; }
  /// The world it is in; empty before it is linked.
  const std::shared_ptr<physics::WorldHandle>& world() const { return world_; }
  const engine::Mass& massDistribution() const { return mass_; }

  /// For the physics server's place: true when its transform must be written (it is awake, or was changed in its
  /// sleep).
  bool takeUnplaced();
  /// Where it stands now.
  Matrix pose() const;
  /// How far the centre of mass moved since the last call: colliders and transforms around it move by it in its frame.
  Vec3 takeShift();
  /// Counts a repair by the engine; true for the 1st, 2nd, 4th ... of this body.
  bool countFault();

 protected:
  void onLink() override;
  void onUnlink() override;
  void saveState(StateWriter& out) const override;
  void loadState(StateReader& in) override;

 private:
  engine::IEngine* engine() const { return world_ ? world_->engine() : nullptr; }
  void wake();
  void applyMass(const engine::Mass& mass);
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
  void addBox(double density, const Vec3& e, std::vector<double> at) {
    add(physics::boxMass(density * physics::boxVolume(e), e), at);
  }
  void addBoxTotal(double m, const Vec3& e, std::vector<double> at) { add(physics::boxMass(m, e), at); }
  void addSphere(double density, double r, std::vector<double> at) {
    add(physics::sphereMass(density * physics::sphereVolume(r), r), at);
  }
  void addSphereTotal(double m, double r, std::vector<double> at) { add(physics::sphereMass(m, r), at); }
  void addCapsule(double density, double r, double l, std::vector<double> at) {
    add(physics::capsuleMass(density * physics::capsuleVolume(r, l), r, l), at);
  }
  void addCapsuleTotal(double m, double r, double l) { add(physics::capsuleMass(m, r, l), {}); }
  void addCylinder(double density, double r, double l, std::vector<double> at) {
    add(physics::cylinderMass(density * physics::cylinderVolume(r, l), r, l), at);
  }
  void addCylinderTotal(double m, double r, double l, std::vector<double> at) {
    add(physics::cylinderMass(m, r, l), at);
  }
  void setMass(double m);
  void setMassParameters(double m, const Vec3& center, const Vec3& diagonal, const Vec3& products);
  void translateMass(const Vec3&) {}

  Vec3 position() const { return state().position; }
  Vec3 velocity() const { return state().linearVelocity; }
  Vec3 angularVelocity() const { return state().angularVelocity; }
  void disable();
  bool usesGravity() const { return gravity_; }
  void useGravity(bool on);
  void addForceBy(const Vec3& f) { addForce(f); }

  std::shared_ptr<physics::WorldHandle> world_;
  engine::Body body_ = engine::Body::none;
  engine::Mass mass_;
  Ref<World> worldNode_;
  Vec3 shift_ = Vec3::Zero();         ///< where the first origin is in the body's frame
  Vec3 pendingShift_ = Vec3::Zero();  ///< the part of it that the surroundings do not know yet
  bool gravity_ = true, placed_ = false;
  unsigned faults_ = 0;
};

}  // namespace spark
