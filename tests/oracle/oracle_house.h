#pragma once
/// \file
/// A world that is stepped by a shadow engine, and helpers that make bodies, joints and motors.

#include <Eigen/Geometry>

#include "../../plugins/physics-ode/tests/engine_fixture.h"
#include "agreement.h"

namespace spark::oracle {

using engine::JointParameter;
using engine::JointType;
using engine::Shape;
using physics::BodyHandle;
using physics::JointHandle;

struct OracleHost : test::EngineHost {
  ShadowEngine& shadow;
  OracleHost() : shadow(watch(kernel, "/sys/shadow")) { setGravity(9.81, true); }

  /// A body with the mass of a box and, unless `ghost`, its collider.
  BodyHandle block(const Vec3& at, const Vec3& edges, double mass, bool ghost = false) {
    const BodyHandle b = body(at);
    const Vec3 squares = edges.cwiseProduct(edges);
    world.setMass(b, {mass, Vec3::Zero(), Mat3((Vec3::Constant(squares.sum()) - squares).asDiagonal()) * (mass / 12)});
    if (!ghost) geom(test::box(edges.x(), edges.y(), edges.z()), b);
    return b;
  }
  BodyHandle ball(const Vec3& at, double radius, double mass) {
    const BodyHandle b = body(at);
    world.setMass(b, {mass, Vec3::Zero(), Mat3::Identity() * (0.4 * mass * radius * radius)});
    geom(test::round(Shape::sphere, radius), b);
    return b;
  }
  void ground() { geom(test::plane(0, 0, 1, 0)); }

  /// A joint at `at` with axes that are valid for its type, rotated by `turn` [rad]. Its feedback is on.
  JointHandle join(JointType type, BodyHandle a, BodyHandle b, const Vec3& at, double turn = 0) {
    const JointHandle j = world.createJoint(type);
    world.attach(j, a, b);
    world.setAnchor(j, at);
    const Mat3 tilt = Eigen::AngleAxisd(0.3 + turn, Vec3(3, 1, 2).normalized()).toRotationMatrix();
    if (type == JointType::angularMotor) world.setAngularMotor(j, 3, false);
    world.setAxis(j, 0, tilt * Vec3::UnitZ(), 1);
    world.setAxis(j, 1, tilt * Vec3::UnitX(), 0);
    world.setAxis(j, 2, tilt * Vec3::UnitY(), 2);
    world.setFixed(j);
    world.setFeedback(j, true);
    return j;
  }
  void motor(JointHandle j, int axis, double speed, double force) {
    world.setParameter(j, JointParameter::velocity, axis, speed);
    world.setParameter(j, JointParameter::maxForce, axis, force);
  }
  void stops(JointHandle j, int axis, double low, double high, double bounce = 0) {
    world.setParameter(j, JointParameter::lowStop, axis, low);
    world.setParameter(j, JointParameter::highStop, axis, high);
    world.setParameter(j, JointParameter::bounce, axis, bounce);
    world.setParameter(j, JointParameter::stopErp, axis, 0.4);
    world.setParameter(j, JointParameter::fudgeFactor, axis, 0.6);
  }
  /// Steps the world. Each contact is solved and its force is computed.
  void run(int steps, const engine::Surface& surface = {}) {
    for (int i = 0; i < steps; ++i) {
      contacts.clear();
      detect();
      for (auto& c : contacts) c.solve = c.feedback = true, c.surface = surface;
      stepper.step(shadow, contacts, 0.02);
    }
  }
};

/// The surface of the soccer simulations. It is compliant, so the solution of each contact is unique.
inline engine::Surface soft() {
  engine::Surface s;
  s.softErpOn = s.softCfmOn = s.slipOn = true;
  s.softErp = 0.4;
  s.softCfm = 1e-3;
  s.slip1 = s.slip2 = 0.005;
  return s;
}

inline const char* nameOf(JointType type) {
  constexpr const char* kNames[] = {"ball", "hinge", "hinge2", "slider", "universal", "fixed", "angular motor"};
  return kNames[static_cast<int>(type)];
}

}  // namespace spark::oracle
