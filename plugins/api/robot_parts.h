#pragma once
/// \file
/// Parts of a robot that the rules of a game use: boxes that may collide with each other, effectors that can be frozen.

#include <string>
#include <vector>

#include "api/math.h"
#include "spark/abi/api/robot_parts.h"
#include "spark/node.h"

namespace spark {

/// A box of a robot, for the rule about self-collisions. Offered by BoxCollider.
class IRobotBox {
 public:
  SPARK_INTERFACE(IRobotBox, 1);
  virtual ~IRobotBox() = default;
  /// The node that offers it.
  virtual Leaf& leaf() = 0;
  /// Current pose of the box centre, world frame.
  virtual Pose pose() const = 0;
  /// Full edge lengths [m].
  virtual Vec3 boxLengths() const = 0;
  /// True when the scene excludes collisions with colliders of that name.
  virtual bool ignores(const std::string& collider) const = 0;
  /// Names of the effectors to freeze when this box collides with another box of its robot.
  virtual const std::vector<std::string>& freezeJointEffectors() const = 0;
};

/// An effector that a rule can freeze. While it is frozen, the next command sets speed 0; until that command the joint
/// keeps its speed. Offered by HingeEffector.
class IFreezable {
 public:
  SPARK_INTERFACE(IFreezable, 1);
  virtual ~IFreezable() = default;
  /// The node that offers it.
  virtual Leaf& leaf() = 0;
  /// Freezes or releases the effector.
  virtual void freeze(bool on) = 0;
};

}  // namespace spark
