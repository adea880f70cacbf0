#include <ode/ode.h>

#include <Eigen/Geometry>

#include "engine_fixture.h"

using namespace spark;
using namespace spark::test;
using engine::Shape;
using physics::BodyHandle;

namespace {

/// A heap of thirty bodies above the ground, always built in the same way.
struct Heap : EngineHost {
  std::vector<BodyHandle> bodies;
  explicit Heap(bool autoDisable = true) {
    setGravity(9.81, autoDisable);
    geom(plane(0, 0, 1, 0));
    for (int i = 0; i < 30; ++i) {
      const BodyHandle b = body({0.13 * (i % 3), 0.17 * (i % 2), 0.6 + 0.55 * i});
      world.setRotation(b, Mat3(Eigen::AngleAxisd(0.3 * i, Vec3(1, 2, 3).normalized())));
      world.setMass(b, {1.0, Vec3::Zero(), Mat3::Identity() * 0.05});
      const engine::ShapeDescription shapes[] = {box(0.5, 0.4, 0.3), round(Shape::sphere, 0.25),
                                                 round(Shape::capsule, 0.15, 0.3), round(Shape::cylinder, 0.2, 0.3)};
      geom(shapes[i % 4], b);
      bodies.push_back(b);
    }
  }
  void run(int steps) {
    engine::Surface s;
    s.softErpOn = s.slipOn = true;
    s.softErp = 0.4;
    s.slip1 = s.slip2 = 0.005;
    for (int i = 0; i < steps; ++i) step(0.02, s);
  }
  std::vector<double> saved() const {
    std::vector<double> out;
    for (const BodyHandle b : bodies) world.saveBody(b, out);
    return out;
  }
  void load(const std::vector<double>& all) {
    // Bodies that have moved have their rotation from their quaternion, so they are saved in equally many numbers.
    const std::size_t each = all.size() / bodies.size();
    for (std::size_t i = 0; i < bodies.size(); ++i) world.loadBody(bodies[i], std::span(all).subspan(i * each, each));
  }
};

}  // namespace

TEST_CASE("two equal heaps fall in the same way, bit for bit") {
  Heap a, b;
  a.run(200);
  b.run(200);
  CHECK(a.saved() == b.saved());
  CHECK(a.position(a.bodies[5]).z() < 3);
}

TEST_CASE("a restored heap continues bit for bit, in the same kernel and in a new one, also through sleep") {
  Heap a;
  a.run(60);
  const auto middle = a.saved();
  a.run(400);
  const auto end = a.saved();
  REQUIRE(middle != end);
  Heap b;
  b.run(7);  // another history
  b.load(middle);
  CHECK(b.saved() == middle);
  b.run(400);
  CHECK(b.saved() == end);
  a.load(middle);
  a.run(400);
  CHECK(a.saved() == end);
  CHECK_THROWS_WITH(a.world.loadBody(a.bodies[0], std::span(middle).subspan(0, 5)),
                    Catch::Contains("saved state, found 5"));
}

TEST_CASE("a dropped box falls asleep in the same step and position as with plain ODE calls") {
  EngineHost host;
  host.setGravity(9.81, true);
  host.geom(plane(0, 0, 1, 0));
  const BodyHandle b = host.body({0, 0, 0.6});
  host.geom(box(1, 1, 1), b);

  const dWorldID world = dWorldCreate();
  dWorldSetGravity(world, 0, 0, -9.81);
  dWorldSetCFM(world, 1e-5);
  dWorldSetERP(world, 0.2);
  dWorldSetContactSurfaceLayer(world, 0.001);
  dWorldSetAutoDisableFlag(world, 1);
  const dBodyID plain = dBodyCreate(world);
  dBodySetPosition(plain, 0, 0, 0.6);
  const dGeomID cube = dCreateBox(nullptr, 1, 1, 1), ground = dCreatePlane(nullptr, 0, 0, 1, 0);
  dGeomSetBody(cube, plain);
  const dJointGroupID group = dJointGroupCreate(0);
  bool slept = false;
  for (int i = 0; i < 300; ++i) {
    host.step(0.02);
    dContact c[4]{};
    const int n = dCollide(cube, ground, 4, &c[0].geom, sizeof(dContact));
    for (int k = 0; k < n; ++k) {
      c[k].surface.mu = dInfinity;
      dJointAttach(dJointCreateContact(world, group, &c[k]), plain, nullptr);
    }
    dWorldStep(world, 0.02);
    dJointGroupEmpty(group);
    REQUIRE(host.world.enabled(b) == bool(dBodyIsEnabled(plain)));
    REQUIRE(host.position(b).z() == dBodyGetPosition(plain)[2]);
    slept = slept || !host.world.enabled(b);
  }
  CHECK(slept);
  dJointGroupDestroy(group);
  dGeomDestroy(cube);
  dGeomDestroy(ground);
  dWorldDestroy(world);
}

TEST_CASE("worlds in different kernels do not affect each other") {
  Heap a;
  a.run(30);
  {
    Heap b;
    b.run(10);
  }
  a.run(30);
  Heap c;
  c.run(60);
  CHECK(a.saved() == c.saved());
}
