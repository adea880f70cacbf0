#pragma once

#include "api/physics.h"

namespace spark {

/// Stands in the colliders of robots; the rules of touching and charging are to read it. Holds nothing by itself.
class AgentCollisionHandler : public CollisionHandler {
  SPARK_CLASS(AgentCollisionHandler, CollisionHandler)
 public:
  static void describe(Description<AgentCollisionHandler>& d) {
    d.doc("Marks the colliders of robots for the rules; contacts are not changed.");
  }
  void onCollision(const Collision&) override {}
};

}  // namespace spark
