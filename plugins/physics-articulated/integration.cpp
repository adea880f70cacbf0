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

void integrate(engine::DynamicState& body, const Vec3& linearVelocity, const Vec3& angularVelocity, double dt) {
  body.linearVelocity = linearVelocity;
  body.angularVelocity = angularVelocity;
  body.position += dt * linearVelocity;
  // q += dt / 2 (0, w) q, brought back to length 1.
  std::array<double, 4>& q = body.quaternion;
  const Quaternion rate = Quaternion{0, angularVelocity} * Quaternion::of(q);
  const double half = 0.5 * dt;
  const double moved[] = {q[0] + half * rate.w, q[1] + half * rate.v.x(), q[2] + half * rate.v.y(),
                          q[3] + half * rate.v.z()};
  const double scale =
      1 / std::sqrt(moved[0] * moved[0] + moved[1] * moved[1] + moved[2] * moved[2] + moved[3] * moved[3]);
  for (int i = 0; i < 4; ++i) q[i] = moved[i] * scale;
  body.rotation = rotationOf(q);
  body.force.setZero();
  body.torque.setZero();
  body.awake = true;
  ++body.version;
}

}  // namespace spark::articulated
