#include "engine_fixture.h"

using namespace spark;
using namespace spark::test;
using engine::Body;
using engine::Joint;
using engine::JointParameter;
using engine::JointType;

namespace {

/// Two unit bodies, the upper one fixed to the world, in no gravity.
struct Two : EngineHouse {
  Body child, parent;
  Two() {
    setGravity(0);
    child = body({0, 0, 0});
    parent = body({0, 0, 1});
    const Joint hold = ode.createJoint(world, JointType::fixed);
    ode.attach(hold, parent, Body::none);
    ode.setFixed(hold);
  }
  Joint joint(JointType type) {
    const Joint j = ode.createJoint(world, type);
    ode.attach(j, child, parent);
    ode.setAnchor(j, {0, 0, 0.5});
    return j;
  }
  void run(int steps) {
    for (int i = 0; i < steps; ++i) step(0.01);
  }
  /// How far the point of the child that was at the anchor is from it now.
  double apart() const {
    const auto s = ode.state(child);
    return (s.position + s.rotation * Vec3(0, 0, 0.5) - Vec3(0, 0, 0.5)).norm();
  }
};

}  // namespace

TEST_CASE("a ball joint keeps its point and lets all turns be") {
  Two two;
  two.joint(JointType::ball);
  two.ode.setAngularVelocity(two.child, {0.4, 0.3, 0.8});
  two.run(50);
  CHECK(two.apart() < 1e-3);
  const Vec3 w = two.ode.state(two.child).angularVelocity;
  CHECK(std::abs(w.z()) > 0.5);
  CHECK(std::abs(w.x()) > 0.1);
}

TEST_CASE("a hinge rotates about its axis only; angle and rate are those of the first body relative to the second") {
  Two two;
  const Joint j = two.joint(JointType::hinge);
  two.ode.setAxis(j, 0, {0, 0, 1}, 0);
  CHECK(two.ode.axis(j, 0).isApprox(Vec3(0, 0, 1)));
  CHECK(two.ode.anchor(j).isApprox(Vec3(0, 0, 0.5)));
  two.ode.setAngularVelocity(two.child, {0.5, 0, 1});
  two.run(50);
  CHECK(two.apart() < 1e-3);
  CHECK(std::abs(two.ode.state(two.child).angularVelocity.x()) < 1e-3);
  CHECK(two.ode.angle(j, 0) == Approx(0.5).margin(0.02));
  CHECK(two.ode.angleRate(j, 0) == Approx(1).margin(0.02));
}

TEST_CASE("a hinge's motor drives it to its stop and not beyond") {
  Two two;
  const Joint j = two.joint(JointType::hinge);
  two.ode.setAxis(j, 0, {0, 0, 1}, 0);
  two.ode.setParameter(j, JointParameter::lowStop, 0, -0.3);
  two.ode.setParameter(j, JointParameter::highStop, 0, 0.7);
  two.ode.setParameter(j, JointParameter::stopErp, 0, 0.8);
  two.ode.setParameter(j, JointParameter::maxForce, 0, 100);
  two.ode.setParameter(j, JointParameter::velocity, 0, 2);
  two.run(20);
  CHECK(two.ode.angle(j, 0) == Approx(0.4).margin(0.03));
  two.run(100);
  CHECK(two.ode.angle(j, 0) == Approx(0.7).margin(0.02));
  two.ode.setParameter(j, JointParameter::velocity, 0, -2);
  two.run(200);
  CHECK(two.ode.angle(j, 0) == Approx(-0.3).margin(0.02));
}

TEST_CASE("driving a joint wakes its first body unless the speed is 0, and a joint detects that it is at a stop") {
  Two two;
  const Joint j = two.joint(JointType::hinge);
  two.ode.setAxis(j, 0, {0, 0, 1}, 0);
  two.ode.setParameter(j, JointParameter::lowStop, 0, -0.5);
  two.ode.setParameter(j, JointParameter::highStop, 0, 0.5);
  two.ode.setParameter(j, JointParameter::maxForce, 0, 1000);
  CHECK_FALSE(two.ode.atStop(j, 0));
  two.ode.setEnabled(two.child, false);
  two.ode.drive(j, 0, 0);
  CHECK_FALSE(two.ode.enabled(two.child));
  two.ode.drive(j, 0, 2);
  CHECK(two.ode.enabled(two.child));
  CHECK(two.ode.parameter(j, JointParameter::velocity, 0) == 2);
  two.run(50);
  CHECK(two.ode.atStop(j, 0));
  CHECK_FALSE(two.ode.atStop(j, 1));
  two.ode.drive(j, 0, -2);
  two.run(10);
  CHECK_FALSE(two.ode.atStop(j, 0));
}

TEST_CASE("with exact replay the last bits at a stop are those of single-precision degrees") {
  EngineHouse house;
  for (const bool exact : {false, true}) {
    INFO((exact ? "exact" : "not exact"));
    setProperty(house.kernel.root().require<Leaf>("/sys/server/physics/engine"), "exactReplay", exact);
    const engine::World world = house.ode.createWorld();
    const Body foot = house.ode.createBody(world);
    const Joint j = house.ode.createJoint(world, JointType::hinge);
    house.ode.attach(j, foot, Body::none);
    house.ode.setAxis(j, 0, {0, 0, 1});
    const double stop = static_cast<float>(degToRad(75));
    house.ode.setParameter(j, JointParameter::highStop, 0, stop);
    house.ode.setParameter(j, JointParameter::lowStop, 0, -stop);
    int inside = 0, ignored = 0;
    for (const int sign : {-1, 1})
      for (int i = -40; i <= 40; ++i) {
        const double yaw = sign * (stop + i * 1e-8);
        Mat3 r;
        r << std::cos(yaw), -std::sin(yaw), 0, std::sin(yaw), std::cos(yaw), 0, 0, 0, 1;
        house.ode.setRotation(foot, r);
        const double angle = house.ode.angle(j, 0);
        REQUIRE(std::abs(angle - yaw) < 1e-6);
        const float deg = static_cast<float>(radToDeg(angle));
        const bool atStop = exact ? std::abs(deg) >= stop * 180 / kPi : std::abs(angle) >= stop;
        CHECK(house.ode.atStop(j, 0) == atStop);
        if (std::abs(angle) < stop) ++inside, ignored += house.ode.atStop(j, 0);
      }
    CHECK(inside > 0);
    CHECK((ignored > 0) == exact);  // 75 degrees, as they are rounded, are beyond the stop
  }
}

TEST_CASE("a motor is as strong as its maximal force") {
  Two two;
  const Joint j = two.joint(JointType::hinge);
  two.ode.setAxis(j, 0, {0, 0, 1}, 0);
  two.ode.setParameter(j, JointParameter::maxForce, 0, 0.5);
  two.ode.setParameter(j, JointParameter::velocity, 0, 100);
  two.run(100);
  CHECK(two.ode.angleRate(j, 0) == Approx(0.5).margin(0.01));  // 0.5 Nm for 1 s on 1 kg m^2
}

TEST_CASE("every parameter of every axis reads back what was set") {
  Two two;
  for (const auto& [type, axes] : {std::pair{JointType::hinge, 1},
                                   {JointType::slider, 1},
                                   {JointType::universal, 2},
                                   {JointType::hinge2, 2},
                                   {JointType::angularMotor, 3}}) {
    const Joint j = two.ode.createJoint(two.world, type);
    two.ode.attach(j, two.child, two.parent);
    if (type == JointType::angularMotor) two.ode.setAngularMotor(j, 3, false);
    for (int axis = 0; axis < axes; ++axis)
      for (const auto p : {JointParameter::lowStop, JointParameter::highStop, JointParameter::velocity,
                           JointParameter::maxForce, JointParameter::fudgeFactor, JointParameter::bounce,
                           JointParameter::cfm, JointParameter::stopErp, JointParameter::stopCfm}) {
        const double v = 0.01 * (static_cast<int>(p) + 1) + 0.1 * axis;
        INFO("type " << int(type) << " axis " << axis << " parameter " << int(p));
        two.ode.setParameter(j, p, axis, v);
        CHECK(two.ode.parameter(j, p, axis) == Approx(v));
      }
    two.ode.setParameter(j, JointParameter::lowStop, axes, 1);
    CHECK(two.ode.parameter(j, JointParameter::lowStop, axes) == 0);
    two.ode.destroyJoint(j);
  }
  const Joint wheel = two.joint(JointType::hinge2);
  two.ode.setParameter(wheel, JointParameter::suspensionErp, 0, 0.4);
  two.ode.setParameter(wheel, JointParameter::suspensionCfm, 0, 0.02);
  CHECK(two.ode.parameter(wheel, JointParameter::suspensionErp, 0) == Approx(0.4));
  CHECK(two.ode.parameter(wheel, JointParameter::suspensionCfm, 0) == Approx(0.02));
}

TEST_CASE("a universal joint turns about both axes and not about the third") {
  Two two;
  const Joint j = two.joint(JointType::universal);
  two.ode.setAxis(j, 0, {1, 0, 0}, 0);
  two.ode.setAxis(j, 1, {0, 1, 0}, 0);
  two.ode.setAngularVelocity(two.child, {0.3, 0.2, 0.9});
  two.run(20);
  CHECK(two.apart() < 1e-2);
  CHECK(std::abs(two.ode.angle(j, 0)) > 0.02);
  CHECK(std::abs(two.ode.angle(j, 1)) > 0.02);
  CHECK(std::abs(two.ode.angleRate(j, 0)) > 0.1);
  CHECK(std::abs(two.ode.angleRate(j, 1)) > 0.05);
  CHECK(std::abs(two.ode.state(two.child).angularVelocity.z()) < 0.05);
}

TEST_CASE("a hinge2 steers about its first axis and spins about its second") {
  Two two;
  // ODE's hinge2: the first axis belongs to the first body, the second to the second.
  const Joint j = two.ode.createJoint(two.world, JointType::hinge2);
  two.ode.attach(j, two.parent, two.child);
  two.ode.setAnchor(j, {0, 0, 0});
  two.ode.setAxis(j, 0, {0, 0, 1}, 0);
  two.ode.setAxis(j, 1, {1, 0, 0}, 0);
  two.ode.setParameter(j, JointParameter::maxForce, 1, 50);
  two.ode.setParameter(j, JointParameter::velocity, 1, 3);
  two.ode.setParameter(j, JointParameter::lowStop, 0, 0);
  two.ode.setParameter(j, JointParameter::highStop, 0, 0);
  two.run(100);
  CHECK(std::abs(two.ode.angleRate(j, 1)) == Approx(3).margin(0.05));
  CHECK(std::abs(two.ode.state(two.child).angularVelocity.x()) == Approx(3).margin(0.05));
  CHECK(std::abs(two.ode.angle(j, 0)) < 0.02);
}

TEST_CASE("a slider slides along its axis, does not turn, and stops") {
  Two two;
  const Joint j = two.joint(JointType::slider);
  two.ode.setAxis(j, 0, {0, 0, 1}, 0);
  two.ode.setParameter(j, JointParameter::lowStop, 0, -0.5);
  two.ode.setParameter(j, JointParameter::highStop, 0, 0.5);
  two.ode.setLinearVelocity(two.child, {0.5, 0, -1});
  two.ode.setAngularVelocity(two.child, {0, 1, 0});
  two.run(20);
  CHECK(two.ode.angle(j, 0) == Approx(-0.2).margin(0.02));
  CHECK(two.ode.angleRate(j, 0) == Approx(-1).margin(0.05));
  CHECK(std::abs(two.position(two.child).x()) < 0.01);
  CHECK(two.ode.state(two.child).angularVelocity.norm() < 0.01);
  double lowest = 0;
  for (int i = 0; i < 100; ++i) {
    two.run(1);
    lowest = std::min(lowest, two.ode.angle(j, 0));
  }
  CHECK(lowest == Approx(-0.5).margin(0.02));
}

TEST_CASE("a fixed joint holds pose, also against the world in either order") {
  Two two;
  const Joint j = two.joint(JointType::fixed);
  two.ode.setFixed(j);
  const Body third = two.body({3, 0, 0});
  const Joint world = two.ode.createJoint(two.world, JointType::fixed);
  two.ode.attach(world, Body::none, third);
  two.ode.setFixed(world);
  two.ode.setLinearVelocity(two.child, {1, 0, 0});
  two.ode.setAngularVelocity(two.child, {0, 1, 0});
  two.ode.setLinearVelocity(third, {0, 1, 0});
  two.run(50);
  CHECK((two.position(two.child) - Vec3(0, 0, 0)).norm() < 0.02);
  CHECK((two.position(third) - Vec3(3, 0, 0)).norm() < 0.02);
}

TEST_CASE("an angular motor drives its axes") {
  Two two;
  two.joint(JointType::ball);
  const Joint j = two.ode.createJoint(two.world, JointType::angularMotor);
  two.ode.attach(j, two.child, two.parent);
  two.ode.setAngularMotor(j, 1, false);
  two.ode.setAxis(j, 0, {0, 0, 1}, 1);
  two.ode.setParameter(j, JointParameter::maxForce, 0, 50);
  two.ode.setParameter(j, JointParameter::velocity, 0, 1.5);
  two.ode.setMotorAngle(j, 0, 0.25);
  CHECK(two.ode.angle(j, 0) == Approx(0.25));
  two.run(50);
  CHECK(two.ode.angleRate(j, 0) == Approx(1.5).margin(0.01));
  CHECK(two.ode.state(two.child).angularVelocity.z() == Approx(1.5).margin(0.01));
  CHECK_THROWS_WITH(two.ode.setAngularMotor(j, 4, false), Catch::Contains("0 to 3"));
}

TEST_CASE("feedback is the load of a joint, whichever body comes first") {
  for (const bool worldFirst : {false, true}) {
    Two two;
    two.setGravity(9.81);
    const Body b = two.body({5, 0, 0});
    two.ode.setMass(b, {2.0, Vec3::Zero(), Mat3::Identity()});
    const Joint j = two.ode.createJoint(two.world, JointType::fixed);
    if (worldFirst)
      two.ode.attach(j, Body::none, b);
    else
      two.ode.attach(j, b, Body::none);
    two.ode.setFixed(j);
    Vec3 f1, t1, f2, t2;
    two.step();
    two.ode.feedback(j, f1, t1, f2, t2);
    CHECK(f1.isZero(0));
    two.ode.setFeedback(j, true);
    for (int i = 0; i < 100; ++i) two.step();
    two.ode.feedback(j, f1, t1, f2, t2);
    CHECK((worldFirst ? f2 : f1).z() == Approx(2 * 9.81).epsilon(0.01));
  }
}

TEST_CASE("a joint whose body died does nothing and asks nothing") {
  Two two;
  for (const auto type : {JointType::ball, JointType::hinge, JointType::hinge2, JointType::slider, JointType::universal,
                          JointType::fixed, JointType::angularMotor}) {
    const Body gone = two.body({0, 0, 0});
    const Joint j = two.ode.createJoint(two.world, type);
    CHECK(two.ode.angle(j, 0) == 0);
    two.ode.setAnchor(j, {0, 0, 0});
    two.ode.setAxis(j, 0, {0, 0, 1}, 1);
    two.ode.setFixed(j);
    two.ode.attach(j, gone, two.parent);
    two.ode.destroyBody(gone);
    CHECK(two.ode.angle(j, 0) == 0);
    CHECK(two.ode.angleRate(j, 0) == 0);
    CHECK(two.ode.axis(j, 0).isZero(0));
    CHECK(two.ode.anchor(j).isZero(0));
    two.step();
  }
  CHECK_THROWS_WITH(two.ode.attach(two.ode.createJoint(two.world, JointType::ball), two.child, two.child),
                    Catch::Contains("with itself"));
}

TEST_CASE("a wheel without a chassis is refused with a sentence; an axis makes room for one parallel to it") {
  Two two;
  const Joint j = two.ode.createJoint(two.world, JointType::hinge2);
  CHECK_THROWS_WITH(two.ode.attach(j, two.child, Body::none), Catch::Contains("needs two bodies"));
  CHECK_THROWS_WITH(two.ode.attach(j, Body::none, two.child), Catch::Contains("needs two bodies"));
  two.ode.attach(j, two.child, two.parent);
  two.ode.setAxis(j, 0, {0, 3, 0}, 0);  // where the second axis is from the beginning
  CHECK(two.ode.axis(j, 0).isApprox(Vec3(0, 1, 0)));
  CHECK(std::abs(two.ode.axis(j, 1).y()) < 1e-9);
  two.ode.setAxis(j, 1, {0, -2, 0}, 0);
  CHECK(two.ode.axis(j, 1).isApprox(Vec3(0, -1, 0)));
  two.ode.setAxis(j, 0, {0, 0, 1}, 0);
  two.run(3);
}
