#pragma once
/// \file
/// Body controllers, which act on a body before each step, and the battery of motors.

#include <algorithm>

#include "world.h"

namespace spark {

/// Linear drag: force -k v and torque -k w.
class DragController : public BodyController {
  SPARK_CLASS(DragController, BodyController)
 public:
  static void describe(Description<DragController>& d) {
    d.doc("Slows the body above it in proportion to its velocity.");
    d.property("linearDrag", &DragController::linear_).unit("N s/m").min(0).state().doc("Force per velocity.");
    d.property("angularDrag", &DragController::angular_)
        .unit("N m s")
        .min(0)
        .state()
        .doc("Torque per angular velocity.");
  }
  void control(IRigidBody& body, const Event&) override { body.addDrag(linear_, angular_); }

 private:
  double linear_ = 0.1, angular_ = 0.1;
};

/// Limits the speed of its body.
class VelocityController : public BodyController {
  SPARK_CLASS(VelocityController, BodyController)
 public:
  static void describe(Description<VelocityController>& d) {
    d.doc("Limits the speed of the body above it.");
    d.property("maxVelocity", &VelocityController::max_).unit("m/s").state().doc("Maximum speed; 0 or less: no limit.");
  }
  void control(IRigidBody& body, const Event&) override {
    if (max_ <= 0 || !body.enabled()) return;
    const Vec3 v = body.state().linearVelocity;
    const double speed = v.norm();
    if (speed > max_) body.setVelocity(v * (max_ / speed));
  }

 private:
  double max_ = 0;
};

/// First-person control of its body: two angles set the view, forces push it forward, sideways and up.
class FPSController : public BodyController {
  SPARK_CLASS(FPSController, BodyController)
 public:
  static void describe(Description<FPSController>& d) {
    using C = FPSController;
    d.doc("First-person control of the body above it.");
    d.property("acceleration", &C::acceleration_).unit("N").state().doc("Force of a full push.");
    d.property("HAngle", &C::horizontal_).unit("deg").state().doc("Direction of view about z; 0 is along y.");
    d.property("VAngle", &C::vertical_).unit("deg").range(-90, 90).state().doc("Elevation of view; negative is down.");
    d.property("forward", &C::forward_).range(-1, 1).state().doc("Push along the view, -1..1.");
    d.property("sideward", &C::sideward_).range(-1, 1).state().doc("Push to the right, -1..1.");
    d.property("upward", &C::upward_).range(-1, 1).state().doc("Push up, -1..1.");
  }
  void control(IRigidBody& body, const Event&) override {
    const Matrix turn = rotationDeg(0, 0, static_cast<float>(horizontal_)),
                 tilt = rotationDeg(static_cast<float>(vertical_), 0, 0);
    const Pose view = toPose(Matrix(turn * tilt));
    // Rotate the body only when an angle changed. The 1 marks that angles were applied.
    if (applied_ != Vec3(horizontal_, vertical_, 1)) body.setPose({body.state().position, view.rotation});
    applied_ = {horizontal_, vertical_, 1};
    const Vec3 push = view.rotation * Vec3(sideward_, forward_, 0) + Vec3(0, 0, upward_);
    body.addForce(push * acceleration_);
  }

 protected:
  void saveState(StateWriter& out) const override {
    for (int i = 0; i < 3; ++i) out.write(applied_[i]);
  }
  void loadState(StateReader& in) override {
    for (int i = 0; i < 3; ++i) applied_[i] = in.readNumber();
  }

 private:
  double acceleration_ = 30, horizontal_ = 0, vertical_ = 0, forward_ = 0, sideward_ = 0, upward_ = 0;
  Vec3 applied_ = Vec3::Zero();  ///< horizontal and vertical angle of the body [deg], and 1; 0 0 0 before the first
};

/// The battery of motors.
class Battery : public PhysicsObject, public IBattery {
  SPARK_CLASS(Battery, PhysicsObject)
 public:
  static void describe(Description<Battery>& d) {
    d.doc("A battery, for motors.");
    d.implements<IBattery>();
    d.property("capacity", &Battery::capacity_).unit("J").min(0).doc("Stored energy when full.");
    d.property("power", &Battery::power_).unit("J").min(0).state().doc("Stored energy.");
  }
  double power() const override { return power_; }
  double capacity() const override { return capacity_; }
  /// True when no energy is left.
  bool empty() const { return power_ <= 0; }
  /// Removes energy [J], down to 0.
  void drain(double energy) { power_ = std::max(0.0, power_ - energy); }

 private:
  double capacity_ = 0, power_ = 0;
};

}  // namespace spark
