// The parts of a world, each with a model that is made by hand: no engine, no scene, no WorldModel.

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "../added_forces.h"
#include "../body_watch.h"

using namespace spark;
using namespace spark::physics;
using engine::JointType;

namespace {

/// Two bodies, the first on a hinge about z at the world's origin.
struct Hinged : WorldData {
  JointKinematics kinematics{*this};
  Hinged() {
    model.bodies.resize(2);
    state.bodies.resize(2);
    state.joints.resize(1);
    state.motors.resize(1);
    engine::Joint& j = model.joints.emplace_back();
    j.a = 0;
    j.inA.axis[0] = j.inB.axis[0] = Vec3::UnitZ();
    model.structure = 1;
    kinematics.add();
  }
  /// Turns the body about z, in steps of less than half a turn.
  void turnTo(double angle) {
    engine::DynamicState& s = state.bodies[0];
    s.quaternion = {std::cos(angle / 2), 0, 0, std::sin(angle / 2)};
    s.rotation = rotationOf(s.quaternion);
    ++poses;
  }
};

}  // namespace

TEST_CASE("joint kinematics counts turns from the poses alone") {
  Hinged w;
  w.kinematics.begin();
  for (int i = 1; i <= 20; ++i) {
    w.turnTo(0.5 * i);
    w.kinematics.countTurns();
  }
  CHECK(w.kinematics.angle(0, 0) == Approx(10));
  CHECK(w.kinematics.angleOfPoses(0, 0) == Approx(10 - 4 * kPi));
  CHECK(w.kinematics.axis(0, 0).isApprox(Vec3::UnitZ()));
  w.state.bodies[0].angularVelocity = {0, 0, 3};
  CHECK(w.kinematics.rate(0, 0) == Approx(3));
  CHECK_FALSE(w.kinematics.atStop(0, 0));
  w.model.joints[0].axes[0].highStop = 9;
  CHECK(w.kinematics.atStop(0, 0));
  w.kinematics.restart(0);
  CHECK(w.kinematics.angle(0, 0) == Approx(10 - 4 * kPi));
}

TEST_CASE("added forces are those that the engine leaves out") {
  Hinged w;
  AddedForces added(w, w.kinematics);
  w.model.joints[0].axes[0].stiffness = 2;
  w.model.joints[0].axes[0].damping = 0.5;
  w.state.bodies[0].angularVelocity = {0, 0, 1};
  ++w.model.dynamics;
  w.turnTo(0.25);
  added.add({.damping = true, .springs = true, .bodyDamping = true}, 0.01);
  CHECK(w.state.bodies[0].torque.isZero(0));
  added.add({.springs = true}, 0.01);
  const double damping = -0.5 / (1 + 0.5 * 0.01);  // implicit in time; the body's moment of inertia is 1
  CHECK(w.state.bodies[0].torque.z() == Approx(damping));
  added.add({.damping = true}, 0.01);
  CHECK(w.state.bodies[0].torque.z() == Approx(damping - 2 * 0.25));
  // Forces on bodies that sleep would pile up.
  w.state.bodies[0].awake = false;
  w.state.bodies[0].torque.setZero();
  added.add({}, 0.01);
  CHECK(w.state.bodies[0].torque.isZero(0));
}

TEST_CASE("the watch puts idle bodies to sleep and repairs those whose numbers went wrong") {
  WorldData w;
  BodyWatch watch(w);
  w.model.bodies.resize(2);
  w.state.bodies.resize(2);
  watch.add(), watch.add();
  w.model.bodies[0].joints = 1;  // the other one is in free flight
  for (int i = 0; i < 9; ++i) watch.putToSleep({}, 0.02);
  CHECK(w.state.bodies[0].awake);
  watch.putToSleep({}, 0.02);
  CHECK_FALSE(w.state.bodies[0].awake);
  CHECK(w.state.bodies[1].awake);

  std::vector<engine::Index> repaired;
  w.state.bodies[1].position = {1, 2, 3};
  watch.repair(repaired);
  CHECK(repaired.empty());
  w.state.bodies[1].position.x() = NAN;
  w.state.bodies[1].linearVelocity = {1, 0, 0};
  watch.repair(repaired);
  CHECK(repaired == std::vector<engine::Index>{1});
  CHECK(w.state.bodies[1].position == Vec3(1, 2, 3));
  CHECK(w.state.bodies[1].linearVelocity.isZero(0));
  CHECK(w.state.moved == std::vector<engine::Index>{1});

  // The entries follow the bodies when one is removed.
  w.state.bodies.erase(w.state.bodies.begin());
  w.model.bodies.erase(w.model.bodies.begin());
  w.state.moved.clear(), w.state.bodies[0].moved = false;
  watch.renumber({engine::kNone, 0});
  w.state.bodies[0].position.y() = HUGE_VAL;
  repaired.clear();
  watch.repair(repaired);
  CHECK(w.state.bodies[0].position == Vec3(1, 2, 3));
}
