#pragma once

#include "api/cached_lookup.h"
#include "api/first_below.h"
#include "collision_perceptor.h"

namespace spark {

/// Tells the first collision perceptor below its transform what touched the collider above it, in either role.
class PerceptorHandler : public CollisionHandler {
  SPARK_CLASS(PerceptorHandler, CollisionHandler)
 public:
  static void describe(Description<PerceptorHandler>& d) {
    d.doc("Feeds the first CollisionPerceptor below its nearest transform.");
  }
  void onCollision(const Collision& collision) override {
    auto* perceptor = perceptor_.get(
        kernel(), [this] { return transform() ? firstBelow<CollisionPerceptor>(*transform()) : nullptr; });
    if (perceptor) perceptor->touched(collision.other.leaf());
  }

 private:
  CachedLookup<CollisionPerceptor> perceptor_;
};

}  // namespace spark
