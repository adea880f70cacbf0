#pragma once
/// \file
/// Mass distributions of solids of uniform density about their own centre, and their addition.

#include "api/engine.h"

namespace spark::physics {

/// A box of `mass` [kg] with full edge lengths `edges` [m].
engine::Mass boxMass(double mass, const Vec3& edges);
/// A sphere of `mass` [kg] and `radius` [m].
engine::Mass sphereMass(double mass, double radius);
/// A capsule along z of `mass` [kg], `radius` and `length` without the caps [m].
engine::Mass capsuleMass(double mass, double radius, double length);
/// A cylinder along z of `mass` [kg], `radius` and `length` [m].
engine::Mass cylinderMass(double mass, double radius, double length);

// Volumes of the same solids [m^3]; lengths in m.
double boxVolume(const Vec3& edges);
double sphereVolume(double radius);
double capsuleVolume(double radius, double length);
double cylinderVolume(double radius, double length);

/// `whole` plus `part`, whose own centre is at the pose `at` in the frame of `whole`. The sum's `center` is the common
/// centre of mass; its inertia is about the origin.
engine::Mass addMass(const engine::Mass& whole, const engine::Mass& part, const Pose& at);
/// Two masses in one frame, whose inertia is about their own centres; so is that of the sum. A mass of 0 adds nothing.
engine::Mass together(const engine::Mass& a, const engine::Mass& b);
/// The same mass with the origin moved to its centre of mass.
engine::Mass centred(const engine::Mass& mass);

}  // namespace spark::physics
