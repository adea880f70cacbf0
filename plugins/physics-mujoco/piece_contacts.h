#pragma once
/// \file
/// Contacts of the convex pieces of static meshes.
///
/// MuJoCo seeks contacts of a mesh along the line between two centres (Snethen 2008, "XenoCollide"). Of a thin plate or
/// a wide slab that line is oblique: normals point sideways, and what lies on it is thrown about. Its contacts with
/// planes are exact. So the plane of the face that a body has sunk into least is asked, and its points are clipped by
/// the face:
///
///          ___________
///         |   body    |            a, b: MuJoCo's contacts with the plane
///        =a=====c-----b---         a, c: those of the face, which ends at c
///        |  plate |
///
/// Where nothing of them is left, such as beside an edge, the contact is MuJoCo's own.

#include <mujoco/mujoco.h>

#include <vector>

#include "api/math.h"

namespace spark::mujoco {

/// The pieces of one model. One thread at a time.
class PieceContacts {
 public:
  /// MuJoCo's geom `geom` is such a piece. `front`: the direction, in the world, in which a plate looks; zero: it is a
  /// solid.
  void add(const mjModel& m, int geom, const Vec3& front);
  /// The contacts of two geoms, as MuJoCo's functions of collision find them; -1: they are MuJoCo's.
  int find(const mjModel* m, const mjData* d, mjContact* out, int geom1, int geom2, mjtNum margin);

 private:
  /// A face in the frame of its geom.
  struct Face {
    Vec3 normal;                ///< outwards, of length 1
    double offset = 0;          ///< normal . p of its points [m]
    std::vector<Vec3> corners;  ///< counter-clockwise seen from outside
    bool isRim = false;         ///< of a plate: not one of its two sides
  };
  struct Point {
    Vec3 position;    ///< in the frame of the piece
    double distance;  ///< as in mjContact
  };
  const std::vector<Face>* facesOf(int geom) const {
    return static_cast<std::size_t>(geom) < faces_.size() && !faces_[geom].empty() ? &faces_[geom] : nullptr;
  }
  /// MuJoCo's contacts of `other` with the plane of a face: sets points_. Returns the greatest depth; below 0: none.
  double ask(const mjModel* m, const mjData* d, mjContact* out, int piece, int other, const Face& face, mjtNum margin);
  /// Clips the polygon, edge or point of `points` by the sides of a face.
  void clip(const Face& face, std::vector<Point>& points);

  std::vector<std::vector<Face>> faces_;  ///< by MuJoCo's geom
  std::vector<Point> points_, best_, clipped_;
};

}  // namespace spark::mujoco
