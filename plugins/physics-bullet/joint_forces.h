#pragma once
/// \file
/// Forces that joints carry, from the balance of momentum of the bodies.

#include <vector>

#include "api/engine.h"
#include "trees.h"

namespace spark::bullet {

/// Of a tree of bodies in joint coordinates nothing else says what its joints carry: on a body act its joints, and all
/// that is added here; together they change its momentum.
class JointForces {
 public:
  void compile(const engine::Model& model) { balances_.assign(model.bodies.size(), {}); }
  /// True for trees with a joint that is measured.
  static bool measures(const engine::Model& model, const std::vector<Link>& links);
  /// Before the bodies move: takes their momentum, gravity and given forces.
  void begin(const engine::Step& step, const std::vector<Link>& links);
  /// Adds a force and a torque about the point where it acts, world frame. kNone: the world, which has no balance.
  void add(Index body, const Vec3& force, const Vec3& torque, const Vec3& point);
  /// After the bodies have moved: writes what the joints of the tree carried.
  void end(engine::Step& step, const std::vector<Link>& links);

 private:
  /// Of a body: how it was, and what acts on it about its centre of mass, world frame.
  struct Balance {
    Vec3 position, momentum, angularMomentum, force, torque;
  };
  std::vector<Balance> balances_;  ///< by body
};

}  // namespace spark::bullet
