#pragma once
/// \file
/// What is heard in a cone, for sensors with a beam that has a width.

#include <vector>

#include "api/math.h"
#include "spark/abi/api/sound_cone.h"
#include "spark/interface.h"

namespace spark {

class ICollider;
class Node;

/// A cone in the world frame.
struct SoundCone {
  Vec3 apex;             ///< m
  Vec3 axis;             ///< length 1
  double halfAngle = 0;  ///< between the axis and the side, 0 to pi [rad]
  double range = 0;      ///< from the apex [m]
};

/// A collider, and the distance to the nearest point of it that is in the cone and not hidden [m].
struct Echo {
  ICollider* collider = nullptr;
  double distance = 0;
};

/// Hears in cones. Offered by the physics server.
class IHearing {
 public:
  SPARK_INTERFACE(IHearing, 1);
  virtual ~IHearing() = default;
  /// Appends the colliders that are heard in a cone, each once. The distance is exact, however thin a collider is: to
  /// the nearest point of its surface in the cone; 0 where it contains the apex. A collider whose nearest point is
  /// hidden by another one is looked for with `rings` rings of rays in the cone (ring k has 6 k rays), and with rays to
  /// points spread over it. `except` as of castRay(). Several threads may call it at once in the sense phase.
  virtual void listen(const SoundCone& cone, int rings, const Node* except, std::vector<Echo>& out) = 0;
};

}  // namespace spark
