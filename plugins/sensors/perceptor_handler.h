#pragma once

#include "collision_perceptor.h"

namespace spark {

/// Reports the contacts of the collider above it, direct and symmetric, to the first collision perceptor below its
/// transform.
class PerceptorHandler : public CollisionHandler {
  SPARK_CLASS(PerceptorHandler, CollisionHandler)
 public:
  static void describe(Description<PerceptorHandler>& d) {
    d.doc("Feeds the first CollisionPerceptor below its nearest transform.");
    d.link(&PerceptorHandler::perceptor_, Above<Transform>().below<CollisionPerceptor>());
  }
  void onCollision(const Collision& collision) override {
    if (CollisionPerceptor* perceptor = perceptor_.get()) perceptor->touched(collision.other.leaf());
  }

 private:
  Link<CollisionPerceptor> perceptor_;
};

}  // namespace spark
