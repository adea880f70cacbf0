#pragma once
/// \file
/// Gyroscopic torque, and the integration of a body's motion.

#include "rows.h"

namespace spark::articulated {

/// The gyroscopic torque [Nm, world frame] of a body with the inertia `inertia` [kg m^2, world axes], integrated
/// implicitly: a step of `dt` [s] adds no energy (Lacoursière 2006, "Stabilizing gyroscopic forces in rigid multibody
/// simulations"). Zero where the implicit equation is singular.
Vec3 gyroscopicTorque(const Mat3& inertia, const Vec3& angularVelocity, double dt);

/// Sets a body's velocities [m/s, rad/s, world frame], moves it by them for `dt` [s] (semi-implicit Euler), and clears
/// its force and torque.
void integrate(engine::DynamicState& body, const Vec3& linearVelocity, const Vec3& angularVelocity, double dt);

}  // namespace spark::articulated
