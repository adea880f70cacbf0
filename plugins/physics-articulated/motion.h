#pragma once
/// \file
/// Free motion: the torque of a spinning body on itself, and time.

#include "rows.h"

namespace spark::articulated {

/// Torque of a body that spins, with its own inertia [kg m^2, world frame], taken at the end of the step so that it
/// adds no energy (Lacoursiere 2006).
Vec3 gyroscopicTorque(const Mat3& inertia, const Vec3& spin, double dt);

/// Gives a body its new velocity [m/s] and spin [rad/s, world], and takes it where they lead in dt.
void integrate(engine::SolverBody& body, const Vec3& velocity, const Vec3& spin, double dt);

}  // namespace spark::articulated
