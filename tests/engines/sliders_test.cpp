#include "engine_world.h"

// Sliders, in each engine that supports joints.

using namespace spark;
using namespace spark::test;

TEST_CASE("a slider that closes a loop has the direction of one that does not, with either order, motor and stops") {
  for (const bool worldFirst : {false, true})
    for (const bool closes : {false, true})
      withEngines(
          [&](EngineWorld& w) {
            CAPTURE(worldFirst, closes);
            w.setGravity(0);
            const BodyHandle b = w.body({0, 0, 0});
            if (closes) w.joint(JointType::slider, b, BodyHandle::none, {0, 0, 0}, Vec3::UnitX());
            const BodyHandle none = BodyHandle::none;
            const JointHandle j =
                w.joint(JointType::slider, worldFirst ? none : b, worldFirst ? b : none, {0, 0, 0}, Vec3::UnitX());
            w.motor(j, 0, 0.5, 50);
            w.run(1);
            // A slider moves its first body along the axis, seen from the second.
            const double direction = worldFirst ? -1 : 1;
            CHECK(w.position(b).x() == Approx(0.5 * direction).margin(0.02));
            w.stops(j, 0, -0.1, 0.7);
            w.run(1);
            CHECK(w.position(b).x() == Approx(0.7 * direction).margin(0.02));
            w.motor(j, 0, -0.5, 50);
            w.run(2.5);
            CHECK(w.position(b).x() == Approx(-0.1 * direction).margin(0.02));
            CHECK(std::abs(w.position(b).y()) < 1e-3);
          },
          {&engine::Capabilities::joints, &engine::Capabilities::loops});
}

TEST_CASE("the rate of a slider is that of its position, also between bodies that turn") {
  withEngines(
      [](EngineWorld& w) {
        w.setGravity(0);
        w.dt = 0.001;
        const BodyHandle a = w.body({0, 0, 0}), b = w.body({1, 0, 0});
        const JointHandle j = w.joint(JointType::slider, a, b, {0.5, 0, 0});
        const Vec3 spin(0.2, 0.5, 0);
        for (const BodyHandle body : {a, b}) {
          w.world.setAngularVelocity(body, spin);
          w.world.setLinearVelocity(body, spin.cross(w.position(body)));
        }
        for (const double slide : {0.0, 0.3}) {
          CAPTURE(slide);
          w.world.setLinearVelocity(a, w.world.state(a).linearVelocity + slide * w.world.at(j).axis(0));
          w.run(0.1);
          const double before = w.world.at(j).angle(0), began = w.world.at(j).angleRate(0);
          w.run(0.01);
          const double rate = (w.world.at(j).angle(0) - before) / 0.01;
          CHECK(std::abs(rate - slide) < 0.1);
          CHECK((began + w.world.at(j).angleRate(0)) / 2 == Approx(rate).margin(0.005));
        }
      },
      {&engine::Capabilities::joints});
}

TEST_CASE(
    "with exactReplay the rate of a slider is that of the installed base, which leaves out that the bodies turn") {
  EngineWorld w(kEngines[0], true);
  const BodyHandle a = w.body({0, 0, 0}), b = w.body({1, 0, 0});
  const JointHandle j = w.joint(JointType::slider, a, b, {0.5, 0, 0});
  for (const BodyHandle body : {a, b}) w.world.setAngularVelocity(body, {0, 0.5, 0});
  w.world.setLinearVelocity(b, {0, 0, -0.5});
  CHECK(w.world.at(j).angleRate(0) == Approx(0.5));
  w.world.setLinearVelocity(a, {0, 0, 0.25});
  CHECK(w.world.at(j).angleRate(0) == Approx(0.75));
}

TEST_CASE("the armature of a slider between two rotating bodies adds no energy, also where it closes a loop") {
  for (const bool beside : {false, true})
    for (const bool closes : {false, true})
      withEngines(
          [&](EngineWorld& w) {
            if (closes && !w.can.loops) return;
            CAPTURE(beside, closes);
            w.setGravity(0);
            w.dt = 0.001;
            const Vec3 apart = beside ? Vec3(1, 0, 0) : Vec3(0, 0, 1), spin(0, 0.5, 0);
            const BodyHandle a = w.body({0, 0, 0}), b = w.body(apart);
            if (closes) w.joint(JointType::slider, a, b, apart / 2);
            const JointHandle j = w.joint(JointType::slider, a, b, apart / 2);
            w.world.setParameter(j, JointParameter::armature, 0, 5);
            // Both rotate about y like one rigid body. Their slider would let them move apart if it had no armature.
            for (const BodyHandle body : {a, b}) {
              w.world.setAngularVelocity(body, spin);
              w.world.setLinearVelocity(body, spin.cross(w.position(body) - apart / 2));
            }
            w.run(1);
            // Each is 0.5 m from the axis and accelerates outwards by 0.5 * 0.25 m/s^2. Their distance has an inertia
            // of 0.5 + 5 kg. Bodies beside each other move apart across the slider only, which it does not let them.
            CHECK(std::abs(w.world.at(j).angle(0)) < 0.03);
            CHECK(std::abs(w.world.at(j).angleRate(0)) < 0.06);
            CHECK(w.spin(a).y() == Approx(0.5).epsilon(0.05));
          },
          {&engine::Capabilities::joints, &engine::Capabilities::armature});
}
