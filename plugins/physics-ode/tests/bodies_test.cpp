#include <ode/ode.h>

#include <Eigen/Geometry>

#include "engine_fixture.h"

using namespace spark;
using namespace spark::test;
using physics::BodyHandle;

TEST_CASE("a falling body is where the solver's integration puts it, and near where physics does") {
  EngineHost house;
  house.setGravity(9.81);
  const BodyHandle b = house.body({0, 0, 100});
  const double dt = 0.001;
  for (int i = 0; i < 1000; ++i) house.step(dt);
  // Semi-implicit Euler: z = z0 - g dt^2 n (n + 1) / 2.
  CHECK(house.position(b).z() == Approx(100 - 9.81 * dt * dt * 1000 * 1001 / 2).epsilon(1e-12));
  CHECK(house.position(b).z() == Approx(100 - 9.81 / 2).epsilon(1e-4));
  CHECK(house.world.state(b).linearVelocity.z() == Approx(-9.81).epsilon(1e-9));
}

TEST_CASE("a force acts for one step, in proportion to mass") {
  EngineHost house;
  house.setGravity(0);
  const BodyHandle b = house.body({0, 0, 0});
  house.world.setMass(b, {2.0, Vec3::Zero(), Mat3::Identity() * 0.5});
  house.world.addForce(b, {4, 0, 0});
  house.world.addTorque(b, {0, 0, 1});
  CHECK(house.world.force(b).x() == 4);
  house.step(0.1);
  CHECK(house.world.state(b).linearVelocity.x() == Approx(0.2));
  CHECK(house.world.state(b).angularVelocity.z() == Approx(0.2));
  CHECK(house.world.force(b).isZero(0));
  house.step(0.1);
  CHECK(house.world.state(b).linearVelocity.x() == Approx(0.2));
}

TEST_CASE("gravity can be taken from one body") {
  EngineHost house;
  house.setGravity(9.81);
  const BodyHandle light = house.body({0, 0, 1}), heavy = house.body({3, 0, 1});
  house.world.setGravityMode(light, false);
  house.step();
  CHECK(house.position(light).z() == 1);
  CHECK(house.position(heavy).z() < 1);
}

TEST_CASE("masses that no body can have are refused with a sentence") {
  EngineHost house;
  const BodyHandle b = house.body({0, 0, 0});
  CHECK_THROWS_WITH(house.world.setMass(b, {0, Vec3::Zero(), Mat3::Identity()}), Catch::Contains("mass above 0 kg"));
  CHECK_THROWS_WITH(house.world.setMass(b, {1, Vec3(0.1, 0, 0), Mat3::Identity()}), Catch::Contains("centre of mass"));
  CHECK_THROWS_WITH(house.world.setMass(b, {1, Vec3::Zero(), -Mat3::Identity()}), Catch::Contains("positive definite"));
  CHECK_THROWS_WITH(house.world.setMass(b, {std::nan(""), Vec3::Zero(), Mat3::Identity()}), Catch::Contains("finite"));
}

TEST_CASE("numbers that are none do not get into a body") {
  EngineHost house;
  house.setGravity(0);
  const BodyHandle b = house.body({1, 2, 3});
  const double nan = std::nan(""), inf = HUGE_VAL;
  house.world.setPosition(b, {nan, 0, 0});
  house.world.setRotation(b, Mat3::Constant(inf));
  house.world.setRotation(b, Mat3::Zero());
  house.world.setLinearVelocity(b, {inf, 0, 0});
  house.world.setAngularVelocity(b, {0, nan, 0});
  house.world.addForce(b, {nan, 0, 0});
  house.world.addTorque(b, {0, 0, inf});
  house.step();
  CHECK(house.position(b) == Vec3(1, 2, 3));
  CHECK(house.world.repaired().empty());
}

TEST_CASE("a body that flies apart is put back to its last good pose, at rest, and named once") {
  EngineHost house;
  house.setGravity(0);
  const BodyHandle bad = house.body({1, 2, 3}), good = house.body({5, 0, 0});
  house.world.setLinearVelocity(bad, {1, 0, 0});
  house.step(0.5);
  CHECK(house.position(bad).x() == 1.5);
  house.world.addForce(bad, {1e300, 0, 0});
  house.world.addForce(bad, {1e308, 0, 0});
  house.step(0.5);
  REQUIRE(house.world.repaired().size() == 1);
  CHECK(house.world.repaired()[0] == bad);
  CHECK(house.position(bad) == Vec3(1.5, 2, 3));
  CHECK(house.world.state(bad).linearVelocity.isZero(0));
  house.step(0.5);
  CHECK(house.world.repaired().empty());
  CHECK(house.position(good) == Vec3(5, 0, 0));
}

TEST_CASE("no force is so large that it ends the process, to the last digit or not") {
  for (const double most : {1e39, 1e155, 1e308})
    for (const bool exact : {false, true}) {
      INFO(most << (exact ? ", exact" : ""));
      EngineHost house(exact);
      const BodyHandle a = house.world.createBody(), b = house.world.createBody(), other = house.world.createBody();
      for (const BodyHandle body : {a, b, other}) {
        house.world.setMass(body, {1, Vec3::Zero(), Mat3::Identity()});
        house.world.setGravityMode(body, false);
      }
      const physics::JointHandle joint = house.world.createJoint(engine::JointType::hinge);
      house.world.attach(joint, a, b);
      house.world.setAxis(joint, 0, Vec3::UnitX());
      const auto step = [&] {
        house.step();
        CHECK(house.position(a).isZero(0));
        CHECK(house.world.state(a).rotation.allFinite());
      };
      house.world.addTorque(a, {most, most, most});
      house.world.addTorque(a, {most, most, most});
      step();
      house.world.setParameter(joint, engine::JointParameter::maxForce, 0, most);
      house.world.setParameter(joint, engine::JointParameter::velocity, 0, most);
      step();
      CHECK(house.position(other).isZero(0));
    }
}

TEST_CASE("a body at rest on the ground falls asleep after ten steps, and not in mid-air") {
  EngineHost house;
  house.setGravity(9.81, true);
  house.geom(plane(0, 0, 1, 0));
  const BodyHandle b = house.body({0, 0, 0.4995}), floating = house.body({5, 0, 5});
  house.world.setGravityMode(floating, false);
  house.geom(box(1, 1, 1), b);
  int steps = 0;
  while (house.world.enabled(b) && steps < 200) house.step(), ++steps;
  CHECK(steps >= 10);
  CHECK_FALSE(house.world.enabled(b));
  CHECK(house.world.enabled(floating));
  CHECK(house.world.state(b).linearVelocity.isZero(0));
  house.world.setEnabled(b, true);
  house.step();
  CHECK(house.world.enabled(b));
}

TEST_CASE("drag slows what moves, and leaves what sleeps alone") {
  EngineHost house;
  const BodyHandle moving = house.body({0, 0, 5}), asleep = house.body({9, 0, 5});
  for (const BodyHandle b : {moving, asleep}) {
    house.world.setLinearVelocity(b, {2, 0, -1});
    house.world.setAngularVelocity(b, {0, 3, 0});
  }
  house.world.setEnabled(asleep, false);
  for (const BodyHandle b : {moving, asleep}) house.world.addDrag(b, 0.5, 0.25);
  CHECK(house.world.force(moving) == Vec3(-1, 0, 0.5));
  CHECK(house.world.torque(moving) == Vec3(0, -0.75, 0));
  CHECK(house.world.force(asleep).isZero(0));
  CHECK_FALSE(house.world.enabled(asleep));
}

TEST_CASE("the plugin stays while an engine lives, and goes afterwards") {
  House house;
  house.kernel.plugins().use("physics-ode");
  Leaf& engine = house.kernel.create("OdeEngine", "/sys/engine");
  CHECK_THROWS_WITH(house.kernel.plugins().unload("physics-ode"), Catch::Contains("/sys/engine"));
  engine.parent()->remove(engine);
  house.kernel.plugins().unload("physics-ode");
  CHECK(house.kernel.findClass("OdeEngine") == nullptr);
}

TEST_CASE("ODE is closed with the last engine, and its messages have no handler that could be gone") {
  {
    EngineHost one;
    const EngineHost other;
    CHECK(dGetErrorHandler() != nullptr);
  }
  CHECK(dGetErrorHandler() == nullptr);
  CHECK(dGetMessageHandler() == nullptr);
  CHECK(dGetDebugHandler() == nullptr);
}

TEST_CASE("a body that is turned by its own rotation again and again keeps right angles") {
  EngineHost house;
  house.setGravity(0);
  const BodyHandle b = house.body({0, 0, 0});
  Mat3 tilted = Eigen::AngleAxisd(0.3, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  tilted(1, 2) += 1e-7;  // as single precision leaves it
  house.world.setRotation(b, tilted);
  for (int i = 0; i < 300; ++i) {
    const Mat3 r = house.world.state(b).rotation;
    house.world.setRotation(b, tilted * r.transpose() * r);
  }
  const Mat3 r = house.world.state(b).rotation;
  CHECK((r * r.transpose() - Mat3::Identity()).cwiseAbs().maxCoeff() < 1e-4);
  CHECK((r - tilted).cwiseAbs().maxCoeff() < 1e-3);
}

TEST_CASE("a body that flies away is put back before the space's cells end") {
  for (const bool exact : {false, true}) {
    CAPTURE(exact);
    EngineHost house(exact);
    for (int i = 0; i < 2; ++i) {
      const BodyHandle b = house.body({1.0 * i, 0, 0});
      house.geom(round(engine::Shape::sphere, 0.01), b);
      house.world.setLinearVelocity(b, {9e7, 0, 0});
    }
    for (int i = 0; i < 200; ++i) house.step();
    CHECK(house.position(house.world.createBody()).isZero(0));  // it still lives
  }
}

TEST_CASE("exact replay rounds every component of what crosses the engine, and nothing else does") {
  const Vec3 v(0.1, 0.2, 0.3), rounded = v.cast<float>().eval().cast<double>();
  REQUIRE(rounded != v);
  for (const bool exact : {false, true}) {
    CAPTURE(exact);
    EngineHost house(exact);
    const BodyHandle b = house.world.createBody();
    house.world.addForce(b, v);
    house.world.addTorque(b, v);
    const Vec3& wanted = exact ? rounded : v;
    for (int i = 0; i < 3; ++i) {
      CHECK(house.world.force(b)[i] == wanted[i]);
      CHECK(house.world.torque(b)[i] == wanted[i]);
    }
    const physics::JointHandle hinge = house.world.createJoint(engine::JointType::hinge);
    house.world.attach(hinge, b, BodyHandle::none);
    house.world.setAnchor(hinge, v);  // the body is at 0: the anchor is returned as it was stored
    for (int i = 0; i < 3; ++i) CHECK(house.world.anchor(hinge)[i] == wanted[i]);
  }
}
