#include "../mesh_pieces.h"

#include <catch2/catch.hpp>

#include "meshes/hull.h"

using namespace spark;
using mujoco::Piece;
using mujoco::piecesOf;

namespace {

/// Adds a prism whose base is this polygon of x and y, from z 0 to `height`; `top`: triangles of the polygon.
void addPrism(engine::Mesh& m, const std::vector<std::array<double, 2>>& base,
              const std::vector<std::array<unsigned, 3>>& top, double height) {
  const auto first = static_cast<std::uint32_t>(m.vertices.size() / 3), n = static_cast<std::uint32_t>(base.size());
  for (const double z : {0.0, height})
    for (const auto& p : base) m.vertices.insert(m.vertices.end(), {p[0], p[1], z});
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    m.triangles.insert(m.triangles.end(), {first + a, first + b, first + c});
  };
  for (const auto& t : top) add(t[0], t[2], t[1]), add(n + t[0], n + t[1], n + t[2]);
  for (std::uint32_t i = 0; i < n; ++i) add(i, (i + 1) % n, n + (i + 1) % n), add(i, n + (i + 1) % n, n + i);
}
void addBox(engine::Mesh& m, double x, double y, double width, double depth) {
  addPrism(m, {{x, y}, {x + width, y}, {x + width, y + depth}, {x, y + depth}}, {{0, 1, 2}, {0, 2, 3}}, 1);
}
double volumeOf(const Piece& piece) {
  const engine::Mesh m = meshes::hullOf(piece);
  double sum = 0;
  for (std::size_t t = 0; t < m.triangles.size(); t += 3) {
    Mat3 c;
    for (int i = 0; i < 3; ++i) c.col(i) = m.vertex(m.triangles[t + static_cast<std::size_t>(i)]);
    sum += c.determinant() / 6;
  }
  return sum;
}

}  // namespace

TEST_CASE("convex parts of a surface are pieces as they are") {
  engine::Mesh walls;
  addBox(walls, -2.2, -2.2, 0.2, 4.4);
  CHECK(piecesOf(walls).size() == 1);
  addBox(walls, 2, -2.2, 0.2, 4.4);
  addBox(walls, -2, -2.2, 4, 0.2);
  addBox(walls, -2, 2, 4, 0.2);
  const std::vector<Piece> pieces = piecesOf(walls);
  REQUIRE(pieces.size() == 4);
  for (const Piece& p : pieces) CHECK(p.size() == 24);
  CHECK(volumeOf(pieces[0]) == Approx(0.88));
  CHECK(volumeOf(pieces[3]) == Approx(0.8));
}

TEST_CASE("a part with a hollow becomes plates of convex polygons, which stay within it") {
  // An L of 2 m, whose bars are 1 m, and then 2 mm wide.
  for (const double width : {1.0, 0.002}) {
    engine::Mesh ell;
    addPrism(ell, {{0, 0}, {2, 0}, {2, width}, {width, width}, {width, 2}, {0, 2}},
             {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}}, 1);
    const std::vector<Piece> pieces = piecesOf(ell);
    // Six sides, top and bottom of two quadrilaterals each.
    CHECK(pieces.size() == 10);
    double volume = 0;
    for (const Piece& p : pieces) {
      volume += volumeOf(p);
      CHECK(p.size() == 24);
      for (std::size_t i = 0; i < p.size(); i += 3) {
        CHECK(std::min(p[i], p[i + 1]) < width + 1e-9);
        CHECK(std::min({p[i], p[i + 1], p[i + 2]}) > -1e-9);
        CHECK(p[i + 2] < 1 + 1e-9);
      }
    }
    CHECK(volume < 0.2);
  }
}

TEST_CASE("a surface without a volume is a plate, below its upper side") {
  engine::Mesh plane{{0, 0, 1, 3, 0, 1, 3, 2, 1, 0, 2, 1}, {0, 1, 2, 0, 2, 3}};
  const std::vector<Piece> pieces = piecesOf(plane);
  REQUIRE(pieces.size() == 1);
  CHECK(volumeOf(pieces[0]) == Approx(0.06));
  for (std::size_t i = 2; i < 24; i += 3) CHECK(pieces[0][i] <= 1);
  // Triangles without area, and a mesh of them alone.
  plane.triangles.insert(plane.triangles.end(), {0, 0, 1, 2, 2, 2});
  CHECK(piecesOf(plane).size() == 1);
  CHECK(piecesOf({{0, 0, 0, 1, 0, 0, 2, 0, 0}, {0, 1, 2}}).empty());
}

TEST_CASE("a surface of too many pieces has none") {
  engine::Mesh rough{{}, {}};
  constexpr std::uint32_t kEdge = 120;
  for (std::uint32_t i = 0; i < kEdge * kEdge; ++i)
    rough.vertices.insert(rough.vertices.end(), {double(i % kEdge), double(i / kEdge), 0.1 * ((i * i + 3 * i) % 101)});
  for (std::uint32_t y = 0; y + 1 < kEdge; ++y)
    for (std::uint32_t x = 0; x + 1 < kEdge; ++x) {
      const std::uint32_t i = y * kEdge + x;
      rough.triangles.insert(rough.triangles.end(), {i, i + 1, i + kEdge + 1, i, i + kEdge + 1, i + kEdge});
    }
  CHECK(piecesOf(rough).empty());
}
