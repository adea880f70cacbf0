#include "humanoids.h"

using namespace spark;
using namespace spark::test;
using engine::JointParameter;
using engine::JointType;

namespace {

/// Bodies near each other and joints of any type between any of them and the world: trees, loops, several between the
/// same two.
void addJungle(Twins& t, int bodies, int joints, double cfm, bool boxes = true) {
  for (int i = 0; i < bodies; ++i) {
    const std::size_t b = t.anyBody({0.3 * (i % 4), 0.3 * (i / 4), 0.4 + 0.1 * t.uniform(0, 1)});
    if (boxes && i % 2) t.box({0.1, 0.15, 0.2}, b);
  }
  for (int k = 0; k < joints; ++k) {
    const JointType type = kTypes[t.pick(7)];
    // At first to one before, so that all hang together; then anywhere.
    int a = k < bodies - 1 ? k + 1 : t.pick(bodies), b = k < bodies - 1 ? t.pick(k + 1) : t.pick(bodies + 1) - 1;
    if (a == b) continue;
    if (type == JointType::hinge2 && b < 0) continue;
    if (t.pick(2)) std::swap(a, b);
    const std::size_t j = t.joint(type, a, b);
    const Vec3 anchor = t.anyVector(0.3) + Vec3(0.5, 0.3, 0.5), axis1 = t.anyVector(1).normalized();
    const Vec3 axis2 = axis1.cross(t.anyVector(1)).normalized();
    t.eachJoint(j, [&](engine::IEngine& e, engine::Joint joint) {
      e.setAnchor(joint, anchor);
      if (type == JointType::angularMotor) e.setAngularMotor(joint, 2, false);
      e.setAxis(joint, 0, axis1, 1);
      e.setAxis(joint, 1, axis2, 2);
      e.setFixed(joint);
    });
    for (int axis = 0; axis < 2; ++axis) {
      t.set(j, JointParameter::cfm, axis, cfm);
      t.set(j, JointParameter::stopCfm, axis, cfm);
      t.set(j, JointParameter::maxForce, axis, t.pick(2) ? t.uniform(0.1, 3) : 0);
      t.set(j, JointParameter::velocity, axis, t.uniform(-3, 3));
      t.set(j, JointParameter::highStop, axis, t.uniform(0, 1));
      t.set(j, JointParameter::lowStop, axis, t.uniform(-1, 0));
    }
  }
}

}  // namespace

TEST_CASE("jungles of joints with loops move as with ODE") {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    INFO("seed " << seed);
    Twins t(seed);
    t.parameters.cfm = 1e-4;
    t.apply();
    t.ground();
    const int bodies = 2 + t.pick(8);
    addJungle(t, bodies, bodies - 1 + t.pick(4), 1e-4);
    t.shake();
    t.surface.mu = seed % 2 ? HUGE_VAL : 1;
    t.checkSteps(20);
  }
}

TEST_CASE("without any softness trees move as with ODE, which a division by it would not survive") {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    INFO("seed " << seed);
    Twins t(seed);
    t.parameters.cfm = 0;
    t.apply();
    const int bodies = 2 + t.pick(6);
    addJungle(t, bodies, bodies - 1, 0, false);
    // One point on the ground: more would say the same twice, and ODE has no answer to that.
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

TEST_CASE("contacts that say the same many times without softness harm nobody") {
  Twins t(5);
  t.parameters.cfm = 0;
  t.apply();
  t.ground();
  for (int i = 0; i < 3; ++i) t.box({0.3, 0.3, 0.3}, t.body({0, 0, 0.15 + 0.299 * i}, 1, Mat3::Identity() * 0.015));
  for (int i = 0; i < 100; ++i) {
    t.touch(t.solved);
    t.solved.engine.step(t.solved.world, t.solved.contacts, t.dt);
  }
  for (int i = 0; i < 3; ++i) {
    const engine::BodyState s = t.solved.engine.state(t.solved.bodies[static_cast<std::size_t>(i)]);
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
      t.each([&](Scene& s) {
        humanoids.drive(
            s, [&](std::size_t j) { return 3.0 * (seed - 1.0) * std::sin(0.2 * i + static_cast<double>(j)); },
            seed == 4 ? 0.8 : 25);
      });
      t.checkSteps(2);
    }
  }
}

TEST_CASE("where the search began has no say in what is found, to the last digit") {
  Twins used(9), fresh(9);
  for (Twins* t : {&used, &fresh}) {
    t->ground();
    t->surface.mu = 2;
    Humanoids humanoids(*t);
    for (int i = 0; i < 2; ++i) humanoids.add({0.15 * i, 0.02 * i, 0});
    t->each([&](Scene& s) {
      humanoids.drive(
          s, [](std::size_t j) { return j % 3 - 1.0; }, 0.8);
    });
    for (int i = 0; i < 4; ++i)
      t->box({0.2, 0.2, 0.2}, t->body({1 + 0.02 * i, 0, 0.1 + 0.19 * i}, 1, Mat3::Identity() * 0.01));
  }
  for (int i = 0; i < 60; ++i) {
    fresh.newSolver();
    std::vector<double> states[2];
    for (Twins* t : {&used, &fresh}) {
      t->touch(t->solved);
      t->solved.engine.step(t->solved.world, t->solved.contacts, t->dt);
      for (const engine::Body b : t->solved.bodies) t->solved.engine.saveBody(b, states[t == &fresh]);
    }
    REQUIRE(states[0] == states[1]);
  }
  CHECK(used.counted("passes") > used.counted("islands"));
}

TEST_CASE("islands that several threads solve move as with one thread, to the last digit") {
  const auto states = [](int threads) {
    Twins t(5);
    t.kernel.jobs().setThreads(threads);
    for (int i = 0; i < 24; i += 2) {
      t.anyBody({0.1 * i, 0, 1}), t.anyBody({0.1 * i, 0.3, 1});
      t.joint(JointType::ball, i, i + 1);
    }
    t.shake();
    std::vector<double> out;
    for (int k = 0; k < 20; ++k) {
      t.solved.engine.step(t.solved.world, t.solved.contacts, t.dt);
      for (const engine::Body b : t.solved.bodies) t.solved.engine.saveBody(b, out);
    }
    CHECK(t.counted("islands") == 12 * 20);
    CHECK(t.counted("deferredIslands") == 0);
    return out;
  };
  const auto one = states(1);
  CHECK((states(2) == one));
  CHECK((states(4) == one));
}
