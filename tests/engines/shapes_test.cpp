#include "engine_world.h"

// Meshes, convex hulls and height fields. What is tested: bodies come to rest on them, at their surface, with each
// engine; an engine that lacks a shape says so (Capabilities).

using namespace spark;
using namespace spark::test;

namespace {

/// The corners of a box around the origin, and its triangles.
engine::Mesh cube(const Vec3& edges, const Vec3& middle = Vec3::Zero()) {
  engine::Mesh m;
  for (int i = 0; i < 8; ++i)
    for (int k = 0; k < 3; ++k) m.vertices.push_back(middle[k] + ((i >> k) & 1 ? 0.5 : -0.5) * edges[k]);
  m.triangles = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  return m;
}

/// A paraboloid of 1 m radius and 0.5 m height whose lowest point is the origin, open upwards.
engine::Mesh bowl() {
  constexpr int kRings = 12, kSectors = 24;
  engine::Mesh m{{0, 0, 0}, {}};
  const auto at = [](int ring, int sector) {
    return static_cast<std::uint32_t>(ring == 0 ? 0 : 1 + (ring - 1) * kSectors + sector % kSectors);
  };
  for (int ring = 1; ring <= kRings; ++ring)
    for (int sector = 0; sector < kSectors; ++sector) {
      const double r = double(ring) / kRings, angle = 2 * kPi * sector / kSectors;
      m.vertices.insert(m.vertices.end(), {r * std::cos(angle), r * std::sin(angle), r * r / 2});
    }
  for (int ring = 0; ring < kRings; ++ring)
    for (int sector = 0; sector < kSectors; ++sector) {
      m.triangles.insert(m.triangles.end(), {at(ring, sector), at(ring + 1, sector), at(ring + 1, sector + 1)});
      if (ring > 0)
        m.triangles.insert(m.triangles.end(), {at(ring, sector), at(ring + 1, sector + 1), at(ring, sector + 1)});
    }
  return m;
}

/// A height field whose heights are `height(x, y)`.
template <class F>
engine::ShapeDescription heights(int columns, int rows, double width, double depth, F height) {
  engine::HeightField f{columns, rows, width, depth, {}, 0, 0};
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column)
      f.heights.push_back(
          static_cast<float>(height(column * f.cellWidth() - width / 2, row * f.cellDepth() - depth / 2)));
  const auto [low, high] = std::minmax_element(f.heights.begin(), f.heights.end());
  f.low = *low, f.high = *high;
  return {.shape = Shape::heightField, .heightField = std::make_shared<const engine::HeightField>(std::move(f))};
}

engine::ShapeDescription hull(const Vec3& edges, const Vec3& middle = Vec3::Zero()) {
  return meshOf(cube(edges, middle), Shape::convex);
}

/// A body of 1 kg whose shape is as large as a cube of this edge.
BodyHandle thing(EngineWorld& w, const engine::ShapeDescription& shape, const Vec3& at, double edge) {
  const BodyHandle b = w.body(at, 1, Mat3::Identity() * (edge * edge / 6));
  w.geom(shape, b);
  return b;
}

/// MuJoCo 2.2.2 finds one point for a pair with a hull: what lies on it rocks.
bool rocks(const EngineWorld& w) { return std::string_view(w.kind.name) == "MujocoEngine"; }

bool takesMeshes(const EngineWorld& w, bool withBody) { return withBody ? w.can.bodyMeshes : w.can.meshes; }

}  // namespace

TEST_CASE("a convex hull rests flat on a plane, a box, a hull and a mesh, with each engine") {
  const engine::ShapeDescription floors[] = {
      {.shape = Shape::plane}, {.shape = Shape::box, .lengths = {2, 2, 1}}, hull({2, 2, 1}), meshOf(cube({2, 2, 1}))};
  for (int floor = 0; floor < 4; ++floor)
    withEngines(
        [&](EngineWorld& w) {
          CAPTURE(floor);
          w.geom(floors[floor], BodyHandle::none, {{0, 0, floor == 0 ? 0 : -0.5}, Mat3::Identity()});
          const BodyHandle b = thing(w, hull({0.4, 0.4, 0.4}), {0.11, -0.07, 0.21}, 0.4);
          w.run(3);
          CHECK(w.position(b).z() == Approx(0.2).margin(0.005));
          CHECK((w.position(b) - Vec3(0.11, -0.07, 0.2)).head<2>().norm() < 0.02);
          CHECK(w.world.state(b).rotation(2, 2) > 0.9995);
          CHECK(w.spin(b).norm() < (rocks(w) ? 0.8 : 0.05));
        },
        {&engine::Capabilities::rotation});
}

TEST_CASE("each shape rests on a convex hull, also on one whose origin is outside of it") {
  const engine::ShapeDescription shapes[] = {{.shape = Shape::box, .lengths = {0.4, 0.4, 0.4}},
                                             {.shape = Shape::sphere, .radius = 0.2},
                                             {.shape = Shape::capsule, .radius = 0.2, .length = 0.3},
                                             {.shape = Shape::cylinder, .radius = 0.2, .length = 0.4},
                                             hull({0.4, 0.4, 0.4})};
  for (const bool lying : {false, true})
    for (const auto& shape : shapes)
      withEngines(
          [&](EngineWorld& w) {
            CAPTURE(static_cast<int>(shape.shape), lying);
            w.geom(hull({2, 2, 1}, {7, 0, 0}), BodyHandle::none, {{-7, 0, -0.5}, Mat3::Identity()});
            const BodyHandle b = thing(w, shape, {0.05, 0.1, 0.205}, 0.4);
            if (lying)
              w.world.setRotation(b, Mat3(Eigen::AngleAxisd(kPi / 2, Vec3::UnitX())));
            else if (shape.shape == Shape::capsule)
              return;  // on its end it would fall over
            w.surface.mu = 1;
            w.run(2);
            CHECK(w.position(b).z() == Approx(0.2).margin(0.006));
            CHECK(w.spin(b).norm() < (rocks(w) ? 0.8 : 0.3));
          },
          {&engine::Capabilities::rotation});
}

TEST_CASE("each shape rests on a mesh of one, two or three triangles, also beside others without area") {
  const std::vector<double> corners = {-3, -3, 0, 3, -3, 0, 0, 4, 0, 0, 0, 0};
  const std::vector<std::uint32_t> floors[] = {
      {0, 1, 2}, {0, 1, 2, 0, 1, 2}, {0, 1, 3, 1, 2, 3}, {0, 1, 3, 1, 2, 3, 2, 0, 3}, {0, 1, 2, 3, 3, 3, 0, 0, 1}};
  const engine::ShapeDescription shapes[] = {{.shape = Shape::box, .lengths = {0.4, 0.4, 0.4}},
                                             {.shape = Shape::sphere, .radius = 0.2},
                                             {.shape = Shape::cylinder, .radius = 0.2, .length = 0.4},
                                             hull({0.4, 0.4, 0.4}),
                                             meshOf(cube({0.4, 0.4, 0.4}))};
  for (const auto& floor : floors)
    for (const auto& shape : shapes)
      withEngines(
          [&](EngineWorld& w) {
            CAPTURE(floor.size(), static_cast<int>(shape.shape));
            // Far from the origin, and sliding.
            w.geom(meshOf({corners, floor}), BodyHandle::none, {{40, -30, 10}, Mat3::Identity()});
            const BodyHandle b = thing(w, shape, {40.05, -30.9, 10.205}, 0.4);
            w.world.setLinearVelocity(b, {0.5, 0.5, 0});
            w.run(1);
            CHECK(w.position(b).z() == Approx(10.2).margin(0.012));
          },
          {&engine::Capabilities::rotation, &engine::Capabilities::meshes});
}

TEST_CASE("hulls stand on each other: a tower of five") {
  withEngines(
      [](EngineWorld& w) {
        w.ground();
        std::vector<BodyHandle> tower;
        for (int i = 0; i < 5; ++i) tower.push_back(thing(w, hull({0.4, 0.4, 0.4}), {0, 0, 0.2 + 0.4 * i}, 0.4));
        w.run(3);
        for (int i = 0; i < 5; ++i) {
          const Vec3 at = w.position(tower[static_cast<std::size_t>(i)]);
          CHECK(at.z() == Approx(0.2 + 0.4 * i).margin(rocks(w) ? 0.1 : 0.02));
          CHECK(at.head<2>().norm() < (rocks(w) ? 0.1 : 0.03));
        }
      },
      {&engine::Capabilities::rotation});
}

TEST_CASE("a sphere rolls to the lowest point of a bowl of triangles, unless the engine fills hollows") {
  withEngines(
      [](EngineWorld& w) {
        w.geom(meshOf(bowl()));
        const BodyHandle b = w.sphere({0.3, 0.1, 0.6}, 0.2);
        w.world.setDamping(b, 0.5, 0.02);
        w.run(8);
        if (takesMeshes(w, false)) {
          CHECK(w.position(b).z() == Approx(0.2).margin(0.02));
          CHECK(w.position(b).head<2>().norm() < 0.06);
        } else if (w.position(b).z() > 0) {
          CHECK(w.position(b).z() > 0.4);  // on the hull
        }
      },
      {&engine::Capabilities::rotation});
}

TEST_CASE("a bowl on a body is put over a sphere, unless the engine fills hollows") {
  withEngines(
      [](EngineWorld& w) {
        w.setGravity(0);
        w.geom({.shape = Shape::sphere, .radius = 0.2}, BodyHandle::none, {{0, 0, 0.25}, Mat3::Identity()});
        thing(w, meshOf(bowl()), {0, 0, 0}, 1);
        w.solve = false;
        w.touch();
        CHECK(w.contacts.empty() == takesMeshes(w, true));
      },
      {&engine::Capabilities::rotation});
}

TEST_CASE("each shape rests on a height field at the height of its surface") {
  const engine::ShapeDescription shapes[] = {{.shape = Shape::sphere, .radius = 0.2},
                                             {.shape = Shape::box, .lengths = {0.4, 0.4, 0.4}},
                                             {.shape = Shape::cylinder, .radius = 0.2, .length = 0.4},
                                             hull({0.4, 0.4, 0.4})};
  for (const auto& shape : shapes)
    withEngines(
        [&](EngineWorld& w) {
          CAPTURE(static_cast<int>(shape.shape));
          // Flat at 0.5 m around the middle, with a rim; turned, and moved.
          const auto rim = [](double x, double y) { return std::max(std::abs(x), std::abs(y)) > 3 ? 2.0 : 0.5; };
          w.geom(heights(21, 15, 10, 7, rim), BodyHandle::none,
                 {{4, -3, 1}, Mat3(Eigen::AngleAxisd(0.5, Vec3::UnitZ()))});
          const BodyHandle b = thing(w, shape, {4.1, -3.2, 1.71}, 0.4);
          w.surface.mu = 1;
          w.run(2);
          CHECK(w.position(b).z() == Approx(1.7).margin(0.006));
          CHECK(w.spin(b).norm() < 0.2);
        },
        {&engine::Capabilities::rotation, &engine::Capabilities::heightFields});
}

TEST_CASE("columns are along x, rows along y, and cells are split alike by engines and rays") {
  withEngines(
      [](EngineWorld& w) {
        const auto slope = [](double x, double y) { return 0.1 * x + 0.02 * y + (x * y > 0.1 ? 0.1 : 0); };
        const engine::ShapeDescription field = heights(9, 5, 4, 2, slope);
        w.geom(field);
        w.setGravity(0);
        w.solve = false;
        const BodyHandle b = w.sphere({0, 0, 9}, 0.01);
        // A small sphere touches the field where a ray meets it, and a bit higher it does not.
        for (const double x : {-1.4, -0.6, 0.15, 0.4, 1.1, 1.6})
          for (const double y : {-0.6, -0.3, 0.1, 0.35, 0.8}) {
            CAPTURE(x, y);
            const auto isField = [](const engine::Geom& g) { return g.body == engine::kNone; };
            const auto hit = physics::castRay(w.world.model(), w.world.state(), {x, y, 5}, -Vec3::UnitZ(), 10, isField);
            REQUIRE(hit);
            const auto touchesAt = [&](double above) {
              w.world.setPosition(b, {x, y, 5 - hit->distance + above});
              w.touch();
              return !w.contacts.empty();
            };
            CHECK(touchesAt(0.006));
            CHECK_FALSE(touchesAt(0.0165));
          }
      },
      {&engine::Capabilities::rotation, &engine::Capabilities::heightFields});
}
