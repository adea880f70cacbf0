#include "engine_world.h"

// What is driven moves, however slowly, in worlds with sleep; and falls asleep when it has arrived.

using namespace spark;
using namespace spark::test;

namespace {

constexpr double kSlow = 0.003;  // rad/s and m/s: below the speed at which bodies are idle

/// A bar on a hinge of the world, without gravity, and a load that is fixed to its end.
struct Arm {
  EngineWorld& w;
  BodyHandle bar, load;
  JointHandle hinge;
  explicit Arm(EngineWorld& world) : w(world) {
    w.setGravity(0, true);
    bar = w.body({0.5, 0, 1}), load = w.body({0.9, 0, 1});
    hinge = w.joint(JointType::hinge, bar, BodyHandle::none, {0, 0, 1});
    w.joint(JointType::fixed, load, bar, {0.9, 0, 1});
  }
  double angle() const { return w.world.at(hinge).angle(0); }
  bool sleeps() const { return !w.world.enabled(bar) && !w.world.enabled(load); }
};

void withArms(const std::function<void(EngineWorld&, Arm&)>& f) {
  withEngines(
      [&](EngineWorld& w) {
        Arm arm(w);
        f(w, arm);
      },
      {&engine::Capabilities::joints});
}

}  // namespace

TEST_CASE("motors, controllers, forces against damping and springs move an arm more slowly than the speed of sleep") {
  struct Drive {
    const char* name;
    std::function<void(EngineWorld&, JointHandle)> start;
    double due;  // rad after 4 s
  };
  const double stiffness = 20, damping = 4000, rest = 0.5;
  const Drive drives[] = {
      {"motor", [](EngineWorld& w, JointHandle j) { w.motor(j, 0, kSlow, 100); }, 4 * kSlow},
      {"velocity controller",
       [](EngineWorld& w, JointHandle j) { w.world.control(j, 0, {.damping = 20, .velocity = kSlow}); }, 4 * kSlow},
      {"force against damping",
       [](EngineWorld& w, JointHandle j) {
         w.world.setParameter(j, JointParameter::damping, 0, 100);
         w.world.control(j, 0, {.force = 100 * kSlow});
       },
       4 * kSlow},
      {"damped spring",
       [&](EngineWorld& w, JointHandle j) {
         w.world.setParameter(j, JointParameter::damping, 0, damping);
         w.world.setSpring(j, 0, stiffness, rest);
       },
       rest * (1 - std::exp(-4 * stiffness / damping))},
  };
  for (const Drive& drive : drives)
    withArms([&](EngineWorld& w, Arm& arm) {
      INFO(drive.name);
      drive.start(w, arm.hinge);
      w.run(4);
      CHECK(arm.angle() == Approx(drive.due).epsilon(0.05));
    });
}

TEST_CASE("a body that is driven falls asleep when it has arrived, and stays there") {
  withArms([](EngineWorld& w, Arm& arm) {
    w.world.setParameter(arm.hinge, JointParameter::damping, 0, 20);
    w.world.setSpring(arm.hinge, 0, 100, 0.3);
    w.run(8);
    CHECK(arm.angle() == Approx(0.3).margin(1e-4));
    CHECK(arm.sleeps() == w.can.sleeps);
  });
}

TEST_CASE("a motor against its stop sleeps") {
  withArms([](EngineWorld& w, Arm& arm) {
    w.stops(arm.hinge, 0, -0.1, 0.1);
    w.motor(arm.hinge, 0, 1, 5);
    w.run(3);
    CHECK(arm.angle() == Approx(0.1).margin(0.02));
    CHECK(arm.sleeps() == w.can.sleeps);
  });
}

TEST_CASE("a load on a slow lift rides with it") {
  withEngines(
      [](EngineWorld& w) {
        w.setGravity(9.81, true);
        const BodyHandle lift = w.block({0, 0, 1}, {2, 2, 0.2}, 10);
        const JointHandle slider = w.world.createJoint(JointType::slider);
        w.world.attach(slider, lift, BodyHandle::none);
        w.world.setAxis(slider, 0, Vec3::UnitZ());
        w.motor(slider, 0, kSlow, 1e4);
        w.world.setParameter(slider, JointParameter::cfm, 0, 1e-9);  // it does not give way
        const BodyHandle load = w.block({0.3, 0, 1.2999}, {0.4, 0.4, 0.4}, 100);
        w.run(1);
        const double before = w.position(load).z();
        w.run(4);
        CHECK(w.position(load).z() - before == Approx(4 * kSlow).margin(1e-3));
      },
      {&engine::Capabilities::joints, &engine::Capabilities::rotation});
}

TEST_CASE("a run that is restored while an idle body is watched goes on bit for bit") {
  withEngines(
      [](EngineWorld& any) {
        if (!any.can.stateless) return;
        EngineWorld a(any.kind), b(any.kind);
        Arm first(a), second(b);
        const auto start = [](Arm& arm) {
          arm.w.world.setParameter(arm.hinge, JointParameter::damping, 0, 200);
          arm.w.world.setSpring(arm.hinge, 0, 100, 0.02);
        };
        start(first), start(second);
        // Which step of the watch the copy begins with is another one each time.
        a.run(6.03);
        const BodyHandle from[] = {first.bar, first.load}, to[] = {second.bar, second.load};
        for (int i = 0; i < 2; ++i) {
          std::vector<double> numbers;
          a.world.saveBody(from[i], numbers);
          b.world.loadBody(to[i], numbers);
          b.world.loadSupport(to[i], a.world.saveSupport(from[i]));
        }
        b.stepper.settle(*b.engine, b.collision);
        for (int i = 0; i < 1500; ++i) {
          a.run(a.dt), b.run(b.dt);
          REQUIRE(a.saved(from) == b.saved(to));
        }
        CHECK(first.sleeps() == a.can.sleeps);
      },
      {&engine::Capabilities::joints});
}
