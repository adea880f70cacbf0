#pragma once
/// \file
/// Do two boxes overlap, as the installed base's referee decides it? Separating axes (S. Gottschalk, Collision Queries
/// using Oriented Bounding Boxes, 2000, chapter 5): 3 + 3 face normals and 9 cross products of edges. Two things are
/// that referee's own:
///  - The cross products are not brought to unit length. Where edges enclose an angle of sine s, the tolerance is worth
///  tolerance / s:
///    boxes that are nearly parallel, such as two shanks side by side, are hardly ever a foul.
///  - All of it is in single precision, as the boxes' transforms are there.

#include <Eigen/Geometry>

#include "api/math.h"

namespace spark::soccer {

/// A box in the world, in single precision.
struct SingleBox {
  Vec3f centre = Vec3f::Zero();
  Eigen::Matrix3f axes = Eigen::Matrix3f::Identity();  ///< a column each, of length 1
  Eigen::Matrix3f edges = Eigen::Matrix3f::Zero();     ///< a column each: axis times half of the edge [m]

  SingleBox() = default;
  /// `half`: half of its edges [m].
  SingleBox(const Pose& pose, const Vec3f& half)
      : centre(pose.position.cast<float>()), axes(pose.rotation.cast<float>()) {
    for (int i = 0; i < 3; ++i) edges.col(i) = axes.col(i) * half[i];
  }
};

/// True when the shadows of the boxes on `direction` overlap by no more than `tolerance`, which counts as long as
/// `direction` is.
inline bool apartAlong(const Vec3f& direction, float tolerance, const SingleBox& a, const SingleBox& b) {
  const Vec3f between = b.centre - a.centre;
  float reach = 0;
  for (int i = 0; i < 3; ++i) reach += std::abs(a.edges.col(i).dot(direction));
  for (int i = 0; i < 3; ++i) reach += std::abs(b.edges.col(i).dot(direction));
  return std::abs(between.dot(direction)) + tolerance > reach;
}

/// True when none of the 15 directions tells the boxes apart.
inline bool overlapBeyond(float tolerance, const SingleBox& a, const SingleBox& b) {
  for (int i = 0; i < 3; ++i)
    if (apartAlong(a.axes.col(i), tolerance, a, b) || apartAlong(b.axes.col(i), tolerance, a, b)) return false;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (apartAlong(a.axes.col(i).cross(b.axes.col(j)), tolerance, a, b)) return false;
  return true;
}

}  // namespace spark::soccer
