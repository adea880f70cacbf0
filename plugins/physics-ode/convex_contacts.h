#pragma once
/// \file
/// Contact points of convex shapes. ODE finds one point and a normal for a pair with a convex hull, on which a body
/// would tip to and fro. Here the faces (or edges) of both shapes that look at each other are clipped, as ODE does for
/// two boxes: what lies flat is held by several points.
///
///        A  /‾‾‾‾\         n: ODE's normal, from B to A
///           \____/         reference: the face that is more perpendicular to n, here that of B
///       ──────────────     incident: the face of A that looks at it, clipped by the sides of the reference
///        B
///
/// As in: Gregorius 2013, "The Separating Axis Test between Convex Polyhedra", GDC; Sutherland and Hodgman 1974,
/// "Reentrant polygon clipping".

#include <span>
#include <vector>

#include "api/model.h"
#include "convex_hull.h"
#include "ode_numbers.h"

namespace spark::ode {

/// A shape at its place: one that is convex, and no plane.
struct PlacedShape {
  const engine::ShapeDescription& shape;
  const ConvexHull* hull;  ///< of Shape::convex; its corners are around the position
  Vec3 position;
  Mat3 rotation;
};

/// Finds contact points. Keeps its memory.
class ConvexContacts {
 public:
  /// Replaces the single point of ODE in `found` by at most `max`. Returns their number. ODE's point is kept where no
  /// face of either looks along its normal, such as of two edges.
  int spread(const PlacedShape& a, const PlacedShape& b, int max, dContactGeom* found);
  /// The corners of a hull below a plane through `origin` with the normal `normal`, of length 1, at most `max`.
  int onPlane(const PlacedShape& a, const Vec3& normal, double offset, int max, dContactGeom* found);
  /// Contacts with a static triangle mesh, whose order of triangles says nothing about which points matter: ODE is
  /// asked again with the hull turned a little to each side, as Bullet does. `probe`: the hull, in no space; of a
  /// cylinder the prism around it, whose points are moved to the cylinder, so that it rolls as a round body. `sides`:
  /// see OdeMesh::sidesAt().
  int onMesh(const PlacedShape& a, dGeomID probe, std::span<const dGeomID> sides, int max, dContactGeom* found);
  /// Keeps the `max` of `count` contacts that matter most. Returns their number.
  int choose(int count, int max, dContactGeom* found);

 private:
  /// What of a shape looks in a direction: a polygon, an edge or a point.
  struct Feature {
    std::vector<Vec3> points;  ///< in the world; of a polygon counter-clockwise seen from outside
    Vec3 normal;               ///< of a polygon
    double alignment = 0;      ///< cosine between its normal and the direction; 0: no polygon
  };
  struct Point {
    Vec3 position;
    double depth;
  };
  static void find(const PlacedShape& s, const Vec3& direction, Feature& out);
  /// Clips `incident` by the sides of `reference`; what is below the reference goes to points_.
  void clip(const Feature& reference, Feature& incident);
  int write(int max, const Vec3& normal, dContactGeom* found);

  Feature a_, b_;
  std::vector<Vec3> clipped_;
  std::vector<Point> points_;
  std::vector<dContactGeom> all_;
  std::vector<double> apart_;
};

}  // namespace spark::ode
