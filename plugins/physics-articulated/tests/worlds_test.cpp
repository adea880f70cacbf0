#include "humanoids.h"

using namespace spark;
using namespace spark::test;
using engine::JointParameter;
using engine::JointType;

namespace {

/// Bodies near each other, with joints of random types between random bodies or between a body and the world. This
/// gives trees, loops, and several joints between the same two bodies.
void addRandomMechanism(Twins& t, int bodies, int joints, double cfm, bool boxes = true) {
  for (int i = 0; i < bodies; ++i) {
    const std::size_t b = t.randomBody({0.3 * (i % 4), 0.3 * (i / 4), 0.4 + 0.1 * t.uniform(0, 1)});
    if (boxes && i % 2) t.box({0.1, 0.15, 0.2}, b);
  }
  for (int k = 0; k < joints; ++k) {
    const JointType type = kTypes[t.randomInt(7)];
    // The first joints connect each body to an earlier one and form one tree. The others connect any bodies.
    int a = k < bodies - 1 ? k + 1 : t.randomInt(bodies),
        b = k < bodies - 1 ? t.randomInt(k + 1) : t.randomInt(bodies + 1) - 1;
    if (a == b) continue;
    if (type == JointType::hinge2 && b < 0) continue;
    if (t.randomInt(2)) std::swap(a, b);
    const std::size_t j = t.joint(type, a, b);
    const Vec3 anchor = t.randomVector(0.3) + Vec3(0.5, 0.3, 0.5), axis1 = t.randomVector(1).normalized();
    const Vec3 axis2 = axis1.cross(t.randomVector(1)).normalized();
    t.forBothJoints(j, [&](physics::WorldModel& w, physics::JointHandle joint) {
      w.setAnchor(joint, anchor);
      if (type == JointType::angularMotor) w.setAngularMotor(joint, 2, false);
      w.setAxis(joint, 0, axis1, 1);
      w.setAxis(joint, 1, axis2, 2);
      w.setFixed(joint);
    });
    for (int axis = 0; axis < 2; ++axis) {
      t.set(j, JointParameter::cfm, axis, cfm);
      t.set(j, JointParameter::stopCfm, axis, cfm);
      t.set(j, JointParameter::maxForce, axis, t.randomInt(2) ? t.uniform(0.1, 3) : 0);
      t.set(j, JointParameter::velocity, axis, t.uniform(-3, 3));
      t.set(j, JointParameter::highStop, axis, t.uniform(0, 1));
      t.set(j, JointParameter::lowStop, axis, t.uniform(-1, 0));
    }
  }
}

}  // namespace

TEST_CASE("random mechanisms with loops move as with ODE") {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    INFO("seed " << seed);
    Twins t(seed);
    t.parameters.cfm = 1e-4;
    t.apply();
    t.ground();
    const int bodies = 2 + t.randomInt(8);
    addRandomMechanism(t, bodies, bodies - 1 + t.randomInt(4), 1e-4);
    t.shake();
    t.surface.mu = seed % 2 ? HUGE_VAL : 1;
    t.checkSteps(20);
  }
}

TEST_CASE("trees with a CFM of 0 move as with ODE") {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    INFO("seed " << seed);
    Twins t(seed);
    t.parameters.cfm = 0;
    t.apply();
    const int bodies = 2 + t.randomInt(6);
    addRandomMechanism(t, bodies, bodies - 1, 0, false);
    // Only one contact point: more of them would be redundant rows, which ODE cannot solve with a CFM of 0.
    t.ground();
    const std::size_t ball = t.body({3, 0, 0.095}, 1, Mat3::Identity() * 0.01);
    engine::ShapeDescription sphere;
    sphere.shape = engine::Shape::sphere;
    sphere.radius = 0.1;
    t.geom(sphere, static_cast<int>(ball));
    t.shake();
    t.checkSteps(10);
  }
}

TEST_CASE("a stack with redundant contacts is stable with a CFM of 0") {
  Twins t(5);
  t.parameters.cfm = 0;
  t.apply();
  t.ground();
  for (int i = 0; i < 3; ++i) t.box({0.3, 0.3, 0.3}, t.body({0, 0, 0.15 + 0.299 * i}, 1, Mat3::Identity() * 0.015));
  for (int i = 0; i < 100; ++i) {
    t.detectContacts(t.solved);
    t.solved.step(t.dt);
  }
  for (int i = 0; i < 3; ++i) {
    const engine::BodyState s = t.solved.world.state(t.solved.bodies[static_cast<std::size_t>(i)]);
    CHECK(s.position.z() == Approx(0.15 + 0.3 * i).margin(0.02));
    CHECK(s.linearVelocity.norm() < 0.05);
  }
}

TEST_CASE("humanoids stand, walk, fall and push each other as with ODE") {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    INFO("seed " << seed);
    Twins t(seed);
    t.ground();
    Humanoids humanoids(t);
    for (int i = 0; i < 3; ++i) humanoids.add({0.2 * i, 0.03 * i, 0});
    for (int i = 0; i < 15; ++i) {
      t.forBoth([&](Scene& s) {
        humanoids.drive(
            s, [&](std::size_t j) { return 3.0 * (seed - 1.0) * std::sin(0.2 * i + static_cast<double>(j)); },
            seed == 4 ? 0.8 : 25);
      });
      t.checkSteps(2);
    }
  }
}

TEST_CASE("the warm start does not change the result, bit for bit") {
  Twins used(9), fresh(9);
  for (Twins* t : {&used, &fresh}) {
    t->ground();
    t->surface.mu = 2;
    Humanoids humanoids(*t);
    for (int i = 0; i < 2; ++i) humanoids.add({0.15 * i, 0.02 * i, 0});
    t->forBoth([&](Scene& s) {
      humanoids.drive(
          s, [](std::size_t j) { return j % 3 - 1.0; }, 0.8);
    });
    for (int i = 0; i < 4; ++i)
      t->box({0.2, 0.2, 0.2}, t->body({1 + 0.02 * i, 0, 0.1 + 0.19 * i}, 1, Mat3::Identity() * 0.01));
  }
  for (int i = 0; i < 60; ++i) {
    fresh.newEngine();
    std::vector<double> states[2];
    for (Twins* t : {&used, &fresh}) {
      t->detectContacts(t->solved);
      t->solved.step(t->dt);
      for (const physics::BodyHandle b : t->solved.bodies) t->solved.world.saveBody(b, states[t == &fresh]);
    }
    REQUIRE(states[0] == states[1]);
  }
  CHECK(used.counted("passes") > used.counted("islands"));
}

TEST_CASE("several threads give the same result as one, bit for bit") {
  const auto states = [](int threads) {
    Twins t(5);
    t.kernel.jobs().setThreads(threads);
    for (int i = 0; i < 24; i += 2) {
      t.randomBody({0.1 * i, 0, 1}), t.randomBody({0.1 * i, 0.3, 1});
      t.joint(JointType::ball, i, i + 1);
    }
    t.shake();
    std::vector<double> out;
    for (int k = 0; k < 20; ++k) {
      t.solved.step(t.dt);
      for (const physics::BodyHandle b : t.solved.bodies) t.solved.world.saveBody(b, out);
    }
    CHECK(t.counted("islands") == 12 * 20);
    CHECK(t.counted("deferredIslands") == 0);
    return out;
  };
  const auto one = states(1);
  CHECK((states(2) == one));
  CHECK((states(4) == one));
}
