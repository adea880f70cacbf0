#pragma once
/// \file
/// What acts along the axes of joints and on bodies beside motors and contacts: computed before a step, for engines
/// that do not do so themselves.

#include "api/engine.h"
#include "joint_kinematics.h"

namespace spark::physics {

/// Writes the laws of controllers, springs, damping and rotors (engine::AxisLaw), or adds their forces to those on the
/// bodies; adds the damping of bodies.
///
/// Explicit forces of a stiff law would throw a light body about: with a mobility w (its inverse inertia along the
/// axis) a damper d reverses its velocity from d w dt = 1 on, and gains energy from 2 on. So a law has a resistance
/// against the velocity after the step. That of damping and rotors is exact:
///
///     -d v'  and  -armature (v' - v) / dt.
///
/// A spring, k (target - q'), would lose energy where it swings: it is explicit while it is soft, k w dt^2 < 1, which
/// keeps its energy, and the stiffer the more implicit: k (target - q - share dt v').
class AddedForces {
 public:
  /// Both must outlive it.
  AddedForces(WorldData& world, const JointKinematics& joints) : world_(world), joints_(joints) {}
  /// Those that the engine leaves to it, for a step of `dt` [s].
  void add(const engine::Capabilities& can, double dt);

 private:
  /// An axis with a spring, damping or a rotor. Of a ball joint, which has no axes, all three.
  struct PassiveAxis {
    engine::Index joint;
    int axis;
  };
  /// Finds out what there is, where the model changed.
  void look();
  void addControls(double dt);
  /// Springs, damping and rotors.
  void addPassive(const engine::Capabilities& can, double dt);
  /// The damping of a ball joint.
  void addBall(engine::Index joint);
  /// What a law is made of: force - damping v' - armature (v' - v) / dt, and of a spring with `stiffness` the implicit
  /// part. `force` has the explicit one.
  struct Terms {
    double force = 0, damping = 0, armature = 0, stiffness = 0, maxForce = HUGE_VAL;
  };
  /// A law of an axis, without what it does yet.
  engine::AxisLaw lawOf(engine::Index joint, int axis) const;
  void addLaw(engine::AxisLaw law, const Terms& terms, double dt);
  /// Adds a term with a range to those of a controller's law, as it is at the present place and velocity: at the end of
  /// its range it is a constant force, unless it would leave it within the step.
  void addTerm(const engine::ControlTerm& term, double angle, const engine::AxisLaw& law, double dt, Terms& to) const;
  /// Turns the laws into forces on the bodies.
  void applyLaws(double dt);
  /// Adds a force along a law, within its bound, to those on the bodies.
  void apply(const engine::AxisLaw& law, double force);
  void addBodyDamping(double dt);
  /// False for a joint whose bodies sleep: forces on them would pile up.
  bool acts(const engine::Joint& joint) const;
  /// Velocity of a relative to b along a law after a unit impulse, with nothing but the joint's anchor between them:
  /// other joints only make it less.
  double mobility(const engine::AxisLaw& law) const;
  double rateAlong(const engine::AxisLaw& law) const;
  /// What the turning axis of a slider adds to the second derivative of its place.
  double driftAlong(const engine::AxisLaw& law) const;
  /// Where the force of a slider acts, from a's centre: halfway to b's, so that the pair gets no torque.
  Vec3 sliderArm(const engine::Joint& joint) const;

  WorldData& world_;
  const JointKinematics& joints_;
  std::vector<PassiveAxis> passive_;
  bool bodiesDamped_ = false;
  std::pair<std::uint64_t, std::uint64_t> lookedAt_;  ///< structure and dynamics of that
};

}  // namespace spark::physics
