#pragma once

#include "force_resistance_perceptor.h"

namespace spark {

/// Makes contacts solid, like ContactJointHandler, and passes their forces to the first force resistance perceptor
/// below its transform. As in the installed base it measures only contacts in which its collider comes first, such as
/// those of a foot with the ground.
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
