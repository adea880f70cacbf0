#include "twins.h"

using namespace spark;
using namespace spark::test;
using engine::JointParameter;
using engine::JointType;

namespace {

/// Sets an anchor, random axes, motors and stops.
void configure(Twins& t, std::size_t joint, JointType type, const Vec3& anchor) {
  const Vec3 axis1 = t.randomVector(1).normalized(), other = t.randomVector(1);
  const Vec3 axis2 = (other - other.dot(axis1) * axis1).normalized(), axis3 = axis1.cross(axis2);
  const bool euler = t.randomInt(2) == 0;
  t.forBothJoints(joint, [&](physics::WorldModel& w, physics::JointHandle j) {
    w.setAnchor(j, anchor);
    if (type == JointType::angularMotor) {
      w.setAngularMotor(j, 3, euler);
      w.setAxis(j, 0, axis1, 1);
      if (!euler) w.setAxis(j, 1, axis2, 0);
      w.setAxis(j, 2, euler ? axis2 : axis3, 2);
      if (!euler) w.setMotorAngle(j, 1, 0.2);
    } else {
      w.setAxis(j, 0, axis1);
      w.setAxis(j, 1, axis2);
    }
    w.setFixed(j);
  });
  for (int axis = 0; axis < 3; ++axis) {
    if (t.randomInt(2)) {
      t.set(joint, JointParameter::maxForce, axis, t.uniform(0.01, 10));
      t.set(joint, JointParameter::velocity, axis, t.uniform(-5, 5));
    }
    if (t.randomInt(2)) {
      const double width = t.randomInt(4) ? t.uniform(0, 0.5) : 0;
      const double low = t.uniform(-0.4, 0.2);
      t.set(joint, JointParameter::highStop, axis, low + width);
      t.set(joint, JointParameter::lowStop, axis, low);
      t.set(joint, JointParameter::bounce, axis, t.randomInt(2) ? 0.7 : 0);
      t.set(joint, JointParameter::fudgeFactor, axis, t.uniform(0, 1));
    }
    t.set(joint, JointParameter::cfm, axis, t.randomInt(2) ? 1e-4 : 1e-6);
    t.set(joint, JointParameter::stopErp, axis, 0.4);
  }
  t.set(joint, JointParameter::suspensionErp, 0, 0.3);
  t.set(joint, JointParameter::suspensionCfm, 0, 1e-3);
}

const char* kNames[] = {"ball", "hinge", "hinge2", "slider", "universal", "fixed", "angular motor"};

}  // namespace

TEST_CASE("free bodies move as with ODE, with gyroscopic torque, and with gravity on and off") {
  Twins t;
  const std::size_t a = t.randomBody({0, 0, 1}), b = t.randomBody({3, 0, 1});
  t.forBoth([&](Scene& s) { s.world.setGravityMode(s.bodies[b], false); });
  (void)a;
  t.shake();
  t.checkSteps(50);
}

TEST_CASE("each joint type moves as with ODE, with either order of bodies and with the world") {
  for (int type = 0; type < 7; ++type)
    for (int order = 0; order < 4; ++order) {
      if (kTypes[type] == JointType::hinge2 && order > 1) continue;  // needs two bodies
      for (unsigned seed = 1; seed <= 6; ++seed) {
        INFO(kNames[type] << ", order " << order << ", seed " << seed);
        Twins t(seed * 100 + static_cast<unsigned>(order));
        t.randomBody({0, 0, 1});
        t.randomBody({0.3, 0.1, 1.2});
        const int ends[4][2] = {{0, 1}, {1, 0}, {0, -1}, {-1, 0}};
        configure(t, t.joint(kTypes[type], ends[order][0], ends[order][1]), kTypes[type], {0.15, 0, 1.1});
        t.shake();
        t.checkSteps(30);
      }
    }
}
