#include "shapes.h"

#include <fmt/format.h>

namespace spark::physics {

using engine::Shape;
using engine::ShapeDescription;

namespace {

void expectLength(double v, const char* what) {
  if (!std::isfinite(v) || v < 0) throw Error(fmt::format("expected {} of 0 m or more, found {}", what, v));
}

/// Throws Error for a malformed mesh.
void checkMesh(const ShapeDescription& s) {
  const std::size_t points = s.vertices.size() / 3;
  if (points == 0 || s.vertices.size() % 3 || s.triangles.empty() || s.triangles.size() % 3)
    throw Error(fmt::format("expected three numbers a vertex and three indices a triangle, found {} and {}",
                            s.vertices.size(), s.triangles.size()));
  for (double v : s.vertices)
    if (!std::isfinite(v)) throw Error("a vertex of the mesh is not finite");
  for (std::uint32_t i : s.triangles)
    if (i >= points) throw Error(fmt::format("a triangle of the mesh names vertex {} of {}", i, points));
}

}  // namespace

void checkShape(const ShapeDescription& s) {
  switch (s.shape) {
    case Shape::box:
      for (int i = 0; i < 3; ++i) expectLength(s.lengths[i], "an edge of a box");
      break;
    case Shape::sphere:
      expectLength(s.radius, "a sphere's radius");
      break;
    case Shape::capsule:
    case Shape::cylinder:
      expectLength(s.radius, "a radius");
      expectLength(s.length, "a length");
      break;
    case Shape::plane:
      if (const double n = std::hypot(s.plane[0], s.plane[1], s.plane[2]);
          !(n > 1e-12) || !std::isfinite(n) || !std::isfinite(s.plane[3]))
        throw Error("expected a plane with a normal longer than 0 m and finite numbers");
      break;
    case Shape::ray:
      expectLength(s.length, "a ray's length");
      if (!(s.rayDirection.norm() > 1e-12) || !s.rayDirection.allFinite() || !s.rayOrigin.allFinite())
        throw Error("expected a ray with a direction longer than 0 m and finite numbers");
      break;
    case Shape::mesh:
      checkMesh(s);
      break;
  }
}

}  // namespace spark::physics
