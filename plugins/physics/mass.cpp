#include "mass.h"

namespace spark::physics {
namespace {

engine::Mass diagonal(double mass, double x, double y, double z) { return {mass, Vec3::Zero(), Mat3(Vec3(x, y, z).asDiagonal())}; }

/// What a point mass at `p` adds to the inertia about the origin.
Mat3 pointInertia(double mass, const Vec3& p) { return mass * (p.squaredNorm() * Mat3::Identity() - p * p.transpose()); }

}  // namespace

engine::Mass boxMass(double m, const Vec3& e) {
  const Vec3 s = e.cwiseProduct(e) * (m / 12);
  return diagonal(m, s.y() + s.z(), s.x() + s.z(), s.x() + s.y());
}

engine::Mass sphereMass(double m, double r) {
  const double i = 0.4 * m * r * r;
  return diagonal(m, i, i, i);
}

engine::Mass capsuleMass(double m, double r, double l) {
  const double density = m / capsuleVolume(r, l);
  const double tube = density * cylinderVolume(r, l), caps = density * sphereVolume(r);
  const double across = tube * (0.25 * r * r + l * l / 12) + caps * (0.4 * r * r + 0.375 * r * l + 0.25 * l * l);
  return diagonal(m, across, across, (0.5 * tube + 0.4 * caps) * r * r);
}

engine::Mass cylinderMass(double m, double r, double l) {
  const double across = m * (0.25 * r * r + l * l / 12);
  return diagonal(m, across, across, 0.5 * m * r * r);
}

double boxVolume(const Vec3& e) { return e.prod(); }
double sphereVolume(double r) { return 4.0 / 3.0 * kPi * r * r * r; }
double capsuleVolume(double r, double l) { return cylinderVolume(r, l) + sphereVolume(r); }
double cylinderVolume(double r, double l) { return kPi * r * r * l; }

engine::Mass addMass(const engine::Mass& whole, const engine::Mass& part, const Pose& at) {
  engine::Mass sum;
  sum.mass = whole.mass + part.mass;
  sum.center = (whole.mass * whole.center + part.mass * at.position) / sum.mass;
  sum.inertia = whole.inertia + at.rotation * part.inertia * at.rotation.transpose() + pointInertia(part.mass, at.position);
  return sum;
}

engine::Mass centred(const engine::Mass& m) { return {m.mass, Vec3::Zero(), m.inertia - pointInertia(m.mass, m.center)}; }

}  // namespace spark::physics
