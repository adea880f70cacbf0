#pragma once
/// \file
/// Mass distributions of solids of uniform density about their own centre, and their addition.

#include "api/model.h"
#include "spark/abi/api/mass.h"

namespace spark::physics {
namespace detail {

/// A mass centred in the origin, with x, y, z as principal moments of inertia [kg m^2].
inline engine::Mass diagonal(double mass, double x, double y, double z) {
  return {mass, Vec3::Zero(), Mat3(Vec3(x, y, z).asDiagonal())};
}

/// Inertia of a point mass at `p` about the origin: the term of the parallel axis theorem (Steiner).
inline Mat3 pointInertia(double mass, const Vec3& p) {
  return mass * (p.squaredNorm() * Mat3::Identity() - p * p.transpose());
}

}  // namespace detail

// Volumes of solids [m^3]; lengths in m.
inline double boxVolume(const Vec3& e) { return e.prod(); }
inline double sphereVolume(double r) { return 4.0 / 3.0 * kPi * r * r * r; }
inline double cylinderVolume(double r, double l) { return kPi * r * r * l; }
inline double capsuleVolume(double r, double l) { return cylinderVolume(r, l) + sphereVolume(r); }

// The order of operations is that of the installed base, so that masses agree with it to the last bit.

/// A box of `mass` [kg] with full edge lengths `edges` [m].
inline engine::Mass boxMass(double m, const Vec3& e) {
  const Vec3 s = e.cwiseProduct(e);
  return detail::diagonal(m, m / 12 * (s.y() + s.z()), m / 12 * (s.x() + s.z()), m / 12 * (s.x() + s.y()));
}

/// A sphere of `mass` [kg] and `radius` [m].
inline engine::Mass sphereMass(double m, double r) {
  const double i = 0.4 * m * r * r;
  return detail::diagonal(m, i, i, i);
}

/// A capsule along z of `mass` [kg], `radius` and `length` without the caps [m].
inline engine::Mass capsuleMass(double m, double r, double l) {
  const double tube = cylinderVolume(r, l), caps = sphereVolume(r), density = m / (tube + caps);
  const double across =
      tube * (0.25 * r * r + 1.0 / 12.0 * l * l) + caps * (0.4 * r * r + 0.375 * r * l + 0.25 * l * l);
  const double along = (tube * 0.5 + caps * 0.4) * r * r;
  return detail::diagonal(m, across * density, across * density, along * density);
}

/// A cylinder along z of `mass` [kg], `radius` and `length` [m].
inline engine::Mass cylinderMass(double m, double r, double l) {
  const double across = m * (0.25 * (r * r) + 1.0 / 12.0 * l * l);
  return detail::diagonal(m, across, across, m * 0.5 * (r * r));
}

/// `whole` plus `part`, whose own centre is at the pose `at` in the frame of `whole`. The sum's `center` is the common
/// centre of mass; its inertia is about the origin.
inline engine::Mass addMass(const engine::Mass& whole, const engine::Mass& part, const Pose& at) {
  engine::Mass sum;
  sum.mass = whole.mass + part.mass;
  sum.center = (whole.mass * whole.center + part.mass * at.position) / sum.mass;
  sum.inertia = whole.inertia + at.rotation * part.inertia * at.rotation.transpose() +
                detail::pointInertia(part.mass, at.position);
  return sum;
}

/// Two masses in one frame, whose inertia is about their own centres; so is that of the sum. A mass of 0 adds nothing.
inline engine::Mass together(const engine::Mass& a, const engine::Mass& b) {
  if (a.mass == 0) return b;
  if (b.mass == 0) return a;
  engine::Mass sum{a.mass + b.mass, Vec3::Zero(), Mat3::Zero()};
  sum.center = (a.mass * a.center + b.mass * b.center) / sum.mass;
  for (const engine::Mass& m : {a, b}) sum.inertia += m.inertia + detail::pointInertia(m.mass, m.center - sum.center);
  return sum;
}

/// The same mass with the origin moved to its centre of mass.
inline engine::Mass centred(const engine::Mass& m) {
  return {m.mass, Vec3::Zero(), m.inertia - detail::pointInertia(m.mass, m.center)};
}

}  // namespace spark::physics
