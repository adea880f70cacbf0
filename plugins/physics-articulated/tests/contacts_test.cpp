#include "twins.h"

using namespace spark;
using namespace spark::test;
using engine::JointParameter;
using engine::JointType;

namespace {

/// Random boxes above the ground at distances of `spacing` [m]; if it is below 0.5, also at increasing heights.
void addBoxes(Twins& t, int count, double spacing) {
  for (int i = 0; i < count; ++i) {
    const Vec3 lengths = {t.uniform(0.2, 0.4), t.uniform(0.2, 0.4), t.uniform(0.2, 0.4)};
    const double mass = t.uniform(0.2, 3);
    const Vec3 squares = lengths.cwiseProduct(lengths);
    const Mat3 inertia =
        (mass / 12 * Vec3(squares.y() + squares.z(), squares.x() + squares.z(), squares.x() + squares.y()))
            .asDiagonal();
    const std::size_t b = t.body({spacing * (i % 5), 0.1 * t.uniform(-1, 1), 0.25 + (spacing < 0.5 ? 0.3 * i : 0.0)},
                                 mass, inertia, t.randomRotation());
    t.box(lengths, b);
  }
}

/// A chain of boxes along x from `origin`, connected by hinges with motors of `maxForce` [Nm].
void addChain(Twins& t, int length, const Vec3& origin, double maxForce) {
  std::size_t last = 0;
  for (int i = 0; i < length; ++i) {
    const Vec3 position = origin + Vec3(0.22 * i, 0, 0);
    const std::size_t b = t.body(position, 0.5, t.randomInertia(0.5, 0.2));
    t.box({0.2, 0.1, 0.1}, b);
    if (i > 0) {
      const std::size_t j = i % 2 ? t.joint(JointType::hinge, static_cast<int>(last), static_cast<int>(b))
                                  : t.joint(JointType::hinge, static_cast<int>(b), static_cast<int>(last));
      const Vec3 axis = t.randomVector(1);
      t.forBothJoints(j, [&](physics::WorldModel& w, physics::JointHandle joint) {
        w.setAnchor(joint, position - Vec3(0.11, 0, 0));
        w.setAxis(joint, 0, axis);
      });
      t.set(j, JointParameter::maxForce, 0, maxForce);
      t.set(j, JointParameter::velocity, 0, t.uniform(-4, 4));
      t.set(j, JointParameter::lowStop, 0, -0.6);
      t.set(j, JointParameter::highStop, 0, 0.6);
    }
    last = b;
  }
}

}  // namespace

TEST_CASE("boxes fall, bounce and slip as with ODE") {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    INFO("seed " << seed);
    Twins t(seed);
    t.ground();
    addBoxes(t, 5, 1);
    t.shake(2);
    const double mu[] = {HUGE_VAL, 0, 0.5, 2, 50};
    t.surface.mu = mu[seed % 5];
    t.surface.bounceOn = seed % 2 != 0, t.surface.bounce = 0.6, t.surface.bounceVelocity = 0.3;
    t.surface.slipOn = seed % 3 == 0, t.surface.slip1 = 1e-3, t.surface.slip2 = 2e-3;
    t.surface.softErpOn = t.surface.softCfmOn = seed % 4 == 0, t.surface.softErp = 0.4, t.surface.softCfm = 1e-3;
    t.surface.pyramid = seed > 6;
    t.checkSteps(100);
  }
}

TEST_CASE("a pile of boxes settles as with ODE") {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    INFO("seed " << seed);
    Twins t(seed);
    t.ground();
    addBoxes(t, 8, 0.15);
    t.surface.mu = seed % 3 == 0 ? HUGE_VAL : seed % 3 == 1 ? 2 : 0.7;
    t.surface.pyramid = seed % 3 == 2;
    t.checkSteps(120);
  }
}

TEST_CASE("an island that is far too large is deferred to the child engine") {
  Twins t;
  setProperty(t.articulated(), "mostRows", 1200);
  t.ground();
  for (int i = 0; i < 1000; ++i)
    t.box({0.2, 0.2, 0.2},
          t.body({0.19 * (i % 10), 0.19 * (i / 10 % 10), 0.1 + 0.19 * (i / 100)}, 1, Mat3::Identity()));
  t.detectContacts(t.solved);
  t.solved.step(t.dt);
  CHECK(t.counted("deferredIslands") > 0);
}

TEST_CASE("chains that fall on the ground and on each other move as with ODE") {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    INFO("seed " << seed);
    Twins t(seed);
    t.ground();
    for (int i = 0; i < 3; ++i) addChain(t, 7, {0.1 * i, 0.05 * i, 0.4 + 0.25 * i}, seed % 2 ? 0.3 : 5);
    t.surface.mu = seed < 4 ? HUGE_VAL : 1;
    t.checkSteps(120);
  }
}
