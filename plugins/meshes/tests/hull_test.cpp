#include "meshes/hull.h"

#include <catch2/catch.hpp>

#include "meshes/kept_hulls.h"

using namespace spark;
using engine::Mesh;

namespace {

/// A unit cube; its triangles share corners, or have their own.
Mesh cube(bool shared) {
  Mesh m;
  for (int i = 0; i < 8; ++i)
    for (int axis = 0; axis < 3; ++axis) m.vertices.push_back(i >> axis & 1);
  m.triangles = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
  if (shared) return m;
  Mesh out;
  for (std::uint32_t i = 0; i < m.triangles.size(); ++i) {
    const Vec3 at = m.vertex(m.triangles[i]);
    out.vertices.insert(out.vertices.end(), at.begin(), at.end());
    out.triangles.push_back(i);
  }
  return out;
}

}  // namespace

TEST_CASE("a surface is closed if its triangles meet at all edges and agree where outside is") {
  for (const bool shared : {true, false}) {
    Mesh m = cube(shared);
    CHECK(meshes::isClosed(m));
    std::swap(m.triangles[0], m.triangles[1]);
    CHECK_FALSE(meshes::isClosed(m));
    m.triangles.erase(m.triangles.begin(), m.triangles.begin() + 3);
    CHECK_FALSE(meshes::isClosed(m));
  }
  CHECK_FALSE(meshes::isClosed(Mesh{}));
}

TEST_CASE("hulls of the same numbers are made once, those of others are others") {
  const auto first = std::make_shared<const Mesh>(cube(true)), same = std::make_shared<const Mesh>(*first);
  const auto hull = meshes::keptHullOf(first);
  CHECK(*hull == meshes::hullOf(first->vertices));
  CHECK(meshes::keptHullOf(same) == hull);
  Mesh turned = *first;
  std::swap(turned.triangles[0], turned.triangles[1]);
  CHECK(meshes::keptHullOf(std::make_shared<const Mesh>(turned)) != hull);
  Mesh larger = *first;
  larger.vertices.back() = 2;
  CHECK(*meshes::keptHullOf(std::make_shared<const Mesh>(larger)) == meshes::hullOf(larger.vertices));
}

TEST_CASE("the hulls that were not used for longest are not kept") {
  const auto old = std::make_shared<const Mesh>(cube(true));
  const auto hull = meshes::keptHullOf(old);
  Mesh large = cube(true);
  large.triangles.resize(2'000'000);  // degenerate ones
  for (int i = 0; i < 3; ++i) {
    large.vertices.back() = 3 + i;
    meshes::keptHullOf(std::make_shared<const Mesh>(large));
  }
  CHECK(meshes::keptHullOf(old) != hull);
}

TEST_CASE("points in a plane have no hull") {
  Mesh flat = cube(true);
  for (std::size_t i = 2; i < flat.vertices.size(); i += 3) flat.vertices[i] = 0;
  CHECK_THROWS_AS(meshes::keptHullOf(std::make_shared<const Mesh>(flat)), Error);
}
