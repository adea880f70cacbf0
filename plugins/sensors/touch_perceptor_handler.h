#pragma once

#include "force_resistance_perceptor.h"

namespace spark {

/// A contact joint handler that also measures: the force of each contact goes to the first force resistance perceptor
/// below its transform. It feels only contacts in which its collider comes first, as in the installed base (a foot on
/// the ground does).
class TouchPerceptorHandler : public ContactJointHandler {
  SPARK_CLASS(TouchPerceptorHandler, ContactJointHandler)
 public:
  static void describe(Description<TouchPerceptorHandler>& d) {
    d.doc(
        "Makes contacts solid and feeds their forces to the first ForceResistancePerceptor below its nearest "
        "transform.");
    d.link(&TouchPerceptorHandler::perceptor_, Above<Transform>().below<ForceResistancePerceptor>());
  }
  void onCollision(const Collision& collision) override {
    ContactJointHandler::onCollision(collision);
    if (collision.direct && perceptor_) collision.contact.feedback = true;
  }
  void onSolved(const Collision& collision) override {
    if (collision.direct && collision.contact.solve && perceptor_)
      perceptor_->touch(collision.contact.position, collision.contact.forceOnA);
  }

 private:
  Link<ForceResistancePerceptor> perceptor_;
};

}  // namespace spark
