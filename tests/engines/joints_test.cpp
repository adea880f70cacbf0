#include "engine_world.h"

// Joints, in each engine that supports them.

using namespace spark;
using namespace spark::test;

namespace {

/// A child body, and a parent that is fixed to the world, without gravity.
struct Pair {
  EngineWorld& w;
  BodyHandle child, parent;
  explicit Pair(EngineWorld& world) : w(world), child(w.body({0, 0, 0})), parent(w.body({0, 0, 1})) {
    w.setGravity(0);
    w.joint(JointType::fixed, parent, BodyHandle::none, {0, 0, 1});
  }
  /// Distance from the anchor to the child's point that was there at first.
  double apart() const {
    const engine::BodyState s = w.world.state(child);
    return (s.position + s.rotation * Vec3(0, 0, 0.5) - Vec3(0, 0, 0.5)).norm();
  }
};

void withPairs(const std::function<void(EngineWorld&, Pair&)>& f,
               std::initializer_list<bool engine::Capabilities::*> needs = {&engine::Capabilities::joints}) {
  withEngines(
      [&](EngineWorld& w) {
        Pair pair(w);
        f(w, pair);
      },
      needs);
}

}  // namespace

TEST_CASE("each joint type leaves exactly its degrees of freedom") {
  // Whether rotations of the child about x, y and z, and its translation along z, are free.
  struct Freedom {
    JointType type;
    bool turns[3], slides;
  };
  for (const Freedom& free :
       {Freedom{JointType::ball, {true, true, true}, false}, Freedom{JointType::hinge, {false, false, true}, false},
        Freedom{JointType::universal, {true, false, true}, false},
        Freedom{JointType::slider, {false, false, false}, true},
        Freedom{JointType::fixed, {false, false, false}, false}})
    for (int direction = 0; direction < 4; ++direction)
      withPairs([&](EngineWorld& w, const Pair& p) {
        CAPTURE(int(free.type), direction);
        w.joint(free.type, p.child, p.parent, {0, 0, 0.5});
        if (direction < 3)
          w.world.setAngularVelocity(p.child, 0.5 * Vec3::Unit(direction));
        else
          w.world.setLinearVelocity(p.child, {0, 0, 0.5});
        w.run(0.1);
        const double speed = direction < 3 ? w.spin(p.child)[direction] : w.velocity(p.child).z();
        const bool expected = direction < 3 ? free.turns[direction] : free.slides;
        if (expected)
          CHECK(speed > 0.05);
        else
          CHECK(std::abs(speed) < 0.01);
        if (free.type != JointType::slider) CHECK(p.apart() < 2e-3);
      });
}

TEST_CASE("a hinge's angle and rate are those of the first body relative to the second") {
  withPairs([](EngineWorld& w, const Pair& p) {
    const JointHandle j = w.joint(JointType::hinge, p.child, p.parent, {0, 0, 0.5});
    w.world.setAngularVelocity(p.child, {0, 0, 1});
    w.run(0.5);
    CHECK(w.world.at(j).angle(0) == Approx(0.5).margin(0.01));
    CHECK(w.world.at(j).angleRate(0) == Approx(1).margin(0.01));
  });
}

TEST_CASE("a motor reaches its speed, has no more than its maximum force, and does not pass a stop") {
  for (const JointType type : {JointType::hinge, JointType::universal, JointType::slider})
    withPairs([&](EngineWorld& w, const Pair& p) {
      CAPTURE(int(type));
      const JointHandle j = w.joint(type, p.child, p.parent, {0, 0, 0.5});
      w.motor(j, 0, 1.5, 100);
      w.run(0.2);
      CHECK(w.world.at(j).angleRate(0) == Approx(1.5).epsilon(0.02));
      w.stops(j, 0, -0.4, 0.8);
      w.run(2);
      CHECK(w.world.at(j).angle(0) == Approx(0.8).margin(0.02));
      CHECK(w.world.at(j).atStop(0));
      w.motor(j, 0, -1.5, 100);
      w.run(2);
      CHECK(w.world.at(j).angle(0) == Approx(-0.4).margin(0.02));
    });
  withPairs([](EngineWorld& w, const Pair& p) {
    const JointHandle j = w.joint(JointType::hinge, p.child, p.parent, {0, 0, 0.5});
    w.motor(j, 0, 100, 0.05);
    w.run(1);
    CHECK(w.world.at(j).angleRate(0) == Approx(0.5).epsilon(0.02));  // 0.05 Nm for 1 s on 0.1 kg m^2
  });
}

TEST_CASE("a wheel rolls at its motor's speed, keeps a locked steering angle, and has a suspension") {
  withPairs([](EngineWorld& w, const Pair& p) {
    const BodyHandle wheel = w.body({0, 0.5, 1}, 1, Mat3::Identity() * 0.02);
    const JointHandle j = w.joint(JointType::hinge2, p.parent, wheel, {0, 0.5, 1}, Vec3::UnitZ(), Vec3::UnitX());
    w.motor(j, 1, 3, 50);
    w.stops(j, 0, 0, 0);
    w.run(1);
    CHECK(std::abs(w.world.at(j).angleRate(1)) == Approx(3).epsilon(0.02));
    CHECK(std::abs(w.world.at(j).angle(0)) < 0.02);
    w.world.setParameter(j, JointParameter::suspensionErp, 0, 0.4);
    w.world.setParameter(j, JointParameter::suspensionCfm, 0, 0.05);
    w.world.addForce(wheel, {0, 0, 200});
    w.run(0.02);
    CHECK(w.position(wheel).z() > 1.005);
    w.run(1);
    CHECK(w.position(wheel).z() == Approx(1).margin(0.01));
  });
}

TEST_CASE("an axis of a wheel that becomes parallel to the other moves it aside") {
  withPairs([](EngineWorld& w, const Pair& p) {
    for (const int axis : {0, 1}) {
      const JointHandle j = w.joint(JointType::hinge2, p.child, p.parent, {0, 0, 0.5});
      w.world.setAxis(j, axis, w.world.at(j).axis(1 - axis), 0);
      CHECK(std::abs(w.world.at(j).axis(0).dot(w.world.at(j).axis(1))) < 1e-9);
      w.world.destroyJoint(j);
    }
  });
}

TEST_CASE("an angular motor drives its axes") {
  withPairs(
      [](EngineWorld& w, const Pair& p) {
        w.joint(JointType::ball, p.child, p.parent, {0, 0, 0.5});
        const JointHandle j = w.joint(JointType::angularMotor, p.child, p.parent, {0, 0, 0.5});
        w.motor(j, 0, 1.5, 50);
        w.motor(j, 1, 0, 50);
        w.run(0.3);
        CHECK(w.spin(p.child).z() == Approx(1.5).epsilon(0.02));
        CHECK(std::abs(w.spin(p.child).x()) < 0.02);
      },
      {&engine::Capabilities::joints, &engine::Capabilities::loops});
}

TEST_CASE("a hanging closed loop of bodies holds together") {
  withEngines(
      [](EngineWorld& w) {
        // A hanging ring of eight links.
        std::vector<BodyHandle> ring;
        const auto at = [](double i) { return Vec3(std::sin(i * kPi / 4), 0, 3 + std::cos(i * kPi / 4)); };
        for (int i = 0; i < 8; ++i) ring.push_back(w.body(at(i), 0.5, Mat3::Identity() * 0.01));
        w.joint(JointType::hinge, ring[0], BodyHandle::none, at(0), Vec3::UnitY());
        std::vector<JointHandle> joints;
        for (int i = 0; i < 8; ++i)
          joints.push_back(w.joint(JointType::hinge, ring[i], ring[(i + 1) % 8], at(i + 0.5), Vec3::UnitY()));
        w.run(2);
        for (int i = 0; i < 8; ++i) {
          const engine::Joint& j = w.world.model().joints[w.world.index(joints[i])];
          const engine::DynamicState &a = w.world.state().bodies[j.a], &b = w.world.state().bodies[j.b];
          CHECK((a.position + a.rotation * j.inA.anchor - b.position - b.rotation * j.inB.anchor).norm() < 0.02);
        }
      },
      {&engine::Capabilities::joints, &engine::Capabilities::loops});
}

TEST_CASE("a joint's feedback is the force that it carries") {
  withEngines(
      [](EngineWorld& w) {
        for (const bool worldFirst : {false, true}) {
          const BodyHandle b = w.body({5, worldFirst ? 3.0 : 0.0, 1}, 2);
          const JointHandle j = w.world.createJoint(JointType::fixed);
          if (worldFirst)
            w.world.attach(j, BodyHandle::none, b);
          else
            w.world.attach(j, b, BodyHandle::none);
          w.world.setFixed(j);
          w.world.setFeedback(j, true);
          w.run(1);
          Vec3 f1, t1, f2, t2;
          w.world.feedback(j, f1, t1, f2, t2);
          CHECK((worldFirst ? f2 : f1).z() == Approx(2 * 9.81).epsilon(0.01));
        }
      },
      {&engine::Capabilities::joints, &engine::Capabilities::jointForces});
}

TEST_CASE("a controller moves its axis to the target with at most its maximum force") {
  for (const JointType type : {JointType::hinge, JointType::slider})
    withPairs([&](EngineWorld& w, const Pair& p) {
      CAPTURE(int(type));
      const JointHandle j = w.joint(type, p.child, p.parent, {0, 0, 0.5});
      w.world.control(j, 0, {.stiffness = 20, .damping = 4, .position = 0.4});
      w.run(4);
      CHECK(w.world.at(j).angle(0) == Approx(0.4).margin(0.002));
      CHECK(std::abs(w.world.at(j).angleRate(0)) < 0.005);
      w.world.control(j, 0, {.stiffness = 20, .damping = 4, .position = -0.3});
      w.run(4);
      CHECK(w.world.at(j).angle(0) == Approx(-0.3).margin(0.002));
    });
  withPairs([](EngineWorld& w, const Pair& p) {
    const JointHandle j = w.joint(JointType::hinge, p.child, p.parent, {0, 0, 0.5});
    w.world.control(j, 0, {.stiffness = 1000, .position = 3, .maxForce = 0.05});
    w.run(1);
    CHECK(w.world.at(j).angleRate(0) == Approx(0.5).epsilon(0.01));  // 0.05 Nm for 1 s on 0.1 kg m^2
    w.world.control(j, 0, {.force = -0.05});
    w.run(1);
    CHECK(std::abs(w.world.at(j).angleRate(0)) < 0.005);
  });
}

TEST_CASE("damping slows an axis, dry friction holds it, and armature adds inertia if the engine supports it") {
  withPairs([](EngineWorld& w, const Pair& p) {
    const JointHandle j = w.joint(JointType::hinge, p.child, p.parent, {0, 0, 0.5});
    w.world.setParameter(j, JointParameter::damping, 0, 0.2);
    w.world.setAngularVelocity(p.child, {0, 0, 2});
    w.run(0.5);
    CHECK(w.world.at(j).angleRate(0) == Approx(2 * std::exp(-0.2 / 0.1 * 0.5)).epsilon(0.02));
  });
  withPairs([](EngineWorld& w, const Pair& p) {
    const JointHandle j = w.joint(JointType::hinge, p.child, p.parent, {0, 0, 0.5});
    w.world.setParameter(j, JointParameter::dryFriction, 0, 0.1);
    w.world.control(j, 0, {.force = 0.09});
    w.run(1);
    CHECK(std::abs(w.world.at(j).angleRate(0)) < 1e-3);
    w.world.control(j, 0, {.force = 0.15});
    w.run(1);
    CHECK(w.world.at(j).angleRate(0) == Approx(0.5).epsilon(0.02));
  });
  withPairs(
      [](EngineWorld& w, const Pair& p) {
        const JointHandle j = w.joint(JointType::hinge, p.child, p.parent, {0, 0, 0.5});
        w.world.setParameter(j, JointParameter::armature, 0, 0.3);
        w.world.control(j, 0, {.force = 0.2});
        w.run(1);
        CHECK(w.world.at(j).angleRate(0) == Approx(0.5).epsilon(0.01));  // 0.2 Nm for 1 s on 0.1 + 0.3 kg m^2
      },
      {&engine::Capabilities::joints, &engine::Capabilities::armature});
}

TEST_CASE("the damping of a ball joint acts about all directions, that of a body in the world") {
  for (const bool ofBody : {false, true})
    for (const bool childFirst : {false, true})
      withPairs([&](EngineWorld& w, const Pair& p) {
        CAPTURE(ofBody, childFirst);
        const JointHandle j =
            w.joint(JointType::ball, childFirst ? p.child : p.parent, childFirst ? p.parent : p.child, {0, 0, 0});
        if (ofBody)
          w.world.setDamping(p.child, 0, 0.2);
        else
          w.world.setParameter(j, JointParameter::damping, 0, 0.2);
        const Vec3 spin(1, -2, 0.5);
        w.world.setAngularVelocity(p.child, spin);
        w.run(0.5);
        CHECK((w.spin(p.child) - spin * std::exp(-0.2 / 0.1 * 0.5)).norm() < 0.02 * spin.norm());
      });
}

TEST_CASE("the damping of a body beside its hinge slows all that turns with it") {
  withPairs([](EngineWorld& w, const Pair& p) {
    w.joint(JointType::hinge, p.child, BodyHandle::none, {0.5, 0, 0});
    w.world.setDamping(p.child, 0, 1);
    w.world.setAngularVelocity(p.child, {0, 0, 1});
    w.world.setLinearVelocity(p.child, {0, -0.5, 0});
    w.run(0.2);
    // 1 kg 0.5 m from the hinge, and 0.1 kg m^2 of its own.
    CHECK(w.spin(p.child).z() == Approx(std::exp(-0.2 / 0.35)).epsilon(0.03));
  });
}

TEST_CASE("a controller moves each axis of a joint to the target, with either order of bodies and with the world") {
  for (const JointType type : {JointType::hinge, JointType::slider, JointType::universal, JointType::hinge2})
    for (const int order : {0, 1, 2, 3})
      for (int axis = 0; axis < engine::axesOf(type); ++axis)
        withPairs([&](EngineWorld& w, const Pair& p) {
          if (type == JointType::hinge2 && order > 1) return;  // a wheel needs two bodies
          CAPTURE(int(type), order, axis);
          const BodyHandle none = BodyHandle::none;
          const std::pair<BodyHandle, BodyHandle> orders[] = {
              {p.child, p.parent}, {p.parent, p.child}, {p.child, none}, {none, p.child}};
          const JointHandle j = w.joint(type, orders[order].first, orders[order].second, {0, 0, 0.5});
          w.world.control(j, 1 - axis, {.stiffness = 20, .damping = 4});
          w.world.control(j, axis, {.stiffness = 20, .damping = 4, .position = 0.3});
          w.run(4);
          CHECK(w.world.at(j).angle(axis) == Approx(0.3).margin(0.02));
        });
}

TEST_CASE(
    "a joint drives, stops, brakes and holds its first body against the second, in each order of bodies, with the "
    "world, and where it closes a loop") {
  const BodyHandle none = BodyHandle::none;
  for (const JointType type : {JointType::hinge, JointType::slider, JointType::universal})
    for (const int order : {0, 1, 2, 3})
      for (const bool closes : {false, true})
        withPairs(
            [&](EngineWorld& w, const Pair& p) {
              if (type == JointType::universal && (closes || order == 3)) return;  // two would lock; axes change places
              CAPTURE(int(type), order, closes);
              const std::pair<BodyHandle, BodyHandle> orders[] = {
                  {p.child, p.parent}, {p.parent, p.child}, {p.child, none}, {none, p.child}};
              if (closes && !w.can.loops) return;
              if (closes) w.joint(type, p.child, none, {0, 0, 0.5});
              const JointHandle j = w.joint(type, orders[order].first, orders[order].second, {0, 0, 0.5});
              if (type == JointType::universal) w.world.control(j, 1, {.stiffness = 20, .damping = 4});
              const double direction = order % 2 == 0 ? 1 : -1;
              // Motor and stops of a hinge that is attached to the world first count the other way, as in ODE.
              const double sign = type == JointType::hinge && order == 3 ? -1 : 1;
              /// How far the child has moved along or about the axis.
              const auto moved = [&] {
                const engine::BodyState s = w.world.state(p.child);
                return type == JointType::slider ? s.position.z() : std::atan2(s.rotation(1, 0), s.rotation(0, 0));
              };
              const auto expect = [&](double where) {
                CHECK(w.world.at(j).angle(0) == Approx(where).margin(0.02));
                CHECK(moved() == Approx(direction * where).margin(0.02));
              };
              w.motor(j, 0, sign, 100);
              w.run(0.5);
              CHECK(w.world.at(j).angleRate(0) == Approx(1).epsilon(0.02));
              expect(0.5);
              w.stops(j, 0, sign > 0 ? -0.3 : -0.8, sign > 0 ? 0.8 : 0.3);
              w.run(0.5);
              expect(0.8);
              w.motor(j, 0, -sign, 100);
              w.run(1.3);
              expect(-0.3);
              // Without motor: a push is braked by damping, and held by dry friction that is stronger.
              w.motor(j, 0, 0, 0);
              const double inertia = type == JointType::slider ? 1 : 0.1;
              w.world.setParameter(j, JointParameter::damping, 0, 5 * inertia);
              const auto push = [&](double speed) {
                if (type == JointType::slider)
                  w.world.setLinearVelocity(p.child, {0, 0, direction * speed});
                else
                  w.world.setAngularVelocity(p.child, {0, 0, direction * speed});
              };
              push(1);
              w.run(1);
              expect(-0.3 + 1.0 / 5);  // the way that damping leaves
              w.world.setParameter(j, JointParameter::damping, 0, 0);
              w.world.setParameter(j, JointParameter::dryFriction, 0, 2 * inertia);
              push(1);
              w.run(0.7);
              expect(-0.1 + 1.0 / (2 * 2));  // half the square of the speed by the deceleration
            },
            {&engine::Capabilities::joints});
}

TEST_CASE("joints keep their positions when another body is created and destroyed") {
  for (const JointType type : {JointType::hinge, JointType::slider, JointType::universal, JointType::hinge2})
    for (const bool parentFirst : {false, true})
      withPairs([&](EngineWorld& w, const Pair& p) {
        CAPTURE(int(type), parentFirst);
        const JointHandle j =
            w.joint(type, parentFirst ? p.parent : p.child, parentFirst ? p.child : p.parent, {0, 0, 0.5});
        w.world.control(j, 0, {.stiffness = 20, .damping = 4, .position = 0.25});
        w.world.addForce(p.child, {0, 0, 3});
        w.run(3);
        const double before = w.world.at(j).angle(0);
        const Vec3 position = w.position(p.child);
        CHECK(before == Approx(0.25).margin(0.02));
        const BodyHandle other = w.body({9, 9, 9});
        w.run(w.dt);
        w.world.destroyBody(other);
        w.run(w.dt);
        CHECK(w.world.at(j).angle(0) == Approx(before).margin(1e-3));
        CHECK((w.position(p.child) - position).norm() < 1e-3);
      });
}

TEST_CASE("an axis has one command: the last one counts") {
  withPairs([](EngineWorld& w, const Pair& p) {
    const JointHandle j = w.joint(JointType::hinge, p.child, p.parent, {0, 0, 0.5});
    const auto rate = [&] { return w.run(1), w.world.at(j).angleRate(0); };
    w.motor(j, 0, 1, 10);
    CHECK(rate() == Approx(1).epsilon(0.05));
    w.world.control(j, 0, {.damping = 10, .velocity = -2});
    CHECK(w.world.parameter(j, JointParameter::maxForce, 0) == 0);
    CHECK(rate() == Approx(-2).epsilon(0.05));
    // A speed alone is a motor without force.
    w.world.drive(j, 0, 1);
    CHECK(w.world.controlOf(j, 0) == nullptr);
    CHECK(rate() == Approx(-2).epsilon(0.05));
    w.motor(j, 0, 1, 10);
    CHECK(rate() == Approx(1).epsilon(0.05));
  });
}

TEST_CASE("dry friction acts from the step in which it is set, and while no motor does") {
  withPairs([](EngineWorld& w, const Pair& p) {
    const JointHandle j = w.joint(JointType::hinge, p.child, p.parent, {0, 0, 0.5});
    const auto rate = [&] { return w.run(0.5), w.world.at(j).angleRate(0); };
    for (const bool controlled : {false, true}) {
      CAPTURE(controlled);
      if (controlled) w.world.control(j, 0, {});
      w.world.setParameter(j, JointParameter::dryFriction, 0, 0);
      w.world.setAngularVelocity(p.child, w.spin(p.parent) + Vec3(0, 0, 1));
      const double free = rate();
      CHECK(std::abs(free) > 0.5);
      w.world.setParameter(j, JointParameter::dryFriction, 0, 50);
      CHECK(std::abs(rate()) < 0.02);
    }
    // It is no motor's force.
    CHECK(w.world.parameter(j, JointParameter::maxForce, 0) == 0);
    w.motor(j, 0, 1, 100);
    CHECK(rate() == Approx(1).epsilon(0.05));
  });
}

TEST_CASE(
    "a controller that a motor replaced has no effect, and a controller accumulates no torque on a sleeping body") {
  withPairs([](EngineWorld& w, const Pair& p) {
    const JointHandle j = w.joint(JointType::hinge, p.child, p.parent, {0, 0, 0.5});
    w.world.control(j, 0, {.force = 0.1});
    w.run(0.5);
    const double rate = w.world.at(j).angleRate(0);
    CHECK(rate == Approx(0.5).epsilon(0.05));
    w.world.setParameter(j, JointParameter::maxForce, 0, 0);
    CHECK(w.world.controlOf(j, 0) == nullptr);
    w.run(1);
    CHECK(w.world.at(j).angleRate(0) == Approx(rate).epsilon(0.05));
  });
  withPairs(
      [](EngineWorld& w, const Pair& p) {
        const JointHandle j = w.joint(JointType::hinge, p.child, p.parent, {0, 0, 0.5});
        w.world.control(j, 0, {.stiffness = 20, .damping = 2, .position = 0.001});
        w.setGravity(0, true);
        const BodyHandle flying = w.body({9, 9, 9});
        w.world.setLinearVelocity(flying, {1, 0, 0});
        w.run(20);
        CHECK_FALSE(w.world.enabled(p.child));
        CHECK(w.world.torque(p.child).norm() < 1);
      },
      {&engine::Capabilities::joints, &engine::Capabilities::sleeps});
}
