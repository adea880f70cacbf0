#include "engine_world.h"

// Bodies, in each engine.

using namespace spark;
using namespace spark::test;

TEST_CASE("a body falls as semi-implicit Euler integration predicts") {
  withEngines([](EngineWorld& w) {
    const BodyHandle b = w.body({0, 0, 100});
    w.dt = 0.001;
    w.run(1);
    CHECK(w.position(b).z() == Approx(100 - 9.81 * 0.001 * 0.001 * 1000 * 1001 / 2).epsilon(1e-12));
    CHECK(w.velocity(b).z() == Approx(-9.81).epsilon(1e-9));
  });
}

TEST_CASE("a force acts for one step and accelerates by force / mass, and gravity can be switched off for a body") {
  withEngines([](EngineWorld& w) {
    const BodyHandle heavy = w.body({0, 0, 5}, 2, Mat3::Identity() * 0.5), falling = w.body({3, 0, 5});
    w.world.setGravityMode(heavy, false);
    w.world.addForce(heavy, {4, 0, 0});
    w.world.addTorque(heavy, {0, 0, 1});
    w.run(0.01);
    CHECK(w.velocity(heavy).x() == Approx(0.02));
    if (w.can.rotation) CHECK(w.spin(heavy).z() == Approx(0.02));
    CHECK(std::abs(w.velocity(heavy).z()) < 1e-12);
    CHECK(w.velocity(falling).z() < 0);
    CHECK(w.world.force(heavy).isZero(0));
    w.run(0.01);
    CHECK(w.velocity(heavy).x() == Approx(0.02));
  });
}

TEST_CASE("a torque-free body that spins about its axis of symmetry keeps its angular velocity") {
  withEngines(
      [](EngineWorld& w) {
        w.setGravity(0);
        const BodyHandle b = w.body({0, 0, 0}, 1, Vec3(0.1, 0.1, 0.3).asDiagonal());
        w.world.setAngularVelocity(b, {0, 0, 5});
        w.run(1);
        CHECK(w.spin(b).isApprox(Vec3(0, 0, 5), 1e-9));
        const Vec3 x = w.world.state(b).rotation.col(0);
        CHECK(std::atan2(x.y(), x.x()) == Approx(5 - 2 * kPi).margin(0.02));
      },
      {&engine::Capabilities::rotation});
}

TEST_CASE("damping slows a free body, and does not turn it back however strong it is") {
  withEngines([](EngineWorld& w) {
    w.setGravity(0);
    const BodyHandle weak = w.body({0, 0, 0}, 2), strong = w.body({9, 0, 0}, 2);
    w.world.setDamping(weak, 3, 0.2);
    w.world.setDamping(strong, 1e6, 1e6);
    for (const BodyHandle b : {weak, strong}) {
      w.world.setLinearVelocity(b, {1, 0, 0});
      w.world.setAngularVelocity(b, {0, 0, 2});
    }
    w.run(w.dt);
    CHECK(w.velocity(strong).x() == Approx(0).margin(1e-3));
    w.run(0.5 - w.dt);
    CHECK(w.velocity(weak).x() == Approx(std::exp(-3.0 / 2 * 0.5)).epsilon(0.02));
    CHECK(w.velocity(strong).isZero(1e-9));
    if (!w.can.rotation) return;
    CHECK(w.spin(weak).z() == Approx(2 * std::exp(-0.2 / 0.1 * 0.5)).epsilon(0.02));
    CHECK(w.spin(strong).isZero(1e-9));
  });
}

TEST_CASE("strong damping beside the centre of mass holds the point that it acts at") {
  withEngines(
      [](EngineWorld& w) {
        w.setGravity(0);
        const BodyHandle rod = w.body({0, 0, 0}, 1, Mat3::Identity() / 12);
        w.world.setLinkOrigin(rod, {-0.5, 0, 0});
        w.world.setDamping(rod, 1000, 0);
        w.world.setLinearVelocity(rod, {0, 1, 0});
        w.run(0.2);
        const Vec3 at = w.world.state(rod).rotation * Vec3(-0.5, 0, 0);
        CHECK((w.velocity(rod) + w.spin(rod).cross(at)).norm() < 0.02);
        CHECK(w.velocity(rod).norm() < 1);
      },
      {&engine::Capabilities::rotation});
}

TEST_CASE("damping of a body acts at the origin of its link's frame") {
  withEngines(
      [](EngineWorld& w) {
        w.setGravity(0);
        const BodyHandle b = w.body({0, 0, 0});
        w.world.setLinkOrigin(b, {0.5, 0, 0});
        w.world.setDamping(b, 0.5, 0);
        w.world.setLinearVelocity(b, {0, 1, 0});
        w.run(w.dt);
        // A force of -0.5 N in y, 0.5 m from the centre: a torque of -0.25 Nm on 0.1 kg m^2.
        CHECK(w.velocity(b).y() == Approx(1 - 0.5 * w.dt).epsilon(1e-3));
        CHECK(w.spin(b).z() == Approx(-2.5 * w.dt).epsilon(0.03));
      },
      {&engine::Capabilities::rotation});
}

TEST_CASE("a body that diverges is put back at rest and reported once, and the others continue") {
  withEngines([](EngineWorld& w) {
    w.setGravity(0);
    const BodyHandle bad = w.body({1, 2, 3}), good = w.body({5, 0, 0});
    w.world.setLinearVelocity(bad, {1, 0, 0});
    w.world.setLinearVelocity(good, {0, 1, 0});
    w.run(0.5);
    w.world.addForce(bad, {1e30, 0, 0});
    w.run(0.01);
    REQUIRE(w.stepper.repaired().size() == 1);
    CHECK(w.stepper.repaired()[0] == bad);
    CHECK(w.position(bad).isApprox(Vec3(1.5, 2, 3)));
    CHECK(w.velocity(bad).isZero(0));
    w.run(0.01);
    CHECK(w.stepper.repaired().empty());
    CHECK(w.position(good).y() == Approx(0.52));
  });
}

TEST_CASE("a resting body falls asleep and wakes on contact, and a floating body stays awake") {
  withEngines(
      [](EngineWorld& w) {
        w.setGravity(9.81, true);
        w.ground();
        const BodyHandle lying = w.block({0, 0, 0.4999}, {1, 1, 1}), floating = w.body({5, 0, 5});
        w.world.setGravityMode(floating, false);
        w.run(2);
        CHECK_FALSE(w.world.enabled(lying));
        CHECK(w.world.enabled(floating));
        const Vec3 before = w.position(lying);
        w.run(0.5);
        CHECK(w.position(lying) == before);
        const BodyHandle thrown = w.block({0, 0, 1.6}, {0.5, 0.5, 0.5});
        w.world.setLinearVelocity(thrown, {0, 0, -3});
        w.run(0.2);
        CHECK(w.world.enabled(lying));
      },
      {&engine::Capabilities::sleeps});
}

TEST_CASE("a world whose bodies are restored continues bit for bit, in the same kernel and in a new one") {
  withEngines(
      [](EngineWorld& w) {
        const auto heap = [](EngineWorld& in) {
          in.setGravity(9.81, true);
          in.ground();
          std::vector<BodyHandle> bodies;
          for (int i = 0; i < 8; ++i)
            bodies.push_back(in.block({0.1 * (i % 3), 0.07 * i, 0.6 + 1.05 * i}, {1, 0.9, 0.8}));
          return bodies;
        };
        const std::vector<BodyHandle> bodies = heap(w);
        w.run(0.7);
        const std::vector<double> middle = w.saved(bodies);
        w.run(2);
        const std::vector<double> end = w.saved(bodies);
        REQUIRE(middle != end);
        const auto load = [&](EngineWorld& in, const std::vector<BodyHandle>& to) {
          const std::size_t each = middle.size() / to.size();
          for (std::size_t i = 0; i < to.size(); ++i)
            in.world.loadBody(to[i], std::span(middle).subspan(i * each, each));
        };
        load(w, bodies);
        w.run(2);
        CHECK(w.saved(bodies) == end);
        EngineWorld other(w.kind);
        const std::vector<BodyHandle> twins = heap(other);
        other.run(0.1);
        load(other, twins);
        other.run(2);
        CHECK(other.saved(twins) == end);
      },
      {&engine::Capabilities::stateless});
}
