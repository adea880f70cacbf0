#pragma once
/// \file
/// Overlap test of two oriented boxes, as the referee of the installed base does it: the separating axis test
/// (S. Gottschalk, "Collision Queries using Oriented Bounding Boxes", 2000, chapter 5) with 3 + 3 face normals and 9
/// cross products of edges. It differs from the textbook in two ways:
///  - The cross products are not normalised. For edges at an angle with sine s the tolerance is therefore
///    tolerance / s, so that nearly parallel boxes, such as two shanks side by side, hardly ever overlap.
///  - It is computed in single precision, like the boxes' transforms there.

#include <Eigen/Geometry>

#include "api/math.h"

namespace spark::soccer {

/// An oriented box in the world frame, in single precision.
struct SingleBox {
  Vec3f centre = Vec3f::Zero();                        ///< m
  Eigen::Matrix3f axes = Eigen::Matrix3f::Identity();  ///< columns: unit axes
  Eigen::Matrix3f edges = Eigen::Matrix3f::Zero();     ///< columns: axis times half edge length [m]

  SingleBox() = default;
  /// `half`: half edge lengths [m].
  SingleBox(const Pose& pose, const Vec3f& half)
      : centre(pose.position.cast<float>()), axes(pose.rotation.cast<float>()) {
    for (int i = 0; i < 3; ++i) edges.col(i) = axes.col(i) * half[i];
  }
};

/// True when the projections of the boxes onto `axis` overlap by less than `tolerance`. `axis` need not be a unit
/// vector; projections scale with its length, `tolerance` [m] does not.
inline bool isSeparatingAxis(const Vec3f& axis, float tolerance, const SingleBox& a, const SingleBox& b) {
  const Vec3f between = b.centre - a.centre;
  float reach = 0;
  for (int i = 0; i < 3; ++i) reach += std::abs(a.edges.col(i).dot(axis));
  for (int i = 0; i < 3; ++i) reach += std::abs(b.edges.col(i).dot(axis));
  return std::abs(between.dot(axis)) + tolerance > reach;
}

/// True when none of the 15 axes separates the boxes with `tolerance` [m].
inline bool overlapBeyond(float tolerance, const SingleBox& a, const SingleBox& b) {
  for (int i = 0; i < 3; ++i)
    if (isSeparatingAxis(a.axes.col(i), tolerance, a, b) || isSeparatingAxis(b.axes.col(i), tolerance, a, b))
      return false;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (isSeparatingAxis(a.axes.col(i).cross(b.axes.col(j)), tolerance, a, b)) return false;
  return true;
}

}  // namespace spark::soccer
