#include <ode/ode.h>

#include <Eigen/Geometry>

#include "engine_fixture.h"

using namespace spark;
using namespace spark::test;
using engine::Shape;
using physics::BodyHandle;

namespace {

/// A heap of thirty things over the ground; the same each time.
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
    const std::size_t each = all.size() / bodies.size();
    for (std::size_t i = 0; i < bodies.size(); ++i) world.loadBody(bodies[i], std::span(all).subspan(i * each, each));
  }
};

}  // namespace

TEST_CASE("the same heap falls the same way twice, bit for bit") {
  Heap a, b;
  a.run(200);
  b.run(200);
  CHECK(a.saved() == b.saved());
  CHECK(a.position(a.bodies[5]).z() < 3);
}

TEST_CASE("a heap goes on bit for bit from a saved state, in the same house and in a new one, through sleep") {
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

TEST_CASE("sleeping is ODE's: a box dropped by plain ODE calls falls asleep in the same step at the same place") {
  EngineHost house;
  house.setGravity(9.81, true);
  house.geom(plane(0, 0, 1, 0));
  const BodyHandle b = house.body({0, 0, 0.6});
  house.geom(box(1, 1, 1), b);

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
    house.step(0.02);
    dContact c[4]{};
    const int n = dCollide(cube, ground, 4, &c[0].geom, sizeof(dContact));
    for (int k = 0; k < n; ++k) {
      c[k].surface.mu = dInfinity;
      dJointAttach(dJointCreateContact(world, group, &c[k]), plain, nullptr);
    }
    dWorldStep(world, 0.02);
    dJointGroupEmpty(group);
    REQUIRE(house.world.enabled(b) == bool(dBodyIsEnabled(plain)));
    REQUIRE(house.position(b).z() == dBodyGetPosition(plain)[2]);
    slept = slept || !house.world.enabled(b);
  }
  CHECK(slept);
  dJointGroupDestroy(group);
  dGeomDestroy(cube);
  dGeomDestroy(ground);
  dWorldDestroy(world);
}

TEST_CASE("worlds of two houses do not know of each other") {
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
