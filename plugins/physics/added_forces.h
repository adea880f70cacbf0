#pragma once
/// \file
/// Forces that are added before a step for engines that do not apply them themselves.

#include "api/engine.h"
#include "joint_kinematics.h"

namespace spark::physics {

/// Adds the forces of controllers, springs and damping to those on the bodies.
class AddedForces {
 public:
  /// Both must outlive it.
  AddedForces(WorldData& world, const JointKinematics& joints) : world_(world), joints_(joints) {}
  /// Those that the engine leaves to it, for a step of `dt` [s].
  void add(const engine::Capabilities& can, double dt);

 private:
  /// Finds out which of them there are, where the model changed.
  void look();
  void addControls();
  void addDamping();
  void addSprings();
  /// That of a body without joints is implicit: it never turns it back, however strong it is. That of others is of the
  /// present velocity, as that of joints: too strong for their inertia and the step, it throws them about.
  void addBodyDamping(double dt);
  /// False for a joint whose bodies sleep: forces on them would pile up.
  bool acts(const engine::Joint& joint) const;
  /// Adds a force that increases the angle of an axis.
  void addAlong(const engine::Joint& joint, int axis, double force);

  WorldData& world_;
  const JointKinematics& joints_;
  bool damped_ = false, sprung_ = false, bodiesDamped_ = false;  ///< a joint or a body has it
  std::pair<std::uint64_t, std::uint64_t> lookedAt_;             ///< structure and dynamics of that
};

}  // namespace spark::physics
