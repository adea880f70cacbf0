#pragma once
/// \file
/// A ray against one shape, in the frame of the shape.

#include <cmath>

#include "api/model.h"

namespace spark::physics {

/// A ray in the frame of a shape, and the nearest hit so far. A shape that contains the origin is met where the ray
/// leaves it.
struct ShapeRay {
  Vec3 from, direction;        ///< m; length 1
  double nearest;              ///< hits farther away do not count [m]
  Vec3 normal = Vec3::Zero();  ///< of the nearest hit, against the ray
  bool hit = false;

  Vec3 at(double t) const { return from + t * direction; }
  void take(double t, const Vec3& outwards) {
    if (!(t >= 0) || !std::isfinite(t) || t > nearest) return;
    nearest = t;
    normal = outwards.dot(direction) > 0 ? Vec3(-outwards) : outwards;
    hit = true;
  }
};

/// Takes the nearest hit of a shape; of a mesh it tests every triangle.
void castShape(ShapeRay& ray, const engine::ShapeDescription& shape);
/// Takes the hit of a triangle.
void castTriangle(ShapeRay& ray, const Vec3& a, const Vec3& b, const Vec3& c);
/// Takes the hit of one triangle of a mesh.
void castTriangle(ShapeRay& ray, const engine::Mesh& mesh, std::size_t triangle);
/// A corner of the triangles of a mesh [m].
inline Vec3 cornerOf(const engine::Mesh& mesh, std::size_t corner) { return mesh.vertex(mesh.triangles[corner]); }
/// Radius of a sphere around the shape's origin that holds it [m]; infinite for planes, and for meshes and height
/// fields, which would have to be measured.
double reach(const engine::ShapeDescription& shape);

}  // namespace spark::physics
