#include "../../plugins/physics/queries.h"

#include <random>
#include <thread>

#include "engine_world.h"

// Ray casts and overlap queries.

using namespace spark;
using namespace spark::test;

namespace {

engine::ShapeDescription meshBox(double edge) {
  const double h = edge / 2;
  engine::Mesh s;
  s.vertices = {-h, -h, -h, h, -h, -h, h, h, -h, -h, h, -h, -h, -h, h, h, -h, h, h, h, h, -h, h, h};
  s.triangles = {0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                 1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7};
  return {.shape = Shape::mesh, .mesh = std::make_shared<const engine::Mesh>(std::move(s))};
}

/// One body of each shape at a random pose.
struct Things : EngineWorld {
  std::mt19937 random{5};
  std::vector<GeomHandle> geoms;
  Things() : EngineWorld(kEngines[0]) {
    for (const engine::ShapeDescription& s :
         {engine::ShapeDescription{.shape = Shape::box, .lengths = {0.6, 0.9, 0.4}},
          engine::ShapeDescription{.shape = Shape::sphere, .radius = 0.4},
          engine::ShapeDescription{.shape = Shape::capsule, .radius = 0.2, .length = 0.7},
          engine::ShapeDescription{.shape = Shape::cylinder, .radius = 0.3, .length = 0.5}, meshBox(0.7)}) {
      const BodyHandle b = body(vector() + Vec3(0, 0, 2));
      world.setRotation(b, Eigen::Quaterniond(number(), number(), number(), number()).normalized().toRotationMatrix());
      geoms.push_back(geom(s, b, {0.3 * vector(), Mat3::Identity()}));
    }
    ground();
  }
  double number() { return std::uniform_real_distribution<double>(-1, 1)(random); }
  Vec3 vector() {
    const double x = number(), y = number(), z = number();
    return {x, y, z};
  }
  std::optional<physics::GeomHit> cast(const Vec3& from, const Vec3& direction, double length = 20) const {
    return physics::castRay(world.model(), world.state(), from, direction.normalized(), length, {});
  }
};

}  // namespace

TEST_CASE("a ray hits the same geom as ODE's ray hits first, at the same distance and with the same normal") {
  Things t;
  const GeomHandle probe = t.geom({.shape = Shape::ray, .length = 20});
  int met = 0;
  for (int i = 0; i < 400; ++i) {
    const Vec3 from = 5 * t.vector() + Vec3(0, 0, 6), direction = (t.vector() + Vec3(0, 0, 2) - from).normalized();
    t.world.setShape(probe, {.shape = Shape::ray, .length = 20, .rayOrigin = from, .rayDirection = direction});
    t.contacts.clear();
    t.stepper.detect(*t.engine, t.collision, nullptr, 16, t.contacts);
    const engine::Contact* first = nullptr;
    for (const engine::Contact& c : t.contacts)
      if ((c.geomA == t.world.index(probe) || c.geomB == t.world.index(probe)) && (!first || c.depth < first->depth))
        first = &c;
    const auto hit = t.cast(from, direction);
    CAPTURE(i);
    REQUIRE(hit.has_value() == (first != nullptr));
    if (!hit) continue;
    ++met;
    CHECK(hit->geom == (first->geomA == t.world.index(probe) ? first->geomB : first->geomA));
    CHECK(hit->distance == Approx(first->depth).margin(1e-9));
    CHECK(hit->normal.dot(direction) < 0);
    CHECK(std::abs(hit->normal.dot(first->normal)) == Approx(1).margin(1e-6));
  }
  CHECK(met > 200);
}

TEST_CASE("a ray from inside hits the surface where it exits, and no geom that is too far away or filtered out") {
  EngineWorld w(kEngines[0]);
  const BodyHandle b = w.block({0, 0, 1}, {2, 2, 2});
  const auto cast = [&](const Vec3& from, double length, const physics::Accepts& accepts = {}) {
    return physics::castRay(w.world.model(), w.world.state(), from, Vec3::UnitX(), length, accepts);
  };
  CHECK(cast({0.25, 0, 1}, 10)->distance == Approx(0.75));
  CHECK(cast({0.25, 0, 1}, 10)->normal == Vec3(-1, 0, 0));
  CHECK(cast({-3, 0, 1}, 2.01)->distance == Approx(2));
  CHECK_FALSE(cast({-3, 0, 1}, 1.99));
  CHECK_FALSE(cast({-3, 0, 2.01}, 10));
  CHECK_FALSE(cast({3, 0, 1}, 10));
  CHECK_FALSE(cast({-3, 0, 1}, 10, [](const engine::Geom&) { return false; }));
  w.world.setPosition(b, {0, 0, 5});  // a query uses current positions, before any step
  CHECK_FALSE(cast({-3, 0, 1}, 10));
}

TEST_CASE("a sphere overlaps the geoms that it touches in ODE") {
  Things t;
  const BodyHandle ball = t.body({0, 0, 0});
  const GeomHandle probe = t.geom({.shape = Shape::sphere, .radius = 0.3}, ball);
  int touched = 0;
  for (int i = 0; i < 300; ++i) {
    const Vec3 at = 1.5 * t.vector() + Vec3(0, 0, 1.6);
    t.world.setPosition(ball, at);
    t.contacts.clear();
    t.stepper.detect(*t.engine, t.collision, nullptr, 1, t.contacts);
    std::vector<engine::Index> expected, found;
    for (const engine::Contact& c : t.contacts)
      if (c.geomA == t.world.index(probe) || c.geomB == t.world.index(probe))
        expected.push_back(c.geomA == t.world.index(probe) ? c.geomB : c.geomA);
    std::sort(expected.begin(), expected.end());
    physics::findOverlaps(t.world.model(), t.world.state(), at, 0.3, found);
    std::erase(found, t.world.index(probe));
    CAPTURE(i);
    // ODE detects a mesh only from outside.
    for (std::vector<engine::Index>* list : {&expected, &found}) std::erase(*list, t.world.index(t.geoms[4]));
    CHECK(found == expected);
    touched += static_cast<int>(found.size());
  }
  CHECK(touched > 50);
}

TEST_CASE("several threads can make queries at once") {
  Things t;
  std::vector<double> sums(4, 0);
  {
    std::vector<std::jthread> threads;
    for (double& sum : sums)
      threads.emplace_back([&] {
        for (int i = 0; i < 500; ++i)
          if (const auto hit = t.cast({0, 0, 8}, {std::sin(i), std::cos(i), -3})) sum += hit->distance;
      });
  }
  for (const double sum : sums) CHECK(sum == sums[0]);
}
