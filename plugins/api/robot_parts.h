#pragma once
/// \file
/// What rules ask of a robot's parts: boxes that may run into each other, effectors that can be frozen.

#include <string>
#include <vector>

#include "api/math.h"
#include "spark/abi/api/robot_parts.h"
#include "spark/node.h"

namespace spark {

/// A box of a robot, as the rule of self-collisions sees it. Offered by BoxCollider.
class IRobotBox {
 public:
  SPARK_INTERFACE(IRobotBox, 1);
  virtual ~IRobotBox() = default;
  virtual Leaf& leaf() = 0;
  /// Of its centre in the world, now.
  virtual Pose pose() const = 0;
  /// Full edges [m].
  virtual Vec3 boxLengths() const = 0;
  /// The scene told it never to collide with colliders of that name.
  virtual bool ignores(const std::string& collider) const = 0;
  /// Names of the effectors to be frozen when it runs into another box of its robot.
  virtual const std::vector<std::string>& freezeJointEffectors() const = 0;
};

/// An effector that a rule can freeze: while it is frozen, a command sets speed 0. What was commanded before goes on
/// until then. Offered by HingeEffector.
class IFreezable {
 public:
  SPARK_INTERFACE(IFreezable, 1);
  virtual ~IFreezable() = default;
  virtual Leaf& leaf() = 0;
  virtual void freeze(bool on) = 0;
};

}  // namespace spark
