#pragma once
/// \file
/// Groups of colliders that can be detached from all others.

#include "world.h"

namespace spark {

/// Makes a group of all colliders below its parent. While the group is detached, its bodies collide only with each
/// other and with static colliders: robots that are created at the same spot do not burst apart.
class CollisionGroup : public PhysicsObject {
  SPARK_CLASS(CollisionGroup, PhysicsObject)
 public:
  static void describe(Description<CollisionGroup>& d) {
    d.doc("Makes a group of all colliders below its parent.");
    d.property("detached", &CollisionGroup::detached_)
        .state()
        .doc("The bodies of the group collide only with each other and with static colliders.");
  }
  bool detached() const { return detached_; }

 private:
  bool detached_ = false;
};

}  // namespace spark
