#include "engine_world.h"

// The coordinates of joints are continuous: turns are counted, and stops, controllers and motors work on the sum.

using namespace spark;
using namespace spark::test;

namespace {

/// A child that can turn about z through its centre, without gravity. Its parent is fixed to the world, or is the
/// world. `reversed`: the child is the second body of the joint.
struct Rotor {
  EngineWorld& w;
  BodyHandle child, parent = BodyHandle::none;
  JointHandle joint;
  Rotor(EngineWorld& world, JointType type, bool toWorld, bool reversed) : w(world), child(w.body({0, 0, 0})) {
    w.setGravity(0);
    if (!toWorld) {
      parent = w.body({0, 0, 1});
      w.joint(JointType::fixed, parent, BodyHandle::none, {0, 0, 1});
    }
    joint = w.joint(type, reversed ? parent : child, reversed ? child : parent, {0, 0, 0});
  }
  double angle(int axis = 0) const { return w.world.at(joint).angle(axis); }
  /// Turns the axis with a motor.
  void drive(double speed, double seconds, int axis = 0) {
    w.motor(joint, axis, speed, 50);
    w.run(seconds);
  }
};

template <class F>
void withRotors(F&& f, JointType type = JointType::hinge) {
  for (const bool toWorld : {false, true})
    for (const bool reversed : {false, true})
      withEngines(
          [&](EngineWorld& w) {
            CAPTURE(toWorld, reversed);
            Rotor r(w, type, toWorld, reversed);
            f(w, r);
          },
          {&engine::Capabilities::joints});
}

double rad(double degrees) { return degrees * kPi / 180; }

}  // namespace

TEST_CASE("a hinge counts its turns in both directions") {
  withRotors([](EngineWorld&, Rotor& r) {
    r.drive(6, 3);
    const double there = r.angle();
    CHECK(std::abs(there) == Approx(18).margin(0.5));
    r.drive(-6, 6);
    CHECK(r.angle() == Approx(there - std::copysign(36, there)).margin(0.7));
    const double within = r.w.world.at(r.joint).angleOfPoses(0);
    CHECK(std::abs(within) <= kPi + 1e-9);
    CHECK(std::remainder(r.angle() - within, 2 * kPi) == Approx(0).margin(1e-9));
  });
}

TEST_CASE("a stop holds at any angle and at any speed at which a step does not pass it whole") {
  for (const double degrees : {100.0, 178.0, 180.0, 181.0, 200.0, 270.0, 359.0, 360.0, 400.0, 900.0})
    for (const double speed : {2.0, 12.0})
      withRotors([&](EngineWorld& w, Rotor& r) {
        CAPTURE(degrees, speed);
        const double limit = rad(degrees);
        w.stops(r.joint, 0, -limit, limit);
        // The stops of a reversed hinge have the opposite sign of its angle, so both ends are tried.
        for (const double direction : {1.0, -1.0}) {
          r.drive(direction * speed, 2 * limit / speed + 2);
          CHECK(std::abs(r.angle()) == Approx(limit).margin(0.03));
          CHECK(std::abs(w.spin(r.child).z()) < 0.01);
          CHECK(w.world.at(r.joint).atStop(0));
        }
      });
}

TEST_CASE("a free body that hits a stop beyond half a turn comes to rest within its range") {
  withRotors([](EngineWorld& w, Rotor& r) {
    w.stops(r.joint, 0, rad(-190), rad(190));
    w.world.setAngularVelocity(r.child, {0, 0, 8});
    w.run(0.3);
    double most = 0;
    for (int i = 0; i < 500; ++i) {
      w.run(w.dt);
      most = std::max(most, std::abs(r.angle()));
    }
    CHECK(most < rad(205));
  });
}

TEST_CASE("a controller reaches a target several turns away, and comes back") {
  withRotors([](EngineWorld& w, Rotor& r) {
    engine::Control c{.stiffness = 4, .damping = 1.2, .position = 15};
    w.world.control(r.joint, 0, c);
    w.run(10);
    CHECK(r.angle() == Approx(15).margin(0.02));
    c.position = -9;
    w.world.control(r.joint, 0, c);
    w.run(10);
    CHECK(r.angle() == Approx(-9).margin(0.02));
  });
}

TEST_CASE("a spring pulls towards its position, turns away from the start, beside motor and controller") {
  withRotors([](EngineWorld& w, Rotor& r) {
    w.world.setSpring(r.joint, 0, 2, 8);
    w.world.setParameter(r.joint, JointParameter::damping, 0, 0.5);
    w.run(15);
    CHECK(r.angle() == Approx(8).margin(0.02));
    // The controller's limit of force is not the spring's.
    w.world.control(r.joint, 0, {.force = 1, .maxForce = 0.5});
    w.run(15);
    CHECK(r.angle() == Approx(8.25).margin(0.02));
  });
}

TEST_CASE("turns survive a new engine, another structure of the world, and poses that are set") {
  withRotors([](EngineWorld& w, Rotor& r) {
    r.drive(6, 3);
    r.drive(0, 0.5);
    const double angle = r.angle();
    REQUIRE(std::abs(angle) > 2 * kPi);
    w.replaceEngine();
    w.run(0.1);
    CHECK(r.angle() == Approx(angle).margin(1e-3));
    const BodyHandle other = w.block({5, 0, 0}, {1, 1, 1});
    w.run(0.1);
    CHECK(r.angle() == Approx(angle).margin(1e-3));
    w.world.destroyBody(other);
    w.run(0.1);
    CHECK(r.angle() == Approx(angle).margin(1e-3));
    // A pose that is set changes the coordinate by less than half a turn.
    const Mat3 turned = Eigen::AngleAxisd(1, Vec3::UnitZ()) * w.world.state(r.child).rotation;
    w.world.setRotation(r.child, turned);
    CHECK(std::abs(r.angle() - angle) == Approx(1).margin(1e-3));
    w.run(0.1);
    CHECK(std::abs(r.angle() - angle) == Approx(1).margin(1e-2));
  });
}

TEST_CASE("a saved coordinate is restored with its turns, before or after the poses") {
  for (const bool posesFirst : {true, false})
    withRotors([&](EngineWorld& w, Rotor& r) {
      CAPTURE(posesFirst);
      r.drive(6, 3);
      r.drive(0, 0.5);
      const double angle = r.angle(), coordinate = w.world.at(r.joint).coordinate(0);
      std::vector<double> state;
      w.world.saveBody(r.child, state);
      r.drive(-5, 4);
      r.drive(0, 0.5);
      REQUIRE(std::abs(r.angle() - angle) > 2 * kPi);
      if (posesFirst) w.world.loadBody(r.child, state);
      w.world.loadCoordinate(r.joint, 0, coordinate);
      if (!posesFirst) w.world.loadBody(r.child, state);
      CHECK(r.angle() == Approx(angle).margin(1e-9));
      w.run(0.1);
      CHECK(r.angle() == Approx(angle).margin(1e-3));
    });
}

TEST_CASE("setting the axis of a joint begins at 0 again") {
  withRotors([](EngineWorld& w, Rotor& r) {
    r.drive(6, 3);
    w.world.setAxis(r.joint, 0, {0, 0, 1});
    CHECK(r.angle() == Approx(0).margin(1e-9));
  });
}

TEST_CASE("both axes of a universal joint count their turns and have stops beyond half a turn") {
  for (const int axis : {0, 1})
    withRotors(
        [&](EngineWorld& w, Rotor& r) {
          CAPTURE(axis);
          // The other axis stays where it is.
          w.motor(r.joint, 1 - axis, 0, 50);
          r.drive(5, 3, axis);
          const bool swapped = std::abs(r.angle(axis)) < 1;  // in a reversed joint the motor of the other axis
          const int turned = swapped ? 1 - axis : axis;
          CHECK(std::abs(r.angle(turned)) == Approx(15).margin(0.5));
          w.stops(r.joint, axis, rad(-1000), rad(1000));
          r.drive(5, 5, axis);
          CHECK(std::abs(r.angle(turned)) == Approx(rad(1000)).margin(0.03));
        },
        JointType::universal);
}

TEST_CASE("the steering angle of a wheel and the angle of its rotation count turns") {
  withEngines(
      [](EngineWorld& w) {
        w.setGravity(0);
        const BodyHandle wheel = w.body({0, 0, 0}), chassis = w.body({0, 0, 1});
        w.joint(JointType::fixed, chassis, BodyHandle::none, {0, 0, 1});
        const JointHandle j = w.joint(JointType::hinge2, chassis, wheel, {0, 0, 0}, Vec3::UnitZ(), Vec3::UnitY());
        w.motor(j, 0, 0, 50);
        w.motor(j, 1, 5, 50);
        w.run(3);
        CHECK(std::abs(w.world.at(j).angle(1)) == Approx(15).margin(0.5));
        w.motor(j, 1, 0, 50);
        w.stops(j, 0, rad(-500), rad(500));
        w.motor(j, 0, 4, 50);
        w.run(4);
        CHECK(std::abs(w.world.at(j).angle(0)) == Approx(rad(500)).margin(0.05));
      },
      {&engine::Capabilities::joints});
}

TEST_CASE("an Euler motor counts the turns of its outer axes") {
  withEngines(
      [](EngineWorld& w) {
        w.setGravity(0);
        const BodyHandle child = w.body({0, 0, 0});
        const JointHandle ball = w.world.createJoint(JointType::ball);
        w.world.attach(ball, child, BodyHandle::none);
        w.world.setAnchor(ball, {0, 0, 0});
        const JointHandle j = w.world.createJoint(JointType::angularMotor);
        w.world.attach(j, child, BodyHandle::none);
        w.world.setAngularMotor(j, 3, true);
        w.world.setAxis(j, 0, {0, 0, 1}, 1);
        w.world.setAxis(j, 2, {1, 0, 0}, 2);
        for (int axis = 0; axis < 3; ++axis) w.motor(j, axis, 0, 50);
        w.motor(j, 0, 5, 50);
        w.run(3);
        CHECK(std::abs(w.world.at(j).angle(0)) == Approx(15).margin(0.5));
        w.stops(j, 0, rad(-1000), rad(1000));
        w.run(4);
        CHECK(std::abs(w.world.at(j).angle(0)) == Approx(rad(1000)).margin(0.05));
      },
      {&engine::Capabilities::joints, &engine::Capabilities::loops});
}
