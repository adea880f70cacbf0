#pragma once

#include "api/cached_lookup.h"
#include "api/first_below.h"
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
  }
  void onCollision(const Collision& collision) override {
    ContactJointHandler::onCollision(collision);
    if (collision.direct && perceptor()) collision.contact.feedback = true;
  }
  void onSolved(const Collision& collision) override {
    if (collision.direct && collision.contact.solve && perceptor())
      perceptor()->touch(collision.contact.position, collision.contact.forceOnA);
  }

 private:
  ForceResistancePerceptor* perceptor() {
    return perceptor_.get(
        kernel(), [this] { return transform() ? firstBelow<ForceResistancePerceptor>(*transform()) : nullptr; });
  }
  CachedLookup<ForceResistancePerceptor> perceptor_;
};

}  // namespace spark
