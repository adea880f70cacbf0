#include "shapes.h"

#include <fmt/format.h>

#include <algorithm>

namespace spark::physics {

using engine::Shape;
using engine::ShapeDescription;

namespace {

constexpr double kMostDistance = 1e9;  // m: of a plane from the origin

void expectLength(double v, const char* what) {
  if (!(v >= 0 && v <= kFarthest)) throw Error(fmt::format("expected {} of 0 to {} m, found {}", what, kFarthest, v));
}

/// Throws Error for a malformed mesh.
void checkMesh(const ShapeDescription& s) {
  if (!s.mesh) throw Error("expected a mesh with triangles, found none");
  const engine::Mesh& m = *s.mesh;
  const std::size_t points = m.vertices.size() / 3;
  if (points == 0 || m.vertices.size() % 3 || m.triangles.empty() || m.triangles.size() % 3)
    throw Error(fmt::format("expected three numbers a vertex and three indices a triangle, found {} and {}",
                            m.vertices.size(), m.triangles.size()));
  if (m.vertices.size() + m.triangles.size() > kMostMeshNumbers)
    throw Error(fmt::format("expected a mesh of at most {} numbers, found {}: simplify it", kMostMeshNumbers,
                            m.vertices.size() + m.triangles.size()));
  for (double v : m.vertices) {
    if (!std::isfinite(v)) throw Error("a vertex of the mesh is not finite");
    if (std::abs(v) > kFarthest)
      throw Error(fmt::format("expected vertices within {} m, found {}: is the mesh in metres?", kFarthest, v));
  }
  for (std::uint32_t i : m.triangles)
    if (i >= points) throw Error(fmt::format("a triangle of the mesh names vertex {} of {}", i, points));
}

/// Throws Error for a malformed height field.
void checkHeights(const ShapeDescription& s) {
  if (!s.heightField) throw Error("expected a height field with heights, found none");
  const engine::HeightField& f = *s.heightField;
  const auto in = [](int n) { return n >= 2 && n <= kMostHeightEdge; };
  if (!in(f.columns) || !in(f.rows))
    throw Error(fmt::format("expected 2 to {} points along each edge of a height field, found {} x {}", kMostHeightEdge,
                            f.columns, f.rows));
  if (f.heights.size() != static_cast<std::size_t>(f.columns) * static_cast<std::size_t>(f.rows))
    throw Error(fmt::format("expected {} heights of a field of {} x {} points, found {}",
                            std::size_t(f.columns) * std::size_t(f.rows), f.columns, f.rows, f.heights.size()));
  for (const double size : {f.width, f.depth})
    if (!(size > 0) || size > kFarthest)
      throw Error(fmt::format("expected a size above 0 m and up to {} m, found {}", kFarthest, size));
  for (const float h : f.heights)
    if (!(std::abs(h) <= kFarthest))
      throw Error(fmt::format("expected finite heights within {} m, found {}", kFarthest, h));
  const auto [low, high] = std::minmax_element(f.heights.begin(), f.heights.end());
  if (f.low != *low || f.high != *high) throw Error("expected the least and the greatest of its heights");
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
          !(n > 1e-12) || !std::isfinite(n) || !(std::abs(s.plane[3] / n) <= kMostDistance))
        throw Error("expected a plane with a normal longer than 0 m and finite numbers");
      break;
    case Shape::ray:
      expectLength(s.length, "a ray's length");
      if (!(s.rayDirection.norm() > 1e-12) || !s.rayDirection.allFinite() ||
          !(s.rayOrigin.cwiseAbs().maxCoeff() <= kFarthest))
        throw Error("expected a ray with a direction longer than 0 m and finite numbers");
      break;
    case Shape::mesh:
    case Shape::convex:
      checkMesh(s);
      break;
    case Shape::heightField:
      checkHeights(s);
      break;
  }
}

}  // namespace spark::physics
