#pragma once
/// \file
/// Colliders that belong together.

#include "world.h"

namespace spark {

/// Makes one group of the colliders below the node it stands in. While the group is detached what moves in it touches
/// only itself and what does not move: robots that are created at one spot do not burst apart.
class CollisionGroup : public PhysicsObject {
  SPARK_CLASS(CollisionGroup, PhysicsObject)
 public:
  static void describe(Description<CollisionGroup>& d) {
    d.doc("Makes one group of the colliders below the node it stands in.");
    d.property("detached", &CollisionGroup::detached_)
        .state()
        .doc("What moves in the group touches only itself and what does not move.");
  }
  bool detached() const { return detached_; }

 private:
  bool detached_ = false;
};

}  // namespace spark
