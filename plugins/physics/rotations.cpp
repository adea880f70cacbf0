#include "rotations.h"

#include <cmath>

namespace spark::physics {

namespace {

/// `v` divided by its length, which is computed relative to its largest element.
Vec3 unit(const Vec3& v) {
  int largest = std::abs(v[1]) > std::abs(v[0]) ? 1 : 0;
  if (std::abs(v[2]) > std::abs(v[largest])) largest = 2;
  const int i = largest == 0 ? 1 : 0, j = largest == 2 ? 1 : 2;
  const double scale = 1 / std::abs(v[largest]);
  const double x = v[i] * scale, y = v[j] * scale;
  const double inverse = 1 / std::sqrt(x * x + 1 + y * y);
  Vec3 out;
  out[i] = x * inverse;
  out[j] = y * inverse;
  out[largest] = std::copysign(inverse, v[largest]);
  return out;
}

Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y() * b.z() - a.z() * b.y(), a.z() * b.x() - a.x() * b.z(), a.x() * b.y() - a.y() * b.x()};
}

}  // namespace

Mat3 orthogonalized(const Mat3& m) {
  const Vec3 first = m.row(0), second = m.row(1);
  const double square = dot(first, first), projection = dot(first, second);
  Vec3 perpendicular = second;
  if (projection != 0) {
    const double share = projection / square;
    for (int i = 0; i < 3; ++i) perpendicular[i] = second[i] - share * first[i];
  }
  const Vec3 x = square != 1 ? unit(first) : first;
  const Vec3 y = dot(perpendicular, perpendicular) != 1 ? unit(perpendicular) : perpendicular;
  Mat3 out;
  out.row(0) = x;
  out.row(1) = projection != 0 ? second : y;  // ODE does not store the corrected one
  out.row(2) = cross(x, y);
  return out;
}

Quaternion normalized(const Quaternion& q) {
  const double scale = 1 / std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  return {q[0] * scale, q[1] * scale, q[2] * scale, q[3] * scale};
}

Quaternion quaternionOf(const Mat3& m) {
  Quaternion q;
  const double trace = m(0, 0) + m(1, 1) + m(2, 2);
  if (trace >= 0) {
    const double root = std::sqrt(trace + 1), scale = 0.5 * (1 / root);
    q[0] = 0.5 * root;
    q[1] = (m(2, 1) - m(1, 2)) * scale;
    q[2] = (m(0, 2) - m(2, 0)) * scale;
    q[3] = (m(1, 0) - m(0, 1)) * scale;
    return q;
  }
  int i = m(1, 1) > m(0, 0) ? 1 : 0;
  if (m(2, 2) > m(i, i)) i = 2;
  const int j = (i + 1) % 3, k = (i + 2) % 3;
  const double root = std::sqrt(m(i, i) - (m(j, j) + m(k, k)) + 1), scale = 0.5 * (1 / root);
  q[1 + i] = 0.5 * root;
  q[1 + j] = (m(i, j) + m(j, i)) * scale;
  q[1 + k] = (m(k, i) + m(i, k)) * scale;
  q[0] = (m(k, j) - m(j, k)) * scale;
  return q;
}

Quaternion conjugateTimes(const Quaternion& a, const Quaternion& b) {
  return {a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3],  //
          a[0] * b[1] - a[1] * b[0] - a[2] * b[3] + a[3] * b[2],  //
          a[0] * b[2] - a[2] * b[0] - a[3] * b[1] + a[1] * b[3],  //
          a[0] * b[3] - a[3] * b[0] - a[1] * b[2] + a[2] * b[1]};
}

Quaternion timesConjugate(const Quaternion& a, const Quaternion& b) {
  return {a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3],   //
          -a[0] * b[1] + a[1] * b[0] - a[2] * b[3] + a[3] * b[2],  //
          -a[0] * b[2] + a[2] * b[0] - a[3] * b[1] + a[1] * b[3],  //
          -a[0] * b[3] + a[3] * b[0] - a[1] * b[2] + a[2] * b[1]};
}

Quaternion conjugateTimesConjugate(const Quaternion& a, const Quaternion& b) {
  return {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],   //
          -a[0] * b[1] - a[1] * b[0] + a[2] * b[3] - a[3] * b[2],  //
          -a[0] * b[2] - a[2] * b[0] + a[3] * b[1] - a[1] * b[3],  //
          -a[0] * b[3] - a[3] * b[0] + a[1] * b[2] - a[2] * b[1]};
}

Mat3 frameFromAxes(const Vec3& first, const Vec3& second) {
  Mat3 m = Mat3::Zero();
  double length = std::sqrt(dot(first, first));
  if (!(length > 0)) return m;
  const Vec3 x = first * (1 / length);
  const double along = dot(x, second);
  Vec3 y = second - along * x;
  length = std::sqrt(dot(y, y));
  if (!(length > 0)) return m;
  y *= 1 / length;
  m.col(0) = x;
  m.col(1) = y;
  m.col(2) = Vec3(-y.y() * x.z() + x.y() * y.z(), -y.z() * x.x() + x.z() * y.x(), -y.x() * x.y() + x.x() * y.y());
  return m;
}

double hingeAngle(const Quaternion& q, const Vec3& axis) {
  // q = (cos(angle / 2), sin(angle / 2) axis), and -q is the same rotation: take the one whose vector is along the
  // axis.
  const double sine = std::sqrt(q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  const bool along = q[1] * axis.x() + q[2] * axis.y() + q[3] * axis.z() >= 0;
  const double angle = 2 * std::atan2(sine, along ? q[0] : -q[0]);
  // The sign turns "second relative to first" into "first relative to second".
  return -(angle > kPi ? angle - 2 * kPi : angle);
}

Vec3 times(const Mat3& m, const Vec3& v) {
  return {m(0, 0) * v[0] + m(0, 1) * v[1] + m(0, 2) * v[2],  //
          m(1, 0) * v[0] + m(1, 1) * v[1] + m(1, 2) * v[2],  //
          m(2, 0) * v[0] + m(2, 1) * v[1] + m(2, 2) * v[2]};
}

Vec3 transposeTimes(const Mat3& m, const Vec3& v) {
  return {m(0, 0) * v[0] + m(1, 0) * v[1] + m(2, 0) * v[2],  //
          m(0, 1) * v[0] + m(1, 1) * v[1] + m(2, 1) * v[2],  //
          m(0, 2) * v[0] + m(1, 2) * v[1] + m(2, 2) * v[2]};
}

}  // namespace spark::physics
