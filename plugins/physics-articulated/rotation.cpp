#include "rotation.h"

namespace spark::articulated {

namespace {

/// atan(i / 8) for i = 0..8.
constexpr double kAtanOfEighths[] = {0.0,
                                     0.12435499454676143503,
                                     0.24497866312686415417,
                                     0.3587706702705722204,
                                     0.46364760900080611621,
                                     0.55859931534356243597,
                                     0.6435011087932843868,
                                     0.71882999962162450542,
                                     0.78539816339744830962};

/// atan(y / x) for 0 <= y <= x.
double atanInFirstOctant(double y, double x) {
  // With c the multiple of 1/8 that is nearest to y / x:  atan(y / x) = atan(c) + atan(z),  z = (y - c x) / (x + c y),
  // |z| <= 1/16.
  const double t = y / x;
  const int eighth = static_cast<int>(t * 8 + 0.5);  // NOLINT(bugprone-incorrect-roundings): t >= 0
  const double c = eighth * 0.125;
  const double z = (y - c * x) / (x + c * y);
  // atan(z) = z (1 - z^2/3 + z^4/5 - ...). The first term left out is below 1e-18.
  const double zz = z * z;
  const double series =
      zz * (-1.0 / 3 + zz * (1.0 / 5 + zz * (-1.0 / 7 + zz * (1.0 / 9 + zz * (-1.0 / 11 + zz * (1.0 / 13))))));
  return kAtanOfEighths[eighth] + (z + z * series);
}

}  // namespace

double portableAtan2(double y, double x) {
  const double ax = std::abs(x), ay = std::abs(y);
  // (0, 0) has the angle 0; NaN stays NaN.
  if (!(ax + ay > 0)) return x == 0 && y == 0 ? 0 : ax + ay;
  // Reflect the first octant into the other seven.
  double angle = ay <= ax ? atanInFirstOctant(ay, ax) : kPi / 2 - atanInFirstOctant(ax, ay);
  if (x < 0) angle = kPi - angle;
  return y < 0 ? -angle : angle;
}

// After Shepperd 1978, "Quaternion from rotation matrix": divide by the largest element, except that any w of at least
// 1/2 will do.
Quaternion Quaternion::of(const Mat3& m) {
  const double trace = m.trace();
  if (trace >= 0) {
    const double s = std::sqrt(trace + 1), f = 0.5 / s;
    return {0.5 * s, {(m(2, 1) - m(1, 2)) * f, (m(0, 2) - m(2, 0)) * f, (m(1, 0) - m(0, 1)) * f}};
  }
  int i = m(1, 1) > m(0, 0) ? 1 : 0;
  if (m(2, 2) > m(i, i)) i = 2;
  const int j = (i + 1) % 3, k = (i + 2) % 3;
  const double s = std::sqrt(m(i, i) - m(j, j) - m(k, k) + 1), f = 0.5 / s;
  Quaternion out;
  out.w = (m(k, j) - m(j, k)) * f;
  out.v[i] = 0.5 * s;
  out.v[j] = (m(j, i) + m(i, j)) * f;
  out.v[k] = (m(k, i) + m(i, k)) * f;
  return out;
}

double hingeAngle(const Quaternion& rotation, const Vec3& axis) {
  // q = (cos(angle / 2), sin(angle / 2) axis), and -q is the same rotation: take the one whose v points along the axis.
  const double half = portableAtan2(rotation.v.norm(), rotation.v.dot(axis) >= 0 ? rotation.w : -rotation.w);
  const double angle = 2 * half;
  // The sign turns "b relative to a" into "a relative to b".
  return -(angle > kPi ? angle - 2 * kPi : angle);
}

void perpendicularBasis(const Vec3& n, Vec3& p, Vec3& q) {
  // p is also perpendicular to the x axis where n is near z, else to the z axis.
  if (std::abs(n.z()) > std::numbers::sqrt2 / 2) {
    const double a = n.y() * n.y() + n.z() * n.z(), k = 1 / std::sqrt(a);
    p = {0, -n.z() * k, n.y() * k};
    q = {a * k, -n.x() * p.z(), n.x() * p.y()};
  } else {
    const double a = n.x() * n.x() + n.y() * n.y(), k = 1 / std::sqrt(a);
    p = {-n.y() * k, n.x() * k, 0};
    q = {-n.z() * p.y(), n.z() * p.x(), a * k};
  }
}

Mat3 orthonormalFrame(const Vec3& x, const Vec3& y) {
  // Gram-Schmidt.
  Mat3 m;
  m.col(0) = x.normalized();
  m.col(1) = (y - y.dot(m.col(0)) * m.col(0)).normalized();
  m.col(2) = m.col(0).cross(m.col(1));
  return m;
}

}  // namespace spark::articulated
