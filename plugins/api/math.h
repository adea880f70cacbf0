#pragma once
/// \file
/// Vectors, rotations, matrices, and their conversion to and from the values of Lua and scene files.
///
/// Physics is double precision. Transforms are single precision, as in the scenes and monitors of the installed base.
/// Frames are right-handed with z up; units are metres and radians, degrees only where a name says so.

#include <fmt/format.h>

#include <Eigen/Core>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <numbers>

#include "spark/abi/api/math.h"
#include "spark/error.h"
#include "spark/value.h"

namespace spark {

using Vec3 = Eigen::Vector3d;
using Vec3f = Eigen::Vector3f;
/// 3x3 matrix. As a rotation: columns are the body's axes in the outer frame.
using Mat3 = Eigen::Matrix3d;
/// 4x4 homogeneous transform, column-major, single precision, not aligned.
using Matrix = Eigen::Matrix<float, 4, 4, Eigen::ColMajor | Eigen::DontAlign>;
/// RGBA, each 0..1.
struct Color {
  float r = 0, g = 0, b = 0, a = 1;
};
/// Position [m] and rotation of a frame in an outer frame, the world's unless said otherwise.
struct Pose {
  Vec3 position = Vec3::Zero();
  Mat3 rotation = Mat3::Identity();
};

/// The composition outer * inner: `inner` is given in the frame of `outer`, the result in that of which `outer` is
/// given.
inline Pose compose(const Pose& outer, const Pose& inner) {
  return {outer.position + outer.rotation * inner.position, outer.rotation * inner.rotation};
}
/// The pose of the outer frame in the given one.
inline Pose inverse(const Pose& p) { return {-(p.rotation.transpose() * p.position), p.rotation.transpose()}; }
/// The rotation of a quaternion w x y z of length 1.
inline Mat3 rotationOf(const std::array<double, 4>& q) {
  const double xx = 2 * q[1] * q[1], yy = 2 * q[2] * q[2], zz = 2 * q[3] * q[3];
  Mat3 m;
  m << 1 - yy - zz, 2 * (q[1] * q[2] - q[0] * q[3]), 2 * (q[1] * q[3] + q[0] * q[2]),  //
      2 * (q[1] * q[2] + q[0] * q[3]), 1 - xx - zz, 2 * (q[2] * q[3] - q[0] * q[1]),   //
      2 * (q[1] * q[3] - q[0] * q[2]), 2 * (q[2] * q[3] + q[0] * q[1]), 1 - xx - yy;
  return m;
}

constexpr double kPi = std::numbers::pi;
inline double degToRad(double deg) { return deg * (kPi / 180.0); }
inline double radToDeg(double rad) { return rad * (180.0 / kPi); }
/// The angle [deg] normalised to [-180, 180).
inline double normalizeDeg(double deg) {
  const double r = std::fmod(deg + 180.0, 360.0);
  return (r < 0 ? r + 360.0 : r) - 180.0;
}

/// Rotation by angles [deg] about x, y, z: R = Rx Ry Rz, computed in single precision (scene-language section 2.3).
inline Matrix rotationDeg(float ax, float ay, float az) {
  const auto axis = [](int a, int b, float deg) {
    const float rad = deg * (std::numbers::pi_v<float> / 180.0f), c = std::cos(rad), s = std::sin(rad);
    Matrix m = Matrix::Identity();
    m(a, a) = c, m(b, b) = c, m(b, a) = s, m(a, b) = -s;
    return m;
  };
  const Matrix x = axis(1, 2, ax), y = axis(2, 0, ay), z = axis(0, 1, az);
  const Matrix xy = x * y;
  return xy * z;
}
/// Translation by `p` [m].
inline Matrix translation(const Vec3f& p) {
  Matrix m = Matrix::Identity();
  m.block<3, 1>(0, 3) = p;
  return m;
}
/// Inverse of a rigid transform: rotation and translation, no scale.
inline Matrix rigidInverse(const Matrix& m) {
  Matrix out = Matrix::Identity();
  out.block<3, 3>(0, 0) = m.block<3, 3>(0, 0).transpose();
  out.block<3, 1>(0, 3) = -(out.block<3, 3>(0, 0) * m.block<3, 1>(0, 3));
  return out;
}
/// The translation of a transform.
inline Vec3f positionOf(const Matrix& m) { return m.block<3, 1>(0, 3); }
/// A rigid transform as pose.
inline Pose toPose(const Matrix& m) { return {positionOf(m).cast<double>(), m.block<3, 3>(0, 0).cast<double>()}; }
/// A pose as transform, rounded to single precision.
inline Matrix toMatrix(const Pose& p) {
  Matrix m = Matrix::Identity();
  m.block<3, 3>(0, 0) = p.rotation.cast<float>();
  m.block<3, 1>(0, 3) = p.position.cast<float>();
  return m;
}

namespace detail {
/// Reads N numbers from N scalars or one list of N. Throws Error otherwise.
template <int N>
inline std::array<double, N> numbers(Args& args) {
  std::array<double, N> out{};
  if (!args.atEnd() && args.values[args.next].isList()) {
    Args inner{args.values[args.next].toList(), args.loose};
    if (inner.left() != N) throw Error(fmt::format("expected {} numbers, found a list of {}", N, inner.left()));
    ++args.next;
    for (double& v : out) v = Convert<double>::from(inner);
  } else {
    for (double& v : out) v = Convert<double>::from(args);
  }
  return out;
}
}  // namespace detail

// Conversions for properties and method arguments: a vector is 3 numbers, a colour 4 (RGBA), a matrix 16
// (column-major), each as scalars or as one list.

template <>
struct Convert<Vec3> {
  static constexpr int kScalars = 3;
  static std::string typeName() { return "vec3"; }
  static Vec3 from(Args& args) {
    const auto v = detail::numbers<3>(args);
    return {v[0], v[1], v[2]};
  }
  static Value to(const Vec3& v) { return List{v.x(), v.y(), v.z()}; }
};
template <std::size_t N>
struct Convert<std::array<double, N>> {
  static constexpr int kScalars = N;
  static std::string typeName() { return fmt::format("{} numbers", N); }
  static std::array<double, N> from(Args& args) { return detail::numbers<N>(args); }
  static Value to(const std::array<double, N>& v) { return List(v.begin(), v.end()); }
};
template <>
struct Convert<Vec3f> {
  static constexpr int kScalars = 3;
  static std::string typeName() { return "vec3"; }
  static Vec3f from(Args& args) { return Convert<Vec3>::from(args).cast<float>(); }
  static Value to(const Vec3f& v) { return Convert<Vec3>::to(v.cast<double>()); }
};
template <>
struct Convert<Color> {
  static constexpr int kScalars = 4;
  static std::string typeName() { return "rgba"; }
  static Color from(Args& args) {
    const auto v = detail::numbers<4>(args);
    return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]), static_cast<float>(v[3])};
  }
  static Value to(const Color& c) { return List{double(c.r), double(c.g), double(c.b), double(c.a)}; }
};
template <>
struct Convert<Matrix> {
  static constexpr int kScalars = 16;
  static std::string typeName() { return "matrix"; }
  static Matrix from(Args& args) {
    const auto v = detail::numbers<16>(args);
    Matrix m;
    for (int i = 0; i < 16; ++i) m(i % 4, i / 4) = static_cast<float>(v[i]);
    return m;
  }
  static Value to(const Matrix& m) {
    List out;
    for (int i = 0; i < 16; ++i) out.push_back(double(m(i % 4, i / 4)));
    return out;
  }
};

}  // namespace spark
