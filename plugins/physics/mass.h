#pragma once
/// \file
/// Masses of simple solids of even density, about their own centre, and how they add up.

#include "api/engine.h"

namespace spark::physics {

/// kg; full edges [m].
engine::Mass boxMass(double mass, const Vec3& edges);
engine::Mass sphereMass(double mass, double radius);
/// Along z; `length` without the caps [m].
engine::Mass capsuleMass(double mass, double radius, double length);
/// Along z.
engine::Mass cylinderMass(double mass, double radius, double length);

/// Volumes [m^3].
double boxVolume(const Vec3& edges);
double sphereVolume(double radius);
double capsuleVolume(double radius, double length);
double cylinderVolume(double radius, double length);

/// `part` (about its own centre) turned and moved to `at`, added to `whole`; the sum's `center` is its centre of mass
/// and its inertia is about the origin.
engine::Mass addMass(const engine::Mass& whole, const engine::Mass& part, const Pose& at);
/// The same mass with its centre of mass moved to the origin.
engine::Mass centred(const engine::Mass& mass);

}  // namespace spark::physics
