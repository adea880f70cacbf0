#include "engine_world.h"

// What lies, stands, rolls on a static mesh, or falls onto it, as on a plane.

using namespace spark;
using namespace spark::test;

namespace {

/// A floor of 6 m by 4 m at z = 0 that looks up; of two sides: its lower side is cut along the other diagonal.
engine::ShapeDescription floorOf(int sides) {
  engine::Mesh m{.vertices = {-3, -2, 0, 3, -2, 0, 3, 2, 0, -3, 2, 0}, .triangles = {0, 1, 2, 0, 2, 3}};
  if (sides == 2) m.triangles.insert(m.triangles.end(), {3, 2, 1, 3, 1, 0});
  return meshOf(std::move(m));
}

struct Solid {
  const char* name;
  engine::ShapeDescription shape;
  double height;  ///< of its middle, where it stands [m]
};

std::vector<Solid> solids() {
  engine::Mesh block;
  for (int i = 0; i < 8; ++i)
    block.vertices.insert(block.vertices.end(), {i & 1 ? 0.15 : -0.15, i & 2 ? 0.1 : -0.1, i & 4 ? 0.1 : -0.1});
  block.triangles = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                     2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  return {{"cylinder", {.shape = Shape::cylinder, .radius = 0.1, .length = 0.2}, 0.1},
          {"flat cylinder", {.shape = Shape::cylinder, .radius = 0.2, .length = 0.1}, 0.05},
          {"box", {.shape = Shape::box, .lengths = {0.3, 0.2, 0.2}}, 0.1},
          {"hull", meshOf(std::move(block), Shape::convex), 0.1},
          {"sphere", {.shape = Shape::sphere, .radius = 0.1}, 0.1}};
}

constexpr double kMass = 2, kInertia = 0.01;  // kg, kg m^2: about that of each solid

struct Floor {
  EngineWorld& w;
  BodyHandle body;
  double before = HUGE_VAL, most = 0;  ///< energy at first, and the greatest since [J]
  Floor(EngineWorld& world, int sides, const engine::ShapeDescription& shape, const Vec3& at, const Mat3& rotation)
      : w(world) {
    w.geom(floorOf(sides));
    body = w.body(at, kMass, Mat3::Identity() * kInertia);
    w.world.setRotation(body, rotation);
    w.geom(shape, body);
  }
  double energy() const {
    return kMass * (9.81 * w.position(body).z() + w.velocity(body).squaredNorm() / 2) +
           kInertia * w.spin(body).squaredNorm() / 2;
  }
  void run(double seconds) {
    before = energy();
    for (int i = 0, n = static_cast<int>(std::lround(seconds / w.dt)); i < n; ++i) {
      w.run(w.dt);
      most = std::max(most, energy());
    }
  }
};

void onFloors(const std::function<void(EngineWorld&, int sides)>& f) {
  for (const int sides : {1, 2})
    withEngines(
        [&](EngineWorld& w) {
          INFO(sides << " sides");
          w.dt = 0.005;
          f(w, sides);
        },
        {&engine::Capabilities::rotation, &engine::Capabilities::meshes});
}

/// Along x.
const Mat3 kLying = Eigen::AngleAxisd(kPi / 2, Vec3::UnitY()).toRotationMatrix();

}  // namespace

TEST_CASE("solids that fall 1 m onto a floor of triangles stand where they fell") {
  for (const Solid& solid : solids())
    for (const Vec3& at : {Vec3(0.4, 0.1, 0), Vec3(-2.5, 1.6, 0), Vec3(1, 0.6667, 0)})
      onFloors([&](EngineWorld& w, int sides) {
        INFO(solid.name << " at " << at.transpose());
        Floor floor(w, sides, solid.shape, at + Vec3(0, 0, 1 + solid.height), Mat3::Identity());
        floor.run(2);
        CHECK((w.position(floor.body) - at - Vec3(0, 0, solid.height)).norm() < 0.005);
        CHECK(floor.most < floor.before * 1.01);
        CHECK(w.velocity(floor.body).norm() < 0.06);  // points of contact may change from step to step
      });
}

TEST_CASE("a cylinder lies still on a floor of triangles, also across the edge of two") {
  const engine::ShapeDescription cylinder{.shape = Shape::cylinder, .radius = 0.1, .length = 0.3};
  for (const Vec3& at : {Vec3(0.6, 0.4, 0.0999), Vec3(-2, 1, 0.0999)})
    onFloors([&](EngineWorld& w, int sides) {
      Floor floor(w, sides, cylinder, at, kLying);
      floor.run(2);
      CHECK((w.position(floor.body) - at).norm() < 0.005);
      CHECK(floor.most < floor.before + 0.01);
    });
}

TEST_CASE("a cylinder rolls across a floor of triangles, straight and level") {
  const engine::ShapeDescription cylinder{.shape = Shape::cylinder, .radius = 0.1, .length = 0.3};
  onFloors([&](EngineWorld& w, int sides) {
    Floor floor(w, sides, cylinder, {0.5, -1.5, 0.0999}, kLying);
    w.world.setLinearVelocity(floor.body, {0, 1, 0});
    w.world.setAngularVelocity(floor.body, {-10, 0, 0});
    floor.run(2.5);
    const Vec3 end = w.position(floor.body);
    CHECK(end.x() == Approx(0.5).margin(0.02));
    CHECK(end.y() == Approx(1).margin(0.15));
    CHECK(end.z() == Approx(0.1).margin(0.003));
    CHECK(w.velocity(floor.body).y() > 0.85);
    CHECK(floor.most < floor.before * 1.01);
  });
}

TEST_CASE("what touches a sheet of two sides from below is held there") {
  for (const Solid& solid : solids())
    withEngines(
        [&](EngineWorld& w) {
          INFO(solid.name);
          w.dt = 0.005;
          Floor floor(w, 2, solid.shape, {0.4, 0.1, -0.3 - solid.height}, Mat3::Identity());
          w.setGravity(-9.81);
          w.run(1);
          CHECK((w.position(floor.body) - Vec3(0.4, 0.1, -solid.height)).norm() < 0.005);
        },
        {&engine::Capabilities::rotation, &engine::Capabilities::meshes});
}
