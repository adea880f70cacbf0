#pragma once
/// \file
/// A convex hull as ODE and the search for contact points need it: its corners around its centre, and its faces as
/// polygons.

#include <memory>
#include <vector>

#include "api/shape.h"

namespace spark::ode {

class ConvexHull {
 public:
  /// A face: corners in order, counter-clockwise seen from outside.
  struct Face {
    Vec3 normal;    ///< outwards, of length 1
    double offset;  ///< normal . p of its points [m]
    std::vector<std::uint32_t> corners;
  };

  /// `mesh`: a hull with triangles that point outwards.
  explicit ConvexHull(std::shared_ptr<const engine::Mesh> mesh);

  /// The middle of the corners, in the frame of the shape: ODE searches from the origin of a geom, which has to be
  /// inside.
  const Vec3& center() const { return center_; }
  /// x y z of each, around the centre.
  const std::vector<double>& corners() const { return corners_; }
  Vec3 corner(std::uint32_t i) const { return {corners_[3 * i], corners_[3 * i + 1], corners_[3 * i + 2]}; }
  const std::vector<Face>& faces() const { return faces_; }
  // As dCreateConvex() takes them: normal and offset of each face; number and indices of its corners.
  const std::vector<double>& planes() const { return planes_; }
  const std::vector<unsigned>& polygons() const { return polygons_; }

 private:
  /// Removes corners that do not turn left, and begins with three that turn left seen from the centre too. False: there
  /// are none, as of a face without area.
  bool makeConvex(Face& face) const;
  /// `corners`: those in the plane, in order of their numbers.
  void addFace(const Vec3& normal, double offset, const std::vector<std::uint32_t>& corners);

  std::shared_ptr<const engine::Mesh> mesh_;  // keeps its address
  Vec3 center_ = Vec3::Zero();
  std::vector<double> corners_, planes_;
  std::vector<Face> faces_;
  std::vector<unsigned> polygons_;
};

}  // namespace spark::ode
