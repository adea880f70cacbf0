#pragma once

#include <vector>

#include "api/agents.h"
#include "api/local_frame.h"
#include "api/physics.h"
#include "api/placed_body.h"

namespace spark {

/// `(ACC (n torso) (a 0.00 0.00 9.81))`: proper acceleration as a real accelerometer measures it at its own place, in
/// the frame of its transform [m/s^2]: (0 0 9.81) upright at rest, 0 in free fall. Beside the centre of mass of a body
/// that rotates it senses the centripetal and the tangential acceleration, too. Without a body above it is at rest.
///
/// It samples in the prepare phase, before the step, from the velocities after the two previous steps: its percept is
/// one cycle older than the rest of the message. The robots of the installed base were tuned with this delay.
///
/// Velocities that are set, by a beam or a reset, are no acceleration. Only with exactReplay they are, as in the
/// installed base.
class Accelerometer : public Perceptor {
  SPARK_CLASS(Accelerometer, Perceptor)
 public:
  static void describe(Description<Accelerometer>& d) {
    using A = Accelerometer;
    d.doc("Senses the specific force at its transform, in that transform's frame: (ACC (n name) (a x y z)) in m/s^2.");
    d.property("gravity", &A::gravity, &A::setGravity)
        .unit("m/s^2")
        .doc("Gravitational acceleration that it assumes, 3 numbers, world frame; empty: that of its world.");
    d.property("lastVelocity", &A::lastVelocity, &A::setLastVelocity)
        .unit("m/s")
        .state()
        .doc("The body's velocity at the last sample, world frame, with what was set since.");
    d.property("acceleration", &A::acceleration_).unit("m/s^2").state().doc("The last sample, in its own frame.");
    d.link(&A::body_, BodyAround());
    d.link(&A::placed_, Above<Transform>().where<hasBody>("Transform with a body").template child<IPlacedBody>());
    d.link(&A::physics_, At<IPhysicsServer>());
    d.on<&A::prepare>(phase::kPrepare);
  }
  void sense(Predicates& out, const Event&) override {
    if (!body_ && !isFixed()) return;
    out.open("ACC").pair("n", messageName()).open("a");
    for (const float a : acceleration_) out.add(a);
    out.close().close();
  }

 protected:
  // One at its body's centre has no more state than its properties.
  void saveState(StateWriter& out) const override {
    if (!isBeside()) return;
    const Vec3 last = lastRotation();
    for (int i = 0; i < 3; ++i) out.write(last[i]);
  }
  void loadState(StateReader& in) override {
    if (!isBeside()) return;
    for (int i = 0; i < 3; ++i) lastRotation_[i] = in.readNumber();
    seen_.angular = jumps().angular;
  }

 private:
  void prepare(const Event& event) {
    const IRigidBody* const body = body_.get();
    if (event.step <= 0) return;
    if (isFixed()) acceleration_ = intoFrame(transform()->world(), -assumedGravity());
    if (!body) return;
    const engine::BodyState now = body->state();
    const Vec3f velocity = now.linearVelocity.cast<float>();
    Vec3f proper = (velocity - lastVelocity()) / static_cast<float>(event.step) - assumedGravity();
    if (isBeside()) proper += aroundCenter(now, event.step).cast<float>();
    acceleration_ = intoFrame(transform()->world(), proper);
    lastVelocity_ = velocity;
    lastRotation_ = now.angularVelocity;
    seen_ = jumps();
  }
  /// True for a sensor in a world without a body above it.
  bool isFixed() const { return !body_ && transform() && physics_ && physics_->hasWorld(); }
  /// True for a sensor in a transform of its own, beside that of the body.
  bool isBeside() const {
    const IRigidBody* const body = body_.get();
    return body && transform() != body->bodyTransform();
  }
  /// The acceleration of its place relative to the body's centre [m/s^2].
  Vec3 aroundCenter(const engine::BodyState& now, double step) const {
    Matrix place = transform()->local();
    const Transform* const of = body_.get()->bodyTransform();
    for (const Transform* up = transform()->transform(); up && up != of; up = up->transform())
      place = up->local() * place;
    const Vec3 arm = now.rotation * positionOf(place).cast<double>(), &w = now.angularVelocity;
    return ((w - lastRotation()) / step).cross(arm) + w.cross(w.cross(arm));
  }
  IPlacedBody::Jumps jumps() const {
    const IPlacedBody* const placed = placed_.get();
    return placed && !placed->exactReplay() ? placed->jumps() : IPlacedBody::Jumps();
  }
  /// The velocities of the last sample, with what was set since.
  Vec3f lastVelocity() const {
    const Vec3 set = jumps().linear - seen_.linear;
    return set.isZero(0) ? lastVelocity_ : Vec3f(lastVelocity_ + set.cast<float>());
  }
  Vec3 lastRotation() const { return lastRotation_ + (jumps().angular - seen_.angular); }
  void setLastVelocity(const Vec3f& v) {
    lastVelocity_ = v;
    seen_.linear = jumps().linear;
  }
  Vec3f assumedGravity() const {
    if (!gravity_.empty()) return Vec3(gravity_[0], gravity_[1], gravity_[2]).cast<float>();
    const IPlacedBody* const placed = placed_.get();
    if (placed) return placed->worldGravity().cast<float>();
    const bool hasWorld = physics_ && physics_->hasWorld();
    return (hasWorld ? physics_->model().parameters.gravity : engine::WorldParameters().gravity).cast<float>();
  }
  std::vector<double> gravity() const { return gravity_; }
  void setGravity(const std::vector<double>& g) {
    if (!g.empty() && g.size() != 3)
      throw RefusedValue(
          fmt::format("expected 3 numbers [m/s^2], or none for the world's gravity, found {}", g.size()));
    for (const double v : g)
      if (!std::isfinite(v)) throw RefusedValue(fmt::format("expected finite numbers [m/s^2], found {}", v));
    gravity_ = g;
  }

  Link<IRigidBody> body_;
  Link<IPhysicsServer> physics_;
  Link<IPlacedBody> placed_;     ///< the same body
  std::vector<double> gravity_;  ///< empty: the world's
  Vec3f lastVelocity_ = Vec3f::Zero(), acceleration_ = Vec3f::Zero();
  Vec3 lastRotation_ = Vec3::Zero();  ///< the body's angular velocity at the last sample, world frame [rad/s]
  IPlacedBody::Jumps seen_;           ///< jumps() at the last sample
};

}  // namespace spark
