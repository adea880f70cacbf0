#include "integration.h"

namespace spark::articulated {

Vec3 gyroscopicTorque(const Mat3& inertia, const Vec3& angularVelocity, double dt) {
  // With the angular momentum L = I w and its cross product matrix [L], the linearised implicit Euler step is
  // (I - dt [L]) w' = L, and the torque is I (w' - w) / dt.
  const Vec3 momentum = inertia * angularVelocity;
  Mat3 cross;
  cross << 0, -momentum.z(), momentum.y(), momentum.z(), 0, -momentum.x(), -momentum.y(), momentum.x(), 0;
  const Mat3 implicitInertia = inertia - dt * cross;
  if (implicitInertia.determinant() == 0) return Vec3::Zero();
  const Vec3 rate = momentum / dt;
  return inertia * (implicitInertia.inverse() * rate) - rate;
}

namespace {

/// Writes the rotation matrix of a unit quaternion q (w x y z) as 3 rows of 4 elements.
void writeRotation(const double* q, double* rows) {
  const double xx = 2 * q[1] * q[1], yy = 2 * q[2] * q[2], zz = 2 * q[3] * q[3];
  const double r[] = {1 - yy - zz,
                      2 * (q[1] * q[2] - q[0] * q[3]),
                      2 * (q[1] * q[3] + q[0] * q[2]),
                      0,
                      2 * (q[1] * q[2] + q[0] * q[3]),
                      1 - xx - zz,
                      2 * (q[2] * q[3] - q[0] * q[1]),
                      0,
                      2 * (q[1] * q[3] - q[0] * q[2]),
                      2 * (q[2] * q[3] + q[0] * q[1]),
                      1 - xx - yy,
                      0};
  std::copy(r, r + 12, rows);
}

}  // namespace

void integrate(engine::SolverBody& body, const Vec3& linearVelocity, const Vec3& angularVelocity, double dt) {
  for (int i = 0; i < 3; ++i) {
    body.linearVelocity[i] = linearVelocity[i];
    body.angularVelocity[i] = angularVelocity[i];
    body.position[i] += dt * linearVelocity[i];
  }
  // q += dt / 2 (0, w) q, brought back to length 1.
  double* q = body.quaternion;
  const Quaternion rate = Quaternion{0, angularVelocity} * Quaternion::of(q);
  const double half = 0.5 * dt;
  const double moved[] = {q[0] + half * rate.w, q[1] + half * rate.v.x(), q[2] + half * rate.v.y(),
                          q[3] + half * rate.v.z()};
  const double scale =
      1 / std::sqrt(moved[0] * moved[0] + moved[1] * moved[1] + moved[2] * moved[2] + moved[3] * moved[3]);
  for (int i = 0; i < 4; ++i) q[i] = moved[i] * scale;
  writeRotation(q, body.rotation);
  for (int i = 0; i < 3; ++i) body.force[i] = body.torque[i] = 0;
}

}  // namespace spark::articulated
