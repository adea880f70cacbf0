#include <ode/ode.h>

#include <Eigen/Geometry>

#include "engine_fixture.h"

using namespace spark;
using namespace spark::test;
using physics::BodyHandle;

TEST_CASE("a body falls as semi-implicit Euler integration predicts, close to the analytic solution") {
  EngineHost host;
  host.setGravity(9.81);
  const BodyHandle b = host.body({0, 0, 100});
  const double dt = 0.001;
  for (int i = 0; i < 1000; ++i) host.step(dt);
  // Semi-implicit Euler: z = z0 - g dt^2 n (n + 1) / 2.
  CHECK(host.position(b).z() == Approx(100 - 9.81 * dt * dt * 1000 * 1001 / 2).epsilon(1e-12));
  CHECK(host.position(b).z() == Approx(100 - 9.81 / 2).epsilon(1e-4));
  CHECK(host.world.state(b).linearVelocity.z() == Approx(-9.81).epsilon(1e-9));
}

TEST_CASE("a force acts for one step, and the acceleration is force / mass") {
  EngineHost host;
  host.setGravity(0);
  const BodyHandle b = host.body({0, 0, 0});
  host.world.setMass(b, {2.0, Vec3::Zero(), Mat3::Identity() * 0.5});
  host.world.addForce(b, {4, 0, 0});
  host.world.addTorque(b, {0, 0, 1});
  CHECK(host.world.force(b).x() == 4);
  host.step(0.1);
  CHECK(host.world.state(b).linearVelocity.x() == Approx(0.2));
  CHECK(host.world.state(b).angularVelocity.z() == Approx(0.2));
  CHECK(host.world.force(b).isZero(0));
  host.step(0.1);
  CHECK(host.world.state(b).linearVelocity.x() == Approx(0.2));
}

TEST_CASE("gravity can be switched off for one body") {
  EngineHost host;
  host.setGravity(9.81);
  const BodyHandle light = host.body({0, 0, 1}), heavy = host.body({3, 0, 1});
  host.world.setGravityMode(light, false);
  host.step();
  CHECK(host.position(light).z() == 1);
  CHECK(host.position(heavy).z() < 1);
}

TEST_CASE("invalid masses are refused with an explanation") {
  EngineHost host;
  const BodyHandle b = host.body({0, 0, 0});
  CHECK_THROWS_WITH(host.world.setMass(b, {0, Vec3::Zero(), Mat3::Identity()}), Catch::Contains("mass above 0 kg"));
  CHECK_THROWS_WITH(host.world.setMass(b, {1, Vec3(0.1, 0, 0), Mat3::Identity()}), Catch::Contains("centre of mass"));
  CHECK_THROWS_WITH(host.world.setMass(b, {1, Vec3::Zero(), -Mat3::Identity()}), Catch::Contains("positive definite"));
  CHECK_THROWS_WITH(host.world.setMass(b, {std::nan(""), Vec3::Zero(), Mat3::Identity()}), Catch::Contains("finite"));
}

TEST_CASE("setters of a body ignore NaN, infinite values and singular rotations") {
  EngineHost host;
  host.setGravity(0);
  const BodyHandle b = host.body({1, 2, 3});
  const double nan = std::nan(""), inf = HUGE_VAL;
  host.world.setPosition(b, {nan, 0, 0});
  host.world.setRotation(b, Mat3::Constant(inf));
  host.world.setRotation(b, Mat3::Zero());
  host.world.setLinearVelocity(b, {inf, 0, 0});
  host.world.setAngularVelocity(b, {0, nan, 0});
  host.world.addForce(b, {nan, 0, 0});
  host.world.addTorque(b, {0, 0, inf});
  host.step();
  CHECK(host.position(b) == Vec3(1, 2, 3));
  CHECK(host.stepper.repaired().empty());
}

TEST_CASE("a body that diverges is put back to its last valid pose, at rest, and reported once") {
  EngineHost host;
  host.setGravity(0);
  const BodyHandle bad = host.body({1, 2, 3}), good = host.body({5, 0, 0});
  host.world.setLinearVelocity(bad, {1, 0, 0});
  host.step(0.5);
  CHECK(host.position(bad).x() == 1.5);
  host.world.addForce(bad, {1e300, 0, 0});
  host.world.addForce(bad, {1e308, 0, 0});
  host.step(0.5);
  REQUIRE(host.stepper.repaired().size() == 1);
  CHECK(host.stepper.repaired()[0] == bad);
  CHECK(host.position(bad) == Vec3(1.5, 2, 3));
  CHECK(host.world.state(bad).linearVelocity.isZero(0));
  host.step(0.5);
  CHECK(host.stepper.repaired().empty());
  CHECK(host.position(good) == Vec3(5, 0, 0));
}

TEST_CASE("absurdly large forces do not end the process, with and without exact replay") {
  for (const double huge : {1e39, 1e155, 1e308})
    for (const bool exact : {false, true}) {
      INFO(huge << (exact ? ", exact" : ""));
      EngineHost host(exact);
      const BodyHandle a = host.world.createBody(), b = host.world.createBody(), other = host.world.createBody();
      for (const BodyHandle body : {a, b, other}) {
        host.world.setMass(body, {1, Vec3::Zero(), Mat3::Identity()});
        host.world.setGravityMode(body, false);
      }
      const physics::JointHandle joint = host.world.createJoint(engine::JointType::hinge);
      host.world.attach(joint, a, b);
      host.world.setAxis(joint, 0, Vec3::UnitX());
      const auto step = [&] {
        host.step();
        CHECK(host.position(a).isZero(0));
        CHECK(host.world.state(a).rotation.allFinite());
      };
      host.world.addTorque(a, {huge, huge, huge});
      host.world.addTorque(a, {huge, huge, huge});
      step();
      host.world.setParameter(joint, engine::JointParameter::maxForce, 0, huge);
      host.world.setParameter(joint, engine::JointParameter::velocity, 0, huge);
      step();
      CHECK(host.position(other).isZero(0));
    }
}

TEST_CASE("a body at rest on the ground falls asleep after at least ten steps, and a floating body stays awake") {
  EngineHost host;
  host.setGravity(9.81, true);
  host.geom(plane(0, 0, 1, 0));
  const BodyHandle b = host.body({0, 0, 0.4995}), floating = host.body({5, 0, 5});
  host.world.setGravityMode(floating, false);
  host.geom(box(1, 1, 1), b);
  int steps = 0;
  while (host.world.enabled(b) && steps < 200) host.step(), ++steps;
  CHECK(steps >= 10);
  CHECK_FALSE(host.world.enabled(b));
  CHECK(host.world.enabled(floating));
  CHECK(host.world.state(b).linearVelocity.isZero(0));
  host.world.setEnabled(b, true);
  host.step();
  CHECK(host.world.enabled(b));
}

TEST_CASE("drag acts on awake bodies and does not act on or wake sleeping ones") {
  EngineHost host;
  const BodyHandle moving = host.body({0, 0, 5}), asleep = host.body({9, 0, 5});
  for (const BodyHandle b : {moving, asleep}) {
    host.world.setLinearVelocity(b, {2, 0, -1});
    host.world.setAngularVelocity(b, {0, 3, 0});
  }
  host.world.setEnabled(asleep, false);
  for (const BodyHandle b : {moving, asleep}) host.world.addDrag(b, 0.5, 0.25);
  CHECK(host.world.force(moving) == Vec3(-1, 0, 0.5));
  CHECK(host.world.torque(moving) == Vec3(0, -0.75, 0));
  CHECK(host.world.force(asleep).isZero(0));
  CHECK_FALSE(host.world.enabled(asleep));
}

TEST_CASE("the plugin cannot be unloaded while an engine exists, but can be afterwards") {
  TestHost host;
  host.kernel.plugins().use("physics-ode");
  Leaf& engine = host.kernel.create("OdeEngine", "/sys/engine");
  CHECK_THROWS_WITH(host.kernel.plugins().unload("physics-ode"), Catch::Contains("/sys/engine"));
  engine.parent()->remove(engine);
  host.kernel.plugins().unload("physics-ode");
  CHECK(host.kernel.findClass("OdeEngine") == nullptr);
}

TEST_CASE("ODE is closed and its message handlers are reset with the last engine") {
  {
    EngineHost one;
    const EngineHost other;
    CHECK(dGetErrorHandler() != nullptr);
  }
  CHECK(dGetErrorHandler() == nullptr);
  CHECK(dGetMessageHandler() == nullptr);
  CHECK(dGetDebugHandler() == nullptr);
}

TEST_CASE("a body's rotation stays orthonormal if it is set from itself many times") {
  EngineHost host;
  host.setGravity(0);
  const BodyHandle b = host.body({0, 0, 0});
  Mat3 tilted = Eigen::AngleAxisd(0.3, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  tilted(1, 2) += 1e-7;  // an error as of single precision
  host.world.setRotation(b, tilted);
  for (int i = 0; i < 300; ++i) {
    const Mat3 r = host.world.state(b).rotation;
    host.world.setRotation(b, tilted * r.transpose() * r);
  }
  const Mat3 r = host.world.state(b).rotation;
  CHECK((r * r.transpose() - Mat3::Identity()).cwiseAbs().maxCoeff() < 1e-4);
  CHECK((r - tilted).cwiseAbs().maxCoeff() < 1e-3);
}

TEST_CASE("a body that flies away is put back before it leaves the range of the space's cells") {
  for (const bool exact : {false, true}) {
    CAPTURE(exact);
    EngineHost host(exact);
    for (int i = 0; i < 2; ++i) {
      const BodyHandle b = host.body({1.0 * i, 0, 0});
      host.geom(round(engine::Shape::sphere, 0.01), b);
      host.world.setLinearVelocity(b, {9e7, 0, 0});
    }
    for (int i = 0; i < 200; ++i) host.step();
    CHECK(host.position(host.world.createBody()).isZero(0));  // the world still works
  }
}

TEST_CASE("only with exact replay are forces, torques and anchors rounded to single precision") {
  const Vec3 v(0.1, 0.2, 0.3), rounded = v.cast<float>().eval().cast<double>();
  REQUIRE(rounded != v);
  for (const bool exact : {false, true}) {
    CAPTURE(exact);
    EngineHost host(exact);
    const BodyHandle b = host.world.createBody();
    host.world.addForce(b, v);
    host.world.addTorque(b, v);
    const Vec3& wanted = exact ? rounded : v;
    for (int i = 0; i < 3; ++i) {
      CHECK(host.world.force(b)[i] == wanted[i]);
      CHECK(host.world.torque(b)[i] == wanted[i]);
    }
    const physics::JointHandle hinge = host.world.createJoint(engine::JointType::hinge);
    host.world.attach(hinge, b, BodyHandle::none);
    host.world.setAnchor(hinge, v);  // the body is at 0, so the anchor is returned as it was stored
    for (int i = 0; i < 3; ++i) CHECK(host.world.at(hinge).anchor()[i] == wanted[i]);
  }
}
