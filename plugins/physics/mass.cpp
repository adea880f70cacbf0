#include "mass.h"

namespace spark::physics {
namespace {

/// A mass centred in the origin, with x, y, z as principal moments of inertia [kg m^2].
engine::Mass diagonal(double mass, double x, double y, double z) {
  return {mass, Vec3::Zero(), Mat3(Vec3(x, y, z).asDiagonal())};
}

/// Inertia of a point mass at `p` about the origin: the term of the parallel axis theorem (Steiner).
Mat3 pointInertia(double mass, const Vec3& p) {
  return mass * (p.squaredNorm() * Mat3::Identity() - p * p.transpose());
}

}  // namespace

// The order of operations is that of ODE's dMassSet...Total, so that masses agree with the installed base to the last
// bit.

engine::Mass boxMass(double m, const Vec3& e) {
  const Vec3 s = e.cwiseProduct(e);
  return diagonal(m, m / 12 * (s.y() + s.z()), m / 12 * (s.x() + s.z()), m / 12 * (s.x() + s.y()));
}

engine::Mass sphereMass(double m, double r) {
  const double i = 0.4 * m * r * r;
  return diagonal(m, i, i, i);
}

engine::Mass capsuleMass(double m, double r, double l) {
  const double tube = cylinderVolume(r, l), caps = sphereVolume(r), density = m / (tube + caps);
  const double across =
      tube * (0.25 * r * r + 1.0 / 12.0 * l * l) + caps * (0.4 * r * r + 0.375 * r * l + 0.25 * l * l);
  const double along = (tube * 0.5 + caps * 0.4) * r * r;
  return diagonal(m, across * density, across * density, along * density);
}

engine::Mass cylinderMass(double m, double r, double l) {
  const double across = m * (0.25 * (r * r) + 1.0 / 12.0 * l * l);
  return diagonal(m, across, across, m * 0.5 * (r * r));
}

double boxVolume(const Vec3& e) { return e.prod(); }
double sphereVolume(double r) { return 4.0 / 3.0 * kPi * r * r * r; }
double capsuleVolume(double r, double l) { return cylinderVolume(r, l) + sphereVolume(r); }
double cylinderVolume(double r, double l) { return kPi * r * r * l; }

engine::Mass addMass(const engine::Mass& whole, const engine::Mass& part, const Pose& at) {
  engine::Mass sum;
  sum.mass = whole.mass + part.mass;
  sum.center = (whole.mass * whole.center + part.mass * at.position) / sum.mass;
  sum.inertia =
      whole.inertia + at.rotation * part.inertia * at.rotation.transpose() + pointInertia(part.mass, at.position);
  return sum;
}

engine::Mass together(const engine::Mass& a, const engine::Mass& b) {
  if (a.mass == 0) return b;
  if (b.mass == 0) return a;
  engine::Mass sum{a.mass + b.mass, Vec3::Zero(), Mat3::Zero()};
  sum.center = (a.mass * a.center + b.mass * b.center) / sum.mass;
  for (const engine::Mass& m : {a, b}) sum.inertia += m.inertia + pointInertia(m.mass, m.center - sum.center);
  return sum;
}

engine::Mass centred(const engine::Mass& m) {
  return {m.mass, Vec3::Zero(), m.inertia - pointInertia(m.mass, m.center)};
}

}  // namespace spark::physics
