#pragma once

#include "api/agents.h"
#include "api/local_frame.h"
#include "api/physics.h"

namespace spark {

/// `(ACC (n torso) (a 0.00 0.00 9.81))`: proper acceleration as a real accelerometer measures it, in the frame of its
/// body [m/s^2]: (0 0 9.81) upright at rest, 0 in free fall.
///
/// It samples in the prepare phase, before the step, from the velocities after the two previous steps: its percept is
/// one cycle older than the rest of the message. The robots of the installed base were tuned with this delay.
class Accelerometer : public Perceptor {
  SPARK_CLASS(Accelerometer, Perceptor)
 public:
  static void describe(Description<Accelerometer>& d) {
    d.doc("Senses the specific force on its transform's body, in the body's frame: (ACC (n name) (a x y z)) in m/s^2.");
    d.property("gravity", &Accelerometer::gravity_).unit("m/s^2").doc("Gravitational acceleration that it assumes.");
    d.property("lastVelocity", &Accelerometer::lastVelocity_)
        .unit("m/s")
        .state()
        .doc("The body's velocity at the last sample, world frame.");
    d.property("acceleration", &Accelerometer::acceleration_).unit("m/s^2").state().doc("The last sample, body frame.");
    d.link(&Accelerometer::body_, BodyAround());
    d.on<&Accelerometer::prepare>(phase::kPrepare);
  }
  void sense(Predicates& out, const Event&) override {
    if (!body_) return;
    out.open("ACC").pair("n", messageName()).open("a");
    for (const float a : acceleration_) out.add(a);
    out.close().close();
  }

 private:
  void prepare(const Event& event) {
    const IRigidBody* const body = body_.get();
    if (!body || event.step <= 0) return;
    const Vec3f velocity = body->state().linearVelocity.cast<float>();
    const Vec3f proper = (velocity - lastVelocity_) / static_cast<float>(event.step) - gravity_;
    acceleration_ = intoFrame(transform()->world(), proper);
    lastVelocity_ = velocity;
  }
  Link<IRigidBody> body_;
  Vec3f gravity_{0, 0, -9.81f};
  Vec3f lastVelocity_ = Vec3f::Zero(), acceleration_ = Vec3f::Zero();
};

}  // namespace spark
