#pragma once

#include "api/agents.h"
#include "api/local_frame.h"
#include "api/physics.h"

namespace spark {

/// `(GYR (n torso) (rt 0.01 0.00 -0.09))`: angular velocity of the body beside it, in the frame of its
/// transform [deg/s]; without a body it does not move.
class GyroRatePerceptor : public Perceptor {
  SPARK_CLASS(GyroRatePerceptor, Perceptor)
 public:
  static void describe(Description<GyroRatePerceptor>& d) {
    d.doc(
        "Senses the angular velocity of its transform's body, in the transform's frame: (GYR (n name) (rt x y z)) in "
        "deg/s.");
    d.link(&GyroRatePerceptor::body_, BodyAround());
    d.link(&GyroRatePerceptor::physics_, At<IPhysicsServer>());
  }

  void sense(Predicates& out, const Event&) override {
    const IRigidBody* const body = body_.get();
    if (!body && !(physics_ && physics_->hasWorld() && transform())) return;

    const Vec3f world = body ? Vec3f(body->state().angularVelocity.cast<float>()) : Vec3f(Vec3f::Zero());
    const Vec3f local = intoFrame(transform()->world(), world);

    out.open("GYR").pair("n", messageName()).open("rt");
    for (const float rate : local) out.add(radToDeg(rate));
    out.close().close();
  }

 private:
  Link<IRigidBody> body_;
  Link<IPhysicsServer> physics_;
};

}  // namespace spark
