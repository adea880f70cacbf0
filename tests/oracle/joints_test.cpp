#include "oracle_house.h"

using namespace spark;
using namespace spark::oracle;

namespace {

constexpr JointType kTypes[] = {JointType::ball,   JointType::hinge,     JointType::hinge2,
                                JointType::slider, JointType::universal, JointType::fixed};

/// How the axes of a chain's joints are driven and limited.
enum class Drive { none, motors, weakMotors, stops, motorsAndStops, locked };

void drive(OracleHost& h, JointHandle j, Drive how, int i) {
  for (int axis = 0; axis < 2; ++axis) {
    const double sign = (i + axis) % 2 ? 1 : -1;
    if (how == Drive::motors) h.motor(j, axis, 1.5 * sign, 40);
    if (how == Drive::weakMotors) h.motor(j, axis, 6 * sign, 0.3);
    if (how == Drive::stops) h.stops(j, axis, -0.2, 0.1, 0.5);
    if (how == Drive::motorsAndStops) h.stops(j, axis, -0.1, 0.1), h.motor(j, axis, 2 * sign, 20);
    if (how == Drive::locked) h.stops(j, axis, 0, 0), h.motor(j, axis, 1, 5);
  }
}

/// A chain of bodies with different orientations that hangs from the world or floats. `order`: which body is the first
/// one of each joint: 0 the older, 1 the newer, 2 alternating.
struct Chain : OracleHost {
  std::vector<BodyHandle> bodies;
  std::vector<JointHandle> joints;
  Chain(JointType type, int links, int order, Drive how, bool hangs = true, bool closed = false) {
    BodyHandle last = BodyHandle::none;
    for (int i = 0; i < links; ++i) {
      const double angle = closed ? 2 * M_PI * i / links : 0;
      const Vec3 at = closed ? Vec3(std::cos(angle), std::sin(angle), 3) : Vec3(0.4 * i, 0.02 * i, 3);
      const BodyHandle b = block(at, {0.3, 0.12, 0.1 + 0.01 * i}, 1 + 0.2 * (i % 3), true);
      world.setRotation(b, Mat3(Eigen::AngleAxisd(0.5 * i, Vec3(1, 2, 3).normalized())));
      world.setAngularVelocity(b, {0.3, 0.2 * (i % 3), -0.4});
      bodies.push_back(b);
      if (last != BodyHandle::none || hangs)
        connect(type, last, b, last == BodyHandle::none ? Vec3(at - Vec3(0.2, 0, 0)) : middle(last, b), order, how, i);
      last = b;
    }
    if (closed) connect(type, last, bodies[0], middle(last, bodies[0]), order, how, links);
  }
  Vec3 middle(BodyHandle a, BodyHandle b) const { return (position(a) + position(b)) / 2; }
  void connect(JointType type, BodyHandle a, BodyHandle b, const Vec3& at, int order, Drive how, int i) {
    if (a == BodyHandle::none && type == JointType::hinge2) type = JointType::universal;  // a wheel needs two bodies
    const bool turned = order == 1 || (order == 2 && i % 2);
    joints.push_back(turned ? join(type, b, a, at, 0.1 * i) : join(type, a, b, at, 0.1 * i));
    drive(*this, joints.back(), how, i);
  }
};

}  // namespace

TEST_CASE("chains of each joint type, with both orders of bodies, move as with ODE") {
  for (const JointType type : kTypes)
    for (const int order : {0, 1, 2}) {
      Chain c(type, 6, order, Drive::none);
      c.run(80);
      expectAgreement(fmt::format("chain of {}s, order {}", nameOf(type), order), c.shadow.agreement());
    }
}

TEST_CASE("motors and stops of each joint type act as with ODE") {
  const std::pair<Drive, const char*> ways[] = {{Drive::motors, "motors"},
                                                {Drive::weakMotors, "weak motors"},
                                                {Drive::stops, "stops"},
                                                {Drive::motorsAndStops, "motors at stops"},
                                                {Drive::locked, "locked"}};
  for (const JointType type : {JointType::hinge, JointType::hinge2, JointType::slider, JointType::universal})
    for (const auto& [how, name] : ways)
      for (const int order : {0, 1}) {
        Chain c(type, 6, order, how);
        c.run(80);
        expectAgreement(fmt::format("chain of {}s, {}, order {}", nameOf(type), name, order), c.shadow.agreement());
      }
}

TEST_CASE("floating chains move as with ODE") {
  for (const JointType type : kTypes) {
    Chain c(type, 7, 2, Drive::motors, false);
    c.setGravity(0, true);
    c.run(80);
    expectAgreement(fmt::format("floating chain of {}s", nameOf(type)), c.shadow.agreement());
  }
}

TEST_CASE("closed loops of each joint type move as with ODE, floating and attached to the world") {
  for (const JointType type : kTypes)
    for (const bool hangs : {false, true}) {
      Chain c(type, 6, 2, Drive::none, hangs, true);
      c.run(80);
      expectAgreement(fmt::format("{} loop of {}s", hangs ? "hanging" : "floating", nameOf(type)),
                      c.shadow.agreement());
    }
}

TEST_CASE("angular motors drive ball joints as with ODE, in each frame, with stops, and with Euler angles") {
  for (const bool euler : {false, true})
    for (const int order : {0, 1, 2}) {
      OracleHost h;
      BodyHandle last = BodyHandle::none;
      std::vector<std::pair<JointHandle, int>> motors;
      for (int i = 0; i < 5; ++i) {
        const BodyHandle b = h.block({0.4 * i, 0, 3}, {0.3, 0.12, 0.1}, 1, true);
        const bool turned = order == 1 || (order == 2 && i % 2);
        const BodyHandle first = turned ? b : last, second = turned ? last : b;
        h.join(JointType::ball, first, second, {0.4 * i - 0.2, 0, 3});
        const JointHandle m = h.join(JointType::angularMotor, first, second, {0, 0, 0});
        if (euler) {
          h.world.setAngularMotor(m, 3, true);
          h.world.setAxis(m, 0, {0, 0, 1}, 1);
          h.world.setAxis(m, 2, {1, 0, 0}, 2);
        }
        for (int axis = 0; axis < 3; ++axis) {
          if ((i + axis) % 3 == 0) h.motor(m, axis, 0.8, i % 2 ? 20 : 0.4);
          if ((i + axis) % 3 == 1) h.stops(m, axis, -0.1, 0.2);
        }
        motors.emplace_back(m, i);
        last = b;
      }
      for (int n = 0; n < 80; ++n) {
        for (const auto& [m, i] : motors)
          for (int axis = 0; axis < 3 && !euler; ++axis)
            h.world.setMotorAngle(m, axis, 0.3 * std::sin(0.1 * n + i + axis));
        h.run(1);
      }
      expectAgreement(fmt::format("angular motors, {}, order {}", euler ? "Euler" : "user", order),
                      h.shadow.agreement());
    }
}

TEST_CASE("a tree of all joint types falls on the ground and is driven there as with ODE") {
  OracleHost h;
  h.ground();
  const BodyHandle trunk = h.block({0, 0, 1.2}, {0.4, 0.4, 0.4}, 3);
  for (int limb = 0; limb < 6; ++limb) {
    const double angle = M_PI / 3 * limb;
    const Vec3 out(std::cos(angle), std::sin(angle), 0);
    BodyHandle last = trunk;
    for (int i = 0; i < 3; ++i) {
      const BodyHandle b = h.ball(Vec3(0, 0, 1.2) + out * (0.5 + 0.35 * i), 0.12, 0.6);
      const JointHandle j =
          limb % 2 ? h.join(kTypes[(limb + i) % 6], last, b, Vec3(0, 0, 1.2) + out * (0.35 + 0.35 * i), 0.2 * i)
                   : h.join(kTypes[(limb + i) % 6], b, last, Vec3(0, 0, 1.2) + out * (0.35 + 0.35 * i), 0.2 * i);
      h.motor(j, 0, i % 2 ? 2 : -2, 8);
      h.stops(j, 0, -0.6, 0.6);
      last = b;
    }
  }
  h.run(200, soft());
  expectAgreement("tree of all joints on the ground", h.shadow.agreement());
}

TEST_CASE("a body rotated half a turn from the orientation that its joint requires is turned back as with ODE") {
  for (const JointType type : {JointType::fixed, JointType::slider}) {
    OracleHost h;
    const BodyHandle a = h.block({0, 0, 3}, {0.3, 0.12, 0.1}, 1, true),
                     b = h.block({0.4, 0, 3}, {0.3, 0.12, 0.1}, 1, true);
    h.join(type, a, b, {0.2, 0, 3});
    h.world.setRotation(b, Vec3(-1, -1, 1).asDiagonal());  // exactly: the quaternion's w is 0
    h.run(1);
    expectAgreement(fmt::format("{}, half a turn", nameOf(type)), h.shadow.agreement());
    CHECK(h.world.state(b).angularVelocity.norm() > 1);
  }
}

TEST_CASE("a car on suspended wheels drives as with ODE") {
  OracleHost h;
  h.ground();
  const BodyHandle chassis = h.block({0, 0, 0.5}, {1.2, 0.6, 0.2}, 8);
  for (int i = 0; i < 4; ++i) {
    const Vec3 at(i < 2 ? 0.5 : -0.5, i % 2 ? 0.4 : -0.4, 0.3);
    const BodyHandle wheel = h.ball(at, 0.25, 0.8);
    const JointHandle j = h.world.createJoint(JointType::hinge2);
    h.world.attach(j, chassis, wheel);
    h.world.setAnchor(j, at);
    h.world.setAxis(j, 1, {0, 1, 0});
    h.world.setAxis(j, 0, {0, 0, 1});
    h.world.setFeedback(j, true);
    h.world.setParameter(j, JointParameter::suspensionErp, 0, 0.4);
    h.world.setParameter(j, JointParameter::suspensionCfm, 0, 0.01);
    if (i < 2) {
      h.stops(j, 0, -0.5, 0.5);
      h.motor(j, 0, 0.3, 5);
    } else {
      h.stops(j, 0, 0, 0);
    }
    h.motor(j, 1, -6, 3);
  }
  engine::Surface tyres = soft();
  tyres.mu = 4;
  h.run(250, tyres);
  expectAgreement("car", h.shadow.agreement());
  CHECK(h.position(chassis).norm() > 0.5);
}

TEST_CASE("rigid and soft joints act as with ODE") {
  // Ball and fixed joints keep the ERP and CFM that the world has when they are made. The others read them in each
  // step.
  for (const JointType type : {JointType::ball, JointType::fixed, JointType::hinge}) {
    OracleHost h;
    engine::WorldParameters p;
    p.cfm = 0;
    p.erp = 0.5;
    h.world.setParameters(p);
    BodyHandle last = BodyHandle::none;
    for (int i = 0; i < 5; ++i) {
      const BodyHandle b = h.block({0.4 * i, 0, 3}, {0.3, 0.12, 0.1}, 1, true);
      const JointHandle j = h.join(type, last, b, {0.4 * i - 0.2, 0, 3}, 0.1 * i);
      if (type == JointType::hinge) h.motor(j, 0, 1, 3);
      last = b;
      if (i == 2) {
        p.cfm = 1e-2;
        p.erp = 0.1;
        h.world.setParameters(p);
      }
    }
    h.run(60);
    expectAgreement(fmt::format("{}s of two compliances", nameOf(type)), h.shadow.agreement());
  }
}
