#pragma once
/// \file
/// What acts on a body before each step, and a store of energy.

#include <algorithm>

#include "world.h"

namespace spark {

/// Slows its body: force -k v, torque -k w.
class DragController : public BodyController {
  SPARK_CLASS(DragController, BodyController)
 public:
  static void describe(Description<DragController>& d) {
    d.doc("Slows the body above it in proportion to its speed.");
    d.property("linearDrag", &DragController::linear_).unit("N s/m").min(0).state().doc("Force per speed.");
    d.property("angularDrag", &DragController::angular_).unit("N m s").min(0).state().doc("Torque per angular speed.");
  }
  void control(IRigidBody& body, const Event&) override { body.addDrag(linear_, angular_); }

 private:
  double linear_ = 0.1, angular_ = 0.1;
};

/// Keeps its body from getting too fast.
class VelocityController : public BodyController {
  SPARK_CLASS(VelocityController, BodyController)
 public:
  static void describe(Description<VelocityController>& d) {
    d.doc("Keeps the body above it from getting too fast.");
    d.property("maxVelocity", &VelocityController::max_)
        .unit("m/s")
        .state()
        .doc("Greatest speed; 0 or less: no limit.");
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

/// Moves its body as a walker in the first person: looks by two angles, is pushed forwards, sidewards and up.
class FPSController : public BodyController {
  SPARK_CLASS(FPSController, BodyController)
 public:
  static void describe(Description<FPSController>& d) {
    using C = FPSController;
    d.doc("Moves the body above it as a walker in the first person.");
    d.property("acceleration", &C::acceleration_).unit("N").state().doc("Force of each push.");
    d.property("HAngle", &C::horizontal_).unit("deg").state().doc("Where it looks: about z, 0 along y.");
    d.property("VAngle", &C::vertical_).unit("deg").range(-90, 90).state().doc("Where it looks: down is below 0.");
    d.property("forward", &C::forward_).range(-1, 1).state().doc("Push along the view, -1..1.");
    d.property("sideward", &C::sideward_).range(-1, 1).state().doc("Push to the right, -1..1.");
    d.property("upward", &C::upward_).range(-1, 1).state().doc("Push up, -1..1.");
  }
  void control(IRigidBody& body, const Event&) override {
    const Matrix turn = rotationDeg(0, 0, static_cast<float>(horizontal_)),
                 tilt = rotationDeg(static_cast<float>(vertical_), 0, 0);
    const Pose view = toPose(Matrix(turn * tilt));
    if (turned_ != Vec3(horizontal_, vertical_, 1)) body.setPose({body.state().position, view.rotation});
    turned_ = {horizontal_, vertical_, 1};
    const Vec3 push = view.rotation * Vec3(sideward_, forward_, 0) + Vec3(0, 0, upward_);
    body.addForce(push * acceleration_);
  }

 protected:
  void saveState(StateWriter& out) const override {
    for (int i = 0; i < 3; ++i) out.write(turned_[i]);
  }
  void loadState(StateReader& in) override {
    for (int i = 0; i < 3; ++i) turned_[i] = in.readNumber();
  }

 private:
  double acceleration_ = 30, horizontal_ = 0, vertical_ = 0, forward_ = 0, sideward_ = 0, upward_ = 0;
  Vec3 turned_ = Vec3::Zero();  ///< the angles that the body has
};

/// A store of energy, for motors.
class Battery : public PhysicsObject, public IBattery {
  SPARK_CLASS(Battery, PhysicsObject)
 public:
  static void describe(Description<Battery>& d) {
    d.doc("A store of energy, for motors.");
    d.implements<IBattery>();
    d.property("capacity", &Battery::capacity_).unit("J").min(0).doc("What it holds when full.");
    d.property("power", &Battery::power_).unit("J").min(0).state().doc("What it holds now.");
  }
  double power() const override { return power_; }
  double capacity() const override { return capacity_; }
  bool empty() const { return power_ <= 0; }
  /// Takes energy [J], as far as it goes.
  void drain(double energy) { power_ = std::max(0.0, power_ - energy); }

 private:
  double capacity_ = 0, power_ = 0;
};

}  // namespace spark
