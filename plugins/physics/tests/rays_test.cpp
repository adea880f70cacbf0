// Rays by the thousand: RayScene against queries that test every geom, and against a search that knows no rays.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <random>

#include "../ray_scene.h"
#include "../shape_ray.h"

using namespace spark;
using namespace spark::physics;
using engine::Shape;

namespace {

engine::ShapeDescription meshOf(engine::Mesh mesh, Shape shape = Shape::mesh) {
  return {.shape = shape, .mesh = std::make_shared<const engine::Mesh>(std::move(mesh))};
}

/// A scene of shapes at random poses that stand still.
struct RandomScene {
  std::mt19937 random;
  engine::Model model;
  engine::State state;

  explicit RandomScene(unsigned seed, int shapes) : random(seed) {
    for (int i = 0; i < shapes; ++i) add(randomShape());
    if (number(0, 1) < 0.3) add({.shape = Shape::plane, .plane = {number(-1, 1), number(-1, 1), 3, number(-9, -6)}});
  }
  double number(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); }
  Vec3 vector(double size) {
    const double x = number(-size, size), y = number(-size, size), z = number(-size, size);
    return {x, y, z};
  }
  Mat3 rotation() {
    const Vec3 v = vector(1);
    return Eigen::Quaterniond(number(-1, 1), v.x(), v.y(), v.z()).normalized().toRotationMatrix();
  }
  void add(const engine::ShapeDescription& shape) {
    engine::Geom g;
    g.id = model.geoms.size() + 1;
    g.shape = shape;
    g.offset = {vector(4), rotation()};
    model.geoms.push_back(g);
    ++model.structure;
  }
  engine::ShapeDescription randomShape() {
    switch (std::uniform_int_distribution<int>(0, 6)(random)) {
      case 0:
        return {.shape = Shape::box, .lengths = vector(1).cwiseAbs() + Vec3::Constant(0.05)};
      case 1:
        return {.shape = Shape::sphere, .radius = number(0.05, 1)};
      case 2:
        return {.shape = Shape::capsule, .radius = number(0.05, 0.5), .length = number(0.05, 2)};
      case 3:
        return {.shape = Shape::cylinder, .radius = number(0.05, 0.7), .length = number(0.05, 2)};
      case 4:
        return tetrahedron(Shape::mesh);
      case 5:
        return tetrahedron(Shape::convex);
      default:
        return hills();
    }
  }
  engine::ShapeDescription hills() {
    const auto edge = [this] { return std::uniform_int_distribution<int>(2, 7)(random); };
    engine::HeightField f{edge(), edge(), number(0.3, 3), number(0.3, 3), {}, 0, 0};
    for (int i = 0; i < f.columns * f.rows; ++i) f.heights.push_back(static_cast<float>(number(-0.3, 0.3)));
    const auto [low, high] = std::minmax_element(f.heights.begin(), f.heights.end());
    f.low = *low, f.high = *high;
    return {.shape = Shape::heightField, .heightField = std::make_shared<const engine::HeightField>(std::move(f))};
  }
  engine::ShapeDescription tetrahedron(Shape shape) {
    engine::Mesh s;
    for (const Vec3& corner : {Vec3(1, 1, 1), Vec3(1, -1, -1), Vec3(-1, 1, -1), Vec3(-1, -1, 1)}) {
      const Vec3 v = 0.6 * corner + vector(0.3);
      s.vertices.insert(s.vertices.end(), {v.x(), v.y(), v.z()});
    }
    s.triangles = {0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2};
    return meshOf(std::move(s), shape);
  }
  /// Distance from a point to the nearest surface [m]; 0 or less inside of a shape other than a mesh.
  double distanceToNearest(const Vec3& point) const {
    double nearest = HUGE_VAL;
    for (engine::Index i = 0; i < model.geoms.size(); ++i) {
      const Pose pose = poseOf(model, state, i);
      nearest =
          std::min(nearest, distanceTo(model.geoms[i].shape, pose.rotation.transpose() * (point - pose.position)));
    }
    return nearest;
  }
  /// The least distance to a surface on the way between two points [m], by steps that no surface can be within (Hart
  /// 1996, "Sphere tracing"); ends at 1e-9.
  double clearance(const Vec3& from, const Vec3& to) const {
    const double length = (to - from).norm();
    double least = HUGE_VAL;
    for (double t = 0; t < length && least > 1e-9;) {
      const double distance = distanceToNearest(from + t / length * (to - from));
      least = std::min(least, distance);
      t += std::max(distance, 1e-9);
    }
    return least;
  }
};

}  // namespace

TEST_CASE("RayScene finds the geom, the distance and the normal that a test of every geom finds", "[senses]") {
  RayScene rays;
  int hits = 0;
  for (unsigned seed = 0; seed < 300; ++seed) {
    RandomScene s(seed, 1 + static_cast<int>(seed % 60));
    rays.clear();  // the next model is at the same address
    rays.update(s.model, s.state, seed);
    for (int i = 0; i < 20; ++i) {
      const Vec3 from = s.vector(6), direction = i < 3 ? Vec3(Vec3::Unit(i)) : Vec3(s.vector(1).normalized());
      const double length = i % 4 == 0 ? HUGE_VAL : s.number(0, 12);
      const Accepts even = [](const engine::Geom& g) { return g.id % 2 == 0; };
      for (const Accepts& accepts : {Accepts(), even}) {
        const auto every = castRay(s.model, s.state, from, direction, length, accepts);
        const auto found = rays.castRay(from, direction, length, accepts);
        CAPTURE(seed, i);
        REQUIRE(found.has_value() == every.has_value());
        REQUIRE(rays.meets(from, direction, length, accepts) == every.has_value());
        if (!every) continue;
        ++hits;
        CHECK(found->geom == every->geom);
        CHECK(found->distance == every->distance);
        CHECK(found->normal == every->normal);
      }
    }
  }
  CHECK(hits > 1000);
}

TEST_CASE("RayScene meets the edge of two triangles as a test of every triangle does", "[senses]") {
  RandomScene s(1, 0);
  // A square fan around the origin of slanted triangles, with all of its edges along the axes.
  engine::Mesh fan{{0, 0, 1}, {}};
  for (int i = 0; i < 16; ++i)
    for (const double v : {std::cos(kPi * i / 8), std::sin(kPi * i / 8), i % 2 == 0 ? 0.0 : 0.5})
      fan.vertices.push_back(v);
  for (std::uint32_t i = 0; i < 16; ++i)
    fan.triangles.insert(fan.triangles.end(), {0, 1 + (i * 5) % 16, 1 + (i * 5 + 1) % 16});
  s.add(meshOf(fan));
  s.model.geoms[0].offset = {Vec3::Zero(), Mat3::Identity()};
  RayScene rays;
  rays.update(s.model, s.state, 1);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 to(i % 2 == 0 ? 0 : s.number(-1, 1), i % 3 == 0 ? 0 : s.number(-1, 1), 3);
    const auto every = castRay(s.model, s.state, to, -Vec3::UnitZ(), 10, {});
    const auto found = rays.castRay(to, -Vec3::UnitZ(), 10, {});
    REQUIRE(found.has_value() == every.has_value());
    if (every) CHECK((found->distance == every->distance && found->normal == every->normal));
  }
}

TEST_CASE("a triangle without area is as far as its edges", "[senses]") {
  const engine::Mesh flat{{0, 0, 0, 1, 0, 0, 2, 0, 0}, {0, 1, 2}}, point{{0, 0, 0, 1, 0, 0, 2, 0, 0}, {1, 1, 1}};
  CHECK(distanceTo(meshOf(flat), {0.5, 3, 0}) == Approx(3));
  CHECK(distanceTo(meshOf(flat), {3, 0, 0}) == Approx(1));
  CHECK(distanceTo(meshOf(point), {1, 0, 2}) == Approx(2));
}

TEST_CASE("RayScene finds the overlaps that a test of every geom finds, in the same order", "[senses]") {
  RayScene rays;
  std::size_t touched = 0;
  for (unsigned seed = 0; seed < 300; ++seed) {
    RandomScene s(seed, static_cast<int>(seed % 60));
    rays.clear();
    rays.update(s.model, s.state, seed);
    for (int i = 0; i < 20; ++i) {
      const Vec3 center = s.vector(5);
      const double radius = i == 0 ? 0 : i == 1 ? -0.1 : i == 2 ? HUGE_VAL : s.number(0, 2);
      std::vector<engine::Index> every{7}, found{7};  // both append
      findOverlaps(s.model, s.state, center, radius, every);
      rays.findOverlaps(center, radius, found);
      CAPTURE(seed, i);
      CHECK(found == every);
      touched += found.size() - 1;
    }
  }
  CHECK(touched > 10000);
}

TEST_CASE("what rays call hidden in 10,000 random scenes is what a search without rays calls hidden", "[senses]") {
  RayScene rays;
  int hidden = 0, compared = 0, grazed = 0;
  for (unsigned seed = 0; compared < 10000; ++seed) {
    RandomScene s(seed, 20);
    const Vec3 eye = s.vector(4), point = s.vector(4);
    // Both are outside of all shapes, as an eye is.
    rays.clear();
    rays.update(s.model, s.state, seed);
    if (s.distanceToNearest(eye) < 0.01 || s.distanceToNearest(point) < 0.01) continue;
    ++compared;
    const double clearance = s.clearance(eye, point);
    const bool met = rays.meets(eye, (point - eye).normalized(), (point - eye).norm(), {});
    if (met != (clearance <= 1e-8)) {
      // A ray that only touches a surface, to the digits of the search, is neither.
      CAPTURE(seed, clearance, met);
      REQUIRE(clearance < 1e-6);
      ++grazed;
    }
    hidden += met;
  }
  WARN(hidden << " of " << compared << " points are hidden, " << grazed << " rays graze a surface within 1 um");
  CHECK(hidden > 1000);
  CHECK(hidden < 8000);
  CHECK(grazed == 0);
}

TEST_CASE("RayScene follows bodies, changed shapes and removed geoms", "[senses]") {
  RandomScene s(1, 0);
  s.add({.shape = Shape::sphere, .radius = 0.5});
  s.model.geoms[0].offset = {{3, 0, 0}, Mat3::Identity()};
  RayScene rays;
  const auto distance = [&](std::uint64_t poses) {
    rays.update(s.model, s.state, poses);
    const auto hit = rays.castRay(Vec3::Zero(), Vec3::UnitX(), 10, {});
    return hit ? hit->distance : -1;
  };
  CHECK(distance(1) == Approx(2.5));
  s.model.geoms[0].offset.position.x() = 5;
  CHECK(rays.isCurrent(s.model, 1));
  CHECK_FALSE(rays.isCurrent(s.model, 2));
  CHECK(distance(2) == Approx(4.5));
  s.model.geoms[0].shape = s.tetrahedron(Shape::mesh);
  ++s.model.collision;
  CHECK_FALSE(rays.isCurrent(s.model, 2));
  CHECK(distance(2) == Approx(castRay(s.model, s.state, Vec3::Zero(), Vec3::UnitX(), 10, {})->distance));
  s.model.geoms[0].collides = false;
  ++s.model.collision;
  CHECK(distance(2) == -1);
  s.model.geoms.clear();
  ++s.model.structure;
  CHECK(distance(2) == -1);
}

TEST_CASE("A cone hears each geom at its nearest point: no ray in the cone meets it nearer", "[senses]") {
  RandomScene s(7, 60);
  RayScene rays;
  rays.update(s.model, s.state, 1);
  int heardInAll = 0;
  for (int k = 0; k < 12; ++k) {
    const double angle = s.number(0.05, k % 4 == 3 ? 3.1 : 1.2);
    const Cone cone{s.vector(4), s.vector(1).normalized(), std::cos(angle), std::sin(angle), s.number(2, 8)};
    const Vec3 right = cone.axis.unitOrthogonal(), up = cone.axis.cross(right);
    for (std::size_t i = 0; i < s.model.geoms.size(); ++i) {
      const engine::Geom& geom = s.model.geoms[i];
      const Accepts alone = [&](const engine::Geom& g) { return &g == &geom; };
      std::vector<RayScene::GeomEcho> heard;
      rays.listen(cone, 0, alone, heard);
      REQUIRE(heard.size() <= 1);
      heardInAll += static_cast<int>(heard.size());
      const Pose pose = poseOf(s.model, s.state, static_cast<engine::Index>(i));
      const double gap = distanceTo(geom.shape, pose.rotation.transpose() * (cone.apex - pose.position));
      INFO("cone " << k << ", geom " << i << ", shape " << int(geom.shape.shape) << ", away " << gap);
      if (!heard.empty()) CHECK(heard[0].distance >= gap - 1e-9);
      double nearest = HUGE_VAL;
      for (int ray = 0; ray < 300; ++ray) {
        const double aside = angle * std::sqrt((ray + 0.5) / 300), around = 2.399963 * ray;
        const Vec3 direction =
            std::cos(aside) * cone.axis + std::sin(aside) * (std::cos(around) * right + std::sin(around) * up);
        if (const auto hit = rays.castRay(cone.apex, direction, cone.range, alone))
          nearest = std::min(nearest, hit->distance);
      }
      if (nearest == HUGE_VAL) continue;
      REQUIRE(heard.size() == 1);
      CHECK(heard[0].distance <= nearest + 1e-3);  // round sides are prisms
    }
  }
  CHECK(heardInAll > 40);
}

TEST_CASE("A cone hears what contains its apex, and what is seen only beside what hides its nearest point",
          "[senses]") {
  RandomScene s(1, 0);
  s.add({.shape = Shape::box, .lengths = {1, 1, 1}});
  s.model.geoms[0].offset = {};
  s.add({.shape = Shape::box, .lengths = {3, 0.1, 0.3}});
  s.model.geoms[1].offset = {{0, 10, 0}, Mat3::Identity()};
  s.add({.shape = Shape::cylinder, .radius = 0.01, .length = 2});  // a thin post behind a low board
  s.model.geoms[2].offset = {{0.123, 11, 0}, Mat3::Identity()};
  RayScene rays;
  rays.update(s.model, s.state, 1);
  std::vector<RayScene::GeomEcho> heard;
  rays.listen({Vec3::Zero(), Vec3::UnitY(), std::cos(0.5), std::sin(0.5), 5}, 3, {}, heard);
  REQUIRE(heard.size() == 1);
  CHECK(heard[0].distance == 0);
  heard.clear();
  rays.listen({{0, 8, 0}, Vec3::UnitY(), std::cos(0.3), std::sin(0.3), 5}, 0, {}, heard);
  REQUIRE(heard.size() == 2);
  CHECK(heard[0].distance == Approx(1.95));
  CHECK(heard[1].geom == 2);
  CHECK(heard[1].distance > 3);
  CHECK(heard[1].distance < 3.1);
}
