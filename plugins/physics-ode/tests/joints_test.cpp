#include <Eigen/Geometry>

#include "engine_fixture.h"

using namespace spark;
using namespace spark::test;
using engine::JointParameter;
using engine::JointType;
using physics::BodyHandle;
using physics::JointHandle;

namespace {

/// Two unit bodies without gravity. The upper one is fixed to the world.
struct Two : EngineHost {
  BodyHandle child, parent;
  Two() {
    setGravity(0);
    child = body({0, 0, 0});
    parent = body({0, 0, 1});
    const JointHandle hold = world.createJoint(JointType::fixed);
    world.attach(hold, parent, BodyHandle::none);
    world.setFixed(hold);
  }
  JointHandle joint(JointType type) {
    const JointHandle j = world.createJoint(type);
    world.attach(j, child, parent);
    world.setAnchor(j, {0, 0, 0.5});
    return j;
  }
  void run(int steps) {
    for (int i = 0; i < steps; ++i) step(0.01);
  }
  /// Distance from the anchor to the child's point that was there at first.
  double apart() const {
    const auto s = world.state(child);
    return (s.position + s.rotation * Vec3(0, 0, 0.5) - Vec3(0, 0, 0.5)).norm();
  }
};

}  // namespace

TEST_CASE("a ball joint keeps its anchor and allows all rotations") {
  Two two;
  two.joint(JointType::ball);
  two.world.setAngularVelocity(two.child, {0.4, 0.3, 0.8});
  two.run(50);
  CHECK(two.apart() < 1e-3);
  const Vec3 w = two.world.state(two.child).angularVelocity;
  CHECK(std::abs(w.z()) > 0.5);
  CHECK(std::abs(w.x()) > 0.1);
}

TEST_CASE("a hinge rotates only about its axis; its angle and rate are of the first body relative to the second") {
  Two two;
  const JointHandle j = two.joint(JointType::hinge);
  two.world.setAxis(j, 0, {0, 0, 1}, 0);
  CHECK(two.world.at(j).axis(0).isApprox(Vec3(0, 0, 1)));
  CHECK(two.world.at(j).anchor().isApprox(Vec3(0, 0, 0.5)));
  two.world.setAngularVelocity(two.child, {0.5, 0, 1});
  two.run(50);
  CHECK(two.apart() < 1e-3);
  CHECK(std::abs(two.world.state(two.child).angularVelocity.x()) < 1e-3);
  CHECK(two.world.at(j).angle(0) == Approx(0.5).margin(0.02));
  CHECK(two.world.at(j).angleRate(0) == Approx(1).margin(0.02));
}

TEST_CASE("a hinge's angle follows its bodies, its axis and its turns, asleep and awake, with either order of bodies") {
  for (const bool asleep : {true, false})
    for (const bool swapped : {false, true}) {
      INFO((asleep ? "asleep" : "awake") << (swapped ? ", swapped" : ""));
      Two two;
      two.world.setAngularVelocity(two.body({9, 0, 0}), {0, 0, 1});  // so that there is something to be stepped
      const JointHandle first = two.world.createJoint(JointType::hinge), j = two.world.createJoint(JointType::hinge);
      swapped ? two.world.attach(j, BodyHandle::none, two.child) : two.world.attach(j, two.child, two.parent);
      two.world.setAxis(j, 0, {0, 0, 1});
      const auto turn = [&](double yaw) {
        two.world.setRotation(two.child, Eigen::AngleAxisd(yaw, Vec3::UnitZ()).toRotationMatrix());
      };
      const auto expect = [&](double yaw, double turns) {
        const double sign = swapped ? -1 : 1;
        for (int again = 0; again < 2; ++again) {
          CHECK(two.world.at(j).angleOfPoses(0) == Approx(sign * yaw).margin(1e-9));
          CHECK(two.world.at(j).angle(0) == Approx(sign * (yaw + 2 * kPi * turns)).margin(1e-9));
          CHECK(two.world.at(j).coordinate(0) == Approx(yaw + 2 * kPi * turns).margin(1e-9));
        }
      };
      const auto rest = [&] {
        two.world.setEnabled(two.child, !asleep);
        two.world.setEnabled(two.parent, !asleep);
      };
      rest();
      two.run(2);
      expect(0, 0);
      turn(0.5);
      expect(0.5, 0);
      two.run(2);
      expect(0.5, 0);
      turn(0.25);  // the angle is not read before the next step
      two.run(2);
      expect(0.25, 0);
      two.world.loadCoordinate(j, 0, 0.25 + 2 * kPi);
      expect(0.25, 1);
      two.run(2);
      expect(0.25, 1);
      two.world.destroyJoint(first);  // the hinge's index changes
      rest();
      two.run(2);
      expect(0.25, 1);
      two.world.setAxis(j, 0, {0, 0, 1});
      rest();
      expect(0, 0);
      two.run(2);
      expect(0, 0);
      turn(-0.75);
      two.run(1);
      expect(-1, 0);
      CHECK(two.world.enabled(two.child) == !asleep);
      two.world.attach(j, BodyHandle::none, BodyHandle::none);
      two.run(1);
      CHECK(two.world.at(j).angle(0) == 0);
    }
}

TEST_CASE("a hinge's motor drives it to its stop but not beyond") {
  Two two;
  const JointHandle j = two.joint(JointType::hinge);
  two.world.setAxis(j, 0, {0, 0, 1}, 0);
  two.world.setParameter(j, JointParameter::lowStop, 0, -0.3);
  two.world.setParameter(j, JointParameter::highStop, 0, 0.7);
  two.world.setParameter(j, JointParameter::stopErp, 0, 0.8);
  two.world.setParameter(j, JointParameter::maxForce, 0, 100);
  two.world.setParameter(j, JointParameter::velocity, 0, 2);
  two.run(20);
  CHECK(two.world.at(j).angle(0) == Approx(0.4).margin(0.03));
  two.run(100);
  CHECK(two.world.at(j).angle(0) == Approx(0.7).margin(0.02));
  two.world.setParameter(j, JointParameter::velocity, 0, -2);
  two.run(200);
  CHECK(two.world.at(j).angle(0) == Approx(-0.3).margin(0.02));
}

TEST_CASE("driving a joint wakes its first body unless the speed is 0, and atStop detects a stop") {
  Two two;
  const JointHandle j = two.joint(JointType::hinge);
  two.world.setAxis(j, 0, {0, 0, 1}, 0);
  two.world.setParameter(j, JointParameter::lowStop, 0, -0.5);
  two.world.setParameter(j, JointParameter::highStop, 0, 0.5);
  two.world.setParameter(j, JointParameter::maxForce, 0, 1000);
  CHECK_FALSE(two.world.at(j).atStop(0));
  two.world.setEnabled(two.child, false);
  two.world.drive(j, 0, 0);
  CHECK_FALSE(two.world.enabled(two.child));
  two.world.drive(j, 0, 2);
  CHECK(two.world.enabled(two.child));
  CHECK(two.world.parameter(j, JointParameter::velocity, 0) == 2);
  two.run(50);
  CHECK(two.world.at(j).atStop(0));
  CHECK_FALSE(two.world.at(j).atStop(1));
  two.world.drive(j, 0, -2);
  two.run(10);
  CHECK_FALSE(two.world.at(j).atStop(0));
}

TEST_CASE("with exact replay, atStop compares angles in single-precision degrees") {
  for (const bool exact : {false, true}) {
    INFO((exact ? "exact" : "not exact"));
    EngineHost host(exact);
    const BodyHandle foot = host.world.createBody();
    const JointHandle j = host.world.createJoint(JointType::hinge);
    host.world.attach(j, foot, BodyHandle::none);
    host.world.setAxis(j, 0, {0, 0, 1});
    const double stop = static_cast<float>(degToRad(75));
    host.world.setParameter(j, JointParameter::highStop, 0, stop);
    host.world.setParameter(j, JointParameter::lowStop, 0, -stop);
    int inside = 0, ignored = 0;
    for (const int sign : {-1, 1})
      for (int i = -40; i <= 40; ++i) {
        const double yaw = sign * (stop + i * 1e-8);
        Mat3 r;
        r << std::cos(yaw), -std::sin(yaw), 0, std::sin(yaw), std::cos(yaw), 0, 0, 0, 1;
        host.world.setRotation(foot, r);
        const double angle = host.world.at(j).angle(0);
        REQUIRE(std::abs(angle - yaw) < 1e-6);
        const float deg = static_cast<float>(radToDeg(angle));
        const bool atStop = exact ? std::abs(deg) >= stop * 180 / kPi : std::abs(angle) >= stop;
        CHECK(host.world.at(j).atStop(0) == atStop);
        if (std::abs(angle) < stop) ++inside, ignored += host.world.at(j).atStop(0);
      }
    CHECK(inside > 0);
    CHECK((ignored > 0) == exact);  // 75 degrees rounded to single precision are beyond the stop
  }
}

TEST_CASE("a motor has at most its maximum force") {
  Two two;
  const JointHandle j = two.joint(JointType::hinge);
  two.world.setAxis(j, 0, {0, 0, 1}, 0);
  two.world.setParameter(j, JointParameter::maxForce, 0, 0.5);
  two.world.setParameter(j, JointParameter::velocity, 0, 100);
  two.run(100);
  CHECK(two.world.at(j).angleRate(0) == Approx(0.5).margin(0.01));  // 0.5 Nm for 1 s on 1 kg m^2
}

TEST_CASE("each parameter of each axis returns the value that was set") {
  Two two;
  for (const auto& [type, axes] : {std::pair{JointType::hinge, 1},
                                   {JointType::slider, 1},
                                   {JointType::universal, 2},
                                   {JointType::hinge2, 2},
                                   {JointType::angularMotor, 3}}) {
    const JointHandle j = two.world.createJoint(type);
    two.world.attach(j, two.child, two.parent);
    if (type == JointType::angularMotor) two.world.setAngularMotor(j, 3, false);
    for (int axis = 0; axis < axes; ++axis)
      for (const auto p : {JointParameter::lowStop, JointParameter::highStop, JointParameter::velocity,
                           JointParameter::maxForce, JointParameter::fudgeFactor, JointParameter::bounce,
                           JointParameter::cfm, JointParameter::stopErp, JointParameter::stopCfm}) {
        const double v = 0.01 * (static_cast<int>(p) + 1) + 0.1 * axis;
        INFO("type " << int(type) << " axis " << axis << " parameter " << int(p));
        two.world.setParameter(j, p, axis, v);
        CHECK(two.world.parameter(j, p, axis) == Approx(v));
      }
    two.world.setParameter(j, JointParameter::lowStop, axes, 1);
    CHECK(two.world.parameter(j, JointParameter::lowStop, axes) == 0);
    two.world.destroyJoint(j);
  }
  const JointHandle wheel = two.joint(JointType::hinge2);
  two.world.setParameter(wheel, JointParameter::suspensionErp, 0, 0.4);
  two.world.setParameter(wheel, JointParameter::suspensionCfm, 0, 0.02);
  CHECK(two.world.parameter(wheel, JointParameter::suspensionErp, 0) == Approx(0.4));
  CHECK(two.world.parameter(wheel, JointParameter::suspensionCfm, 0) == Approx(0.02));
}

TEST_CASE("a universal joint rotates about both of its axes but not about the third") {
  Two two;
  const JointHandle j = two.joint(JointType::universal);
  two.world.setAxis(j, 0, {1, 0, 0}, 0);
  two.world.setAxis(j, 1, {0, 1, 0}, 0);
  two.world.setAngularVelocity(two.child, {0.3, 0.2, 0.9});
  two.run(20);
  CHECK(two.apart() < 1e-2);
  CHECK(std::abs(two.world.at(j).angle(0)) > 0.02);
  CHECK(std::abs(two.world.at(j).angle(1)) > 0.02);
  CHECK(std::abs(two.world.at(j).angleRate(0)) > 0.1);
  CHECK(std::abs(two.world.at(j).angleRate(1)) > 0.05);
  CHECK(std::abs(two.world.state(two.child).angularVelocity.z()) < 0.05);
}

TEST_CASE("a hinge2 steers about its first axis and spins about its second") {
  Two two;
  // In ODE's hinge2 the first axis belongs to the first body and the second axis to the second.
  const JointHandle j = two.world.createJoint(JointType::hinge2);
  two.world.attach(j, two.parent, two.child);
  two.world.setAnchor(j, {0, 0, 0});
  two.world.setAxis(j, 0, {0, 0, 1}, 0);
  two.world.setAxis(j, 1, {1, 0, 0}, 0);
  two.world.setParameter(j, JointParameter::maxForce, 1, 50);
  two.world.setParameter(j, JointParameter::velocity, 1, 3);
  two.world.setParameter(j, JointParameter::lowStop, 0, 0);
  two.world.setParameter(j, JointParameter::highStop, 0, 0);
  two.run(100);
  CHECK(std::abs(two.world.at(j).angleRate(1)) == Approx(3).margin(0.05));
  CHECK(std::abs(two.world.state(two.child).angularVelocity.x()) == Approx(3).margin(0.05));
  CHECK(std::abs(two.world.at(j).angle(0)) < 0.02);
}

TEST_CASE("a slider slides along its axis to its stop and does not rotate") {
  Two two;
  const JointHandle j = two.joint(JointType::slider);
  two.world.setAxis(j, 0, {0, 0, 1}, 0);
  two.world.setParameter(j, JointParameter::lowStop, 0, -0.5);
  two.world.setParameter(j, JointParameter::highStop, 0, 0.5);
  two.world.setLinearVelocity(two.child, {0.5, 0, -1});
  two.world.setAngularVelocity(two.child, {0, 1, 0});
  two.run(20);
  CHECK(two.world.at(j).angle(0) == Approx(-0.2).margin(0.02));
  CHECK(two.world.at(j).angleRate(0) == Approx(-1).margin(0.05));
  CHECK(std::abs(two.position(two.child).x()) < 0.01);
  CHECK(two.world.state(two.child).angularVelocity.norm() < 0.01);
  double lowest = 0;
  for (int i = 0; i < 100; ++i) {
    two.run(1);
    lowest = std::min(lowest, two.world.at(j).angle(0));
  }
  CHECK(lowest == Approx(-0.5).margin(0.02));
}

TEST_CASE("a fixed joint holds the pose, also relative to the world and with either order of bodies") {
  Two two;
  const JointHandle j = two.joint(JointType::fixed);
  two.world.setFixed(j);
  const BodyHandle third = two.body({3, 0, 0});
  const JointHandle world = two.world.createJoint(JointType::fixed);
  two.world.attach(world, BodyHandle::none, third);
  two.world.setFixed(world);
  two.world.setLinearVelocity(two.child, {1, 0, 0});
  two.world.setAngularVelocity(two.child, {0, 1, 0});
  two.world.setLinearVelocity(third, {0, 1, 0});
  two.run(50);
  CHECK((two.position(two.child) - Vec3(0, 0, 0)).norm() < 0.02);
  CHECK((two.position(third) - Vec3(3, 0, 0)).norm() < 0.02);
}

TEST_CASE("an angular motor drives its axes") {
  Two two;
  two.joint(JointType::ball);
  const JointHandle j = two.world.createJoint(JointType::angularMotor);
  two.world.attach(j, two.child, two.parent);
  two.world.setAngularMotor(j, 1, false);
  two.world.setAxis(j, 0, {0, 0, 1}, 1);
  two.world.setParameter(j, JointParameter::maxForce, 0, 50);
  two.world.setParameter(j, JointParameter::velocity, 0, 1.5);
  two.world.setMotorAngle(j, 0, 0.25);
  CHECK(two.world.at(j).angle(0) == Approx(0.25));
  two.run(50);
  CHECK(two.world.at(j).angleRate(0) == Approx(1.5).margin(0.01));
  CHECK(two.world.state(two.child).angularVelocity.z() == Approx(1.5).margin(0.01));
  CHECK_THROWS_WITH(two.world.setAngularMotor(j, 4, false), Catch::Contains("0 to 3"));
}

TEST_CASE("feedback is the force that a joint carries, with either order of bodies") {
  for (const bool worldFirst : {false, true}) {
    Two two;
    two.setGravity(9.81);
    const BodyHandle b = two.body({5, 0, 0});
    two.world.setMass(b, {2.0, Vec3::Zero(), Mat3::Identity()});
    const JointHandle j = two.world.createJoint(JointType::fixed);
    if (worldFirst)
      two.world.attach(j, BodyHandle::none, b);
    else
      two.world.attach(j, b, BodyHandle::none);
    two.world.setFixed(j);
    Vec3 f1, t1, f2, t2;
    two.step();
    two.world.feedback(j, f1, t1, f2, t2);
    CHECK(f1.isZero(0));
    two.world.setFeedback(j, true);
    for (int i = 0; i < 100; ++i) two.step();
    two.world.feedback(j, f1, t1, f2, t2);
    CHECK((worldFirst ? f2 : f1).z() == Approx(2 * 9.81).epsilon(0.01));
  }
}

TEST_CASE("a joint whose body is destroyed has no effect, and its values are 0") {
  Two two;
  for (const auto type : {JointType::ball, JointType::hinge, JointType::hinge2, JointType::slider, JointType::universal,
                          JointType::fixed, JointType::angularMotor}) {
    const BodyHandle gone = two.body({0, 0, 0});
    const JointHandle j = two.world.createJoint(type);
    CHECK(two.world.at(j).angle(0) == 0);
    two.world.setAnchor(j, {0, 0, 0});
    two.world.setAxis(j, 0, {0, 0, 1}, 1);
    two.world.setFixed(j);
    two.world.attach(j, gone, two.parent);
    two.world.destroyBody(gone);
    CHECK(two.world.at(j).angle(0) == 0);
    CHECK(two.world.at(j).angleRate(0) == 0);
    CHECK(two.world.at(j).axis(0).isZero(0));
    CHECK(two.world.at(j).anchor().isZero(0));
    two.step();
  }
  CHECK_THROWS_WITH(two.world.attach(two.world.createJoint(JointType::ball), two.child, two.child),
                    Catch::Contains("with itself"));
}

TEST_CASE("a wheel without a chassis is refused, and an axis is rotated away from a parallel one that is set") {
  Two two;
  const JointHandle j = two.world.createJoint(JointType::hinge2);
  CHECK_THROWS_WITH(two.world.attach(j, two.child, BodyHandle::none), Catch::Contains("needs two bodies"));
  CHECK_THROWS_WITH(two.world.attach(j, BodyHandle::none, two.child), Catch::Contains("needs two bodies"));
  two.world.attach(j, two.child, two.parent);
  two.world.setAxis(j, 0, {0, 3, 0}, 0);  // the initial direction of the second axis
  CHECK(two.world.at(j).axis(0).isApprox(Vec3(0, 1, 0)));
  CHECK(std::abs(two.world.at(j).axis(1).y()) < 1e-9);
  two.world.setAxis(j, 1, {0, -2, 0}, 0);
  CHECK(two.world.at(j).axis(1).isApprox(Vec3(0, -1, 0)));
  two.world.setAxis(j, 0, {0, 0, 1}, 0);
  two.run(3);
}
