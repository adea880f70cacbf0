#include <ode/ode.h>

#include <Eigen/Geometry>

#include "engine_fixture.h"

using namespace spark;
using namespace spark::test;
using engine::Body;

TEST_CASE("a falling body is where the solver's integration puts it, and near where physics does") {
  EngineHouse house;
  house.setGravity(9.81);
  const Body b = house.body({0, 0, 100});
  const double dt = 0.001;
  for (int i = 0; i < 1000; ++i) house.step(dt);
  // Semi-implicit Euler: z = z0 - g dt^2 n (n + 1) / 2.
  CHECK(house.position(b).z() == Approx(100 - 9.81 * dt * dt * 1000 * 1001 / 2).epsilon(1e-12));
  CHECK(house.position(b).z() == Approx(100 - 9.81 / 2).epsilon(1e-4));
  CHECK(house.ode.state(b).linearVelocity.z() == Approx(-9.81).epsilon(1e-9));
}

TEST_CASE("a force acts for one step, in proportion to mass") {
  EngineHouse house;
  house.setGravity(0);
  const Body b = house.body({0, 0, 0});
  house.ode.setMass(b, {2.0, Vec3::Zero(), Mat3::Identity() * 0.5});
  house.ode.addForce(b, {4, 0, 0});
  house.ode.addTorque(b, {0, 0, 1});
  CHECK(house.ode.force(b).x() == 4);
  house.step(0.1);
  CHECK(house.ode.state(b).linearVelocity.x() == Approx(0.2));
  CHECK(house.ode.state(b).angularVelocity.z() == Approx(0.2));
  CHECK(house.ode.force(b).isZero(0));
  house.step(0.1);
  CHECK(house.ode.state(b).linearVelocity.x() == Approx(0.2));
}

TEST_CASE("gravity can be taken from one body") {
  EngineHouse house;
  house.setGravity(9.81);
  const Body light = house.body({0, 0, 1}), heavy = house.body({3, 0, 1});
  house.ode.setGravityMode(light, false);
  house.step();
  CHECK(house.position(light).z() == 1);
  CHECK(house.position(heavy).z() < 1);
}

TEST_CASE("masses that no body can have are refused with a sentence") {
  EngineHouse house;
  const Body b = house.body({0, 0, 0});
  CHECK_THROWS_WITH(house.ode.setMass(b, {0, Vec3::Zero(), Mat3::Identity()}), Catch::Contains("mass above 0 kg"));
  CHECK_THROWS_WITH(house.ode.setMass(b, {1, Vec3(0.1, 0, 0), Mat3::Identity()}), Catch::Contains("centre of mass"));
  CHECK_THROWS_WITH(house.ode.setMass(b, {1, Vec3::Zero(), -Mat3::Identity()}), Catch::Contains("positive definite"));
  CHECK_THROWS_WITH(house.ode.setMass(b, {std::nan(""), Vec3::Zero(), Mat3::Identity()}), Catch::Contains("finite"));
}

TEST_CASE("numbers that are none do not get into a body") {
  EngineHouse house;
  house.setGravity(0);
  const Body b = house.body({1, 2, 3});
  const double nan = std::nan(""), inf = HUGE_VAL;
  house.ode.setPosition(b, {nan, 0, 0});
  house.ode.setRotation(b, Mat3::Constant(inf));
  house.ode.setRotation(b, Mat3::Zero());
  house.ode.setLinearVelocity(b, {inf, 0, 0});
  house.ode.setAngularVelocity(b, {0, nan, 0});
  house.ode.addForce(b, {nan, 0, 0});
  house.ode.addTorque(b, {0, 0, inf});
  house.ode.setForce(b, {nan, 0, 0});
  house.ode.setTorque(b, {0, 0, inf});
  house.step();
  CHECK(house.position(b) == Vec3(1, 2, 3));
  CHECK(house.ode.repaired(house.world).empty());
}

TEST_CASE("a body that flies apart is put back to its last good pose, at rest, and named once") {
  EngineHouse house;
  house.setGravity(0);
  const Body bad = house.body({1, 2, 3}), good = house.body({5, 0, 0});
  house.ode.setLinearVelocity(bad, {1, 0, 0});
  house.step(0.5);
  CHECK(house.position(bad).x() == 1.5);
  house.ode.addForce(bad, {1e300, 0, 0});
  house.ode.addForce(bad, {1e308, 0, 0});
  house.step(0.5);
  REQUIRE(house.ode.repaired(house.world).size() == 1);
  CHECK(house.ode.repaired(house.world)[0] == bad);
  CHECK(house.position(bad) == Vec3(1.5, 2, 3));
  CHECK(house.ode.state(bad).linearVelocity.isZero(0));
  house.step(0.5);
  CHECK(house.ode.repaired(house.world).empty());
  CHECK(house.position(good) == Vec3(5, 0, 0));
}

TEST_CASE("no force is so large that it ends the process, to the last digit or not") {
  for (const double most : {1e39, 1e155, 1e308})
    for (const bool exact : {false, true}) {
      INFO(most << (exact ? ", exact" : ""));
      EngineHouse house;
      setProperty(house.kernel.root().require<Leaf>("/sys/server/physics/engine"), "exactReplay", exact);
      const engine::World world = house.ode.createWorld();
      const Body a = house.ode.createBody(world), b = house.ode.createBody(world), other = house.ode.createBody(world);
      for (const Body body : {a, b, other}) {
        house.ode.setMass(body, {1, Vec3::Zero(), Mat3::Identity()});
        house.ode.setGravityMode(body, false);
      }
      const engine::Joint joint = house.ode.createJoint(world, engine::JointType::hinge);
      house.ode.attach(joint, a, b);
      house.ode.setAxis(joint, 0, Vec3::UnitX());
      engine::Contacts none;
      const auto step = [&] {
        house.ode.step(world, none, 0.02);
        CHECK(house.ode.state(a).position.isZero(0));
        CHECK(house.ode.state(a).rotation.allFinite());
      };
      house.ode.addTorque(a, {most, most, most});
      house.ode.addTorque(a, {most, most, most});
      step();
      house.ode.setTorque(a, {most, 0, 0});
      step();
      house.ode.setParameter(joint, engine::JointParameter::maxForce, 0, most);
      house.ode.setParameter(joint, engine::JointParameter::velocity, 0, most);
      step();
      CHECK(house.ode.state(other).position.isZero(0));
    }
}

TEST_CASE("a body at rest on the ground falls asleep after ten steps, and not in mid-air") {
  EngineHouse house;
  house.setGravity(9.81, true);
  house.geom(plane(0, 0, 1, 0));
  const Body b = house.body({0, 0, 0.4995}), floating = house.body({5, 0, 5});
  house.ode.setGravityMode(floating, false);
  house.geom(box(1, 1, 1), b);
  int steps = 0;
  while (house.ode.enabled(b) && steps < 200) house.step(), ++steps;
  CHECK(steps >= 10);
  CHECK_FALSE(house.ode.enabled(b));
  CHECK(house.ode.enabled(floating));
  CHECK(house.ode.state(b).linearVelocity.isZero(0));
  house.ode.setEnabled(b, true);
  house.step();
  CHECK(house.ode.enabled(b));
}

TEST_CASE("where those are that are awake comes in one call") {
  EngineHouse house;
  const Mat3 turned = Eigen::AngleAxisd(0.3, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  std::vector<Body> bodies{house.body({1, 0, 0}), house.body({2, 0, 0}), house.body({3, 4, 5})};
  house.ode.setEnabled(bodies[1], false);
  house.ode.setRotation(bodies[2], turned);
  std::vector<std::uint8_t> awake(3, 7);
  std::vector<Matrix> out(3, Matrix::Zero());
  house.ode.posesOfAwake(bodies, awake, out);
  CHECK(awake == std::vector<std::uint8_t>{1, 0, 1});
  CHECK(out[0] == translation({1, 0, 0}));
  CHECK(out[1].isZero(0));
  const engine::BodyState s = house.ode.state(bodies[2]);
  CHECK(out[2] == toMatrix({s.position, s.rotation}));
}

TEST_CASE("drag slows what moves, and leaves what sleeps alone") {
  EngineHouse house;
  const Body moving = house.body({0, 0, 5}), asleep = house.body({9, 0, 5});
  for (const Body b : {moving, asleep}) {
    house.ode.setLinearVelocity(b, {2, 0, -1});
    house.ode.setAngularVelocity(b, {0, 3, 0});
  }
  house.ode.setEnabled(asleep, false);
  for (const Body b : {moving, asleep}) house.ode.addDrag(b, 0.5, 0.25);
  CHECK(house.ode.force(moving) == Vec3(-1, 0, 0.5));
  CHECK(house.ode.torque(moving) == Vec3(0, -0.75, 0));
  CHECK(house.ode.force(asleep).isZero(0));
  CHECK_FALSE(house.ode.enabled(asleep));
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
    EngineHouse one;
    const EngineHouse other;
    CHECK(dGetErrorHandler() != nullptr);
  }
  CHECK(dGetErrorHandler() == nullptr);
  CHECK(dGetMessageHandler() == nullptr);
  CHECK(dGetDebugHandler() == nullptr);
}

TEST_CASE("a body that is turned by its own rotation again and again keeps right angles") {
  EngineHouse house;
  house.setGravity(0);
  const Body b = house.body({0, 0, 0});
  Mat3 tilted = Eigen::AngleAxisd(0.3, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  tilted(1, 2) += 1e-7;  // as single precision leaves it
  house.ode.setRotation(b, tilted);
  for (int i = 0; i < 300; ++i) {
    const Mat3 r = house.ode.state(b).rotation;
    house.ode.setRotation(b, tilted * r.transpose() * r);
  }
  const Mat3 r = house.ode.state(b).rotation;
  CHECK((r * r.transpose() - Mat3::Identity()).cwiseAbs().maxCoeff() < 1e-4);
  CHECK((r - tilted).cwiseAbs().maxCoeff() < 1e-3);
}

TEST_CASE("a body that flies away is put back before the space's cells end") {
  for (const bool exact : {false, true}) {
    CAPTURE(exact);
    EngineHouse house;
    setProperty(*house.kernel.root().find("/sys/server/physics/engine"), "exactReplay", exact);
    const engine::World world = house.ode.createWorld();
    const engine::Space space = house.ode.createSpace(world, engine::Space::none);
    for (int i = 0; i < 2; ++i) {
      const Body b = house.ode.createBody(world);
      const engine::Geom g = house.ode.createGeom(space, round(engine::Shape::sphere, 0.01), nullptr);
      house.ode.setBody(g, b, {});
      house.ode.setPosition(b, {1.0 * i, 0, 0});
      house.ode.setLinearVelocity(b, {9e7, 0, 0});
    }
    for (int i = 0; i < 200; ++i) {
      house.contacts.clear();
      house.ode.detect(world, nullptr, 4, house.contacts);
      house.ode.step(world, house.contacts, 0.02);
    }
    CHECK(house.ode.state(house.ode.createBody(world)).position.isZero(0));  // it still lives
    house.ode.destroyWorld(world);
  }
}

TEST_CASE("exact replay rounds every component of what crosses the engine, and nothing else does") {
  const Vec3 v(0.1, 0.2, 0.3), rounded = v.cast<float>().eval().cast<double>();
  REQUIRE(rounded != v);
  for (const bool exact : {false, true}) {
    CAPTURE(exact);
    EngineHouse house;
    setProperty(*house.kernel.root().find("/sys/server/physics/engine"), "exactReplay", exact);
    const engine::World world = house.ode.createWorld();
    const Body b = house.ode.createBody(world);
    house.ode.addForce(b, v);
    house.ode.addTorque(b, v);
    const Vec3& wanted = exact ? rounded : v;
    for (int i = 0; i < 3; ++i) {
      CHECK(house.ode.force(b)[i] == wanted[i]);
      CHECK(house.ode.torque(b)[i] == wanted[i]);
    }
    const engine::Joint hinge = house.ode.createJoint(world, engine::JointType::hinge);
    house.ode.attach(hinge, b, Body::none);
    house.ode.setAnchor(hinge, v);  // the body is at 0: the anchor is returned as it was stored
    for (int i = 0; i < 3; ++i) CHECK(house.ode.anchor(hinge)[i] == wanted[i]);
    house.ode.destroyWorld(world);
  }
}
