// Checks the Nao V4 against its table of numbers, and that its motors move it.

#include <catch2/catch.hpp>
#include <map>
#include <sstream>

#include "api/physics.h"
#include "league.h"
#include "scene_text.h"

using namespace spark;
using namespace spark::test;

namespace {

// Middle and right side; the left side is its mirror image.
const char* const kHalf = R"(
torso      1.04956 -0.00006 -1.0048  1.4577
neck       0.06442 -0.00018 -1       1.5843
head       0.60533  0.00093 -0.99617 1.6616
rshoulder  0.07504  0.12307 -1.0018  1.6002
rupperarm  0.15777  0.09412 -0.93433 1.6036
relbow     0.06483  0.09801 -0.93573 1.5998
rlowerarm  0.18533  0.09704 -0.78008 1.5989
rhip1      0.06981  0.03813 -1.0072  1.4421
rhip2      0.13053  0.05029 -1.0165  1.4103
rthigh     0.38968  0.05201 -0.99869 1.3111
rshank     0.29142  0.0521  -0.99529 1.2147
rankle     0.13416  0.05028 -0.99858 1.2223
rfoot      0.16184  0.0533  -0.94511 1.1488
)";

// perceptor, effector, parts, anchor, axis, stops, maximum speed, torque, Ke, Kt, R, Tenv, and whether the left stops
// are mirrored
const char* const kMotors = R"(
hj1  he1  neck      torso      0      -1     1.61     0       0 1       -119.5   119.5  8.29382 10   0.397936 2.5  6     38 0
hj2  he2  head      neck       0      -1     1.61     1       0 0        -38.5    29.5  7.19426  2.6 0.345576 2.9 32.1   38 0
raj1 rae1 rshoulder torso      0.098  -1     1.6      1       0 0       -119.5   119.5  8.29382 10   0.397936 2.5  6     38 0
raj2 rae2 rupperarm rshoulder  0.098  -1     1.6      0       0 1        -76      18    7.19426  2.6 0.345576 2.9 32.1   38 1
raj3 rae3 relbow    rupperarm  0.098  -0.91  1.6      0       1 0       -119.5   119.5  8.29382 10   0.397936 2.5  6     38 0
raj4 rae4 rlowerarm relbow     0.098  -0.91  1.6      0       0 1          2      88.5  7.19426  2.6 0.345576 2.9 32.1   38 1
rlj1 rle1 rhip1     torso      0.05   -1     1.415   -0.7071  0 0.7071   -65.62   42.44 4.15738 12   0.230384 4.3  6.44  33 0
rlj2 rle2 rhip2     rhip1      0.05   -1     1.415    0       1 0        -45.29   21.74 4.15738 12   0.230384 4.3  6.44  27 1
rlj3 rle3 rthigh    rhip2      0.05   -1     1.415    1       0 0        -27.73   88    6.39839  7.8 0.356048 2.8  6.44  27 0
rlj4 rle4 rshank    rthigh     0.05   -1     1.315    1       0 0       -121.47    5.29 6.39839  7.8 0.356048 2.8  6.44  27 0
rlj5 rle5 rankle    rshank     0.05   -1     1.21587  1       0 0        -52.86   68.15 6.39839  7.8 0.356048 2.8  6.44  27 0
rlj6 rle6 rfoot     rankle     0.05   -1     1.23271  0       1 0        -22.8    44.06 4.15738 12   0.230384 4.3  6.44  27 1
)";

struct Joint {
  std::string perceptor, effector, child, parent;
  Vec3 anchor, axis;
  double min, max, speed, torque, speedConstant, torqueConstant, resistance, environment;
  bool mirrored;
};

std::string left(std::string name) {
  if (name.starts_with("r")) name.front() = 'l';
  return name;
}

Joint leftOf(Joint j) {
  for (std::string* name : {&j.perceptor, &j.effector, &j.child, &j.parent}) *name = left(*name);
  j.anchor.x() = -j.anchor.x();
  if (j.perceptor == "llj1") j.axis.z() = -j.axis.z();
  if (j.mirrored) std::tie(j.min, j.max) = std::pair(-j.max, -j.min);
  if (j.perceptor == "llj6") j.max = 22.79;
  return j;
}

/// In tree order: head, right arm, left arm, right leg, left leg.
std::vector<Joint> jointsOf() {
  std::vector<Joint> right;
  std::istringstream in(kMotors);
  for (Joint j; in >> j.perceptor >> j.effector >> j.child >> j.parent >> j.anchor >> j.axis >> j.min >> j.max >>
                j.speed >> j.torque >> j.speedConstant >> j.torqueConstant >> j.resistance >> j.environment >>
                j.mirrored;)
    right.push_back(j);
  REQUIRE(right.size() == 12);
  std::vector<Joint> all(right.begin(), right.begin() + 6);
  for (int i = 2; i < 6; ++i) all.push_back(leftOf(right[i]));
  for (int i = 6; i < 12; ++i) all.push_back(right[i]);
  for (int i = 6; i < 12; ++i) all.push_back(leftOf(right[i]));
  return all;
}

void checkMotor(const Joint& j, IJoint& motor) {
  const auto number = [&](const char* property) { return getProperty(motor.leaf(), property).toNumber(); };
  CHECK(motor.maxSpeed(0) == Approx(j.speed));
  CHECK(number("maxTorque") == Approx(j.torque));
  CHECK(number("speedConstant") == Approx(j.speedConstant));
  CHECK(number("torqueConstant") == Approx(j.torqueConstant));
  CHECK(number("resistance") == Approx(j.resistance));
  CHECK(number("environmentTempeature") == Approx(j.environment));
  const bool geared = j.torque >= 10;
  CHECK(number("thermalConductivity") == Approx(geared ? 0.0158 : 0.0198));
  CHECK(number("heatCapacity") == Approx(geared ? 27.2 : 43.6));
  CHECK(getProperty(motor.leaf(), "feedback") == Value(true));
  CHECK(motor.leaf().find(getProperty(motor.leaf(), "battery").toString())->name() == "Battery");
  CHECK(motor.leaf().find(j.perceptor)->classObject()->name() == "AngularMotorPerceptor");
  CHECK(motor.leaf().find(j.effector)->classObject()->name() == "AngularMotorEffector");
  CHECK(motor.leaf().find(j.effector + "s")->classObject()->name() == "StiffnessEffector");
}

template <class T>
std::vector<std::string> classesAndNames(const Node& root) {
  std::vector<T*> all;
  root.collect(all);
  std::vector<std::string> out;
  for (T* t : all)
    out.push_back(t->name() == t->classObject()->name() ? t->name() : t->classObject()->name() + ":" + t->name());
  return out;
}

struct Robot {
  League league;
  Node& agent;
  Robot() : agent(league.agent()) { league.import("rsg/agent/naov4/nao.rsg", agent); }
  IJoint& motor(const std::string& part) {
    return agent.require<IJoint>("spacenao/" + part + "/HingeJoint/AngularMotor");
  }
  IJoint& hinge(const std::string& part) { return agent.require<IJoint>("spacenao/" + part + "/HingeJoint"); }
};

}  // namespace

TEST_CASE("The Nao V4 has the bodies of its specification") {
  Robot robot;
  std::istringstream in(kHalf);
  double mass = 0;
  int n = 0;
  std::string name;
  Vec3 at;
  for (double m; in >> name >> m >> at; ++n) {
    INFO(name);
    const auto check = [&](const std::string& part, const Vec3& p) {
      const auto& body = robot.agent.require<IRigidBody>("spacenao/" + part + "/body");
      CHECK(body.mass() == Approx(m));
      CHECK((body.state().position - p).norm() < 2e-7);
      mass += m;
    };
    check(name, at);
    if (name.starts_with("r")) check(left(name), {-at.x(), at.y(), at.z()});
  }
  CHECK(n == 13);
  CHECK(mass == Approx(5.04013));
}

TEST_CASE("The Nao V4 has the hinges and motors of its specification in their order") {
  Robot robot;
  std::vector<IJoint*> joints;
  robot.agent.collect(joints);
  const auto wanted = jointsOf();
  REQUIRE(joints.size() == 2 * wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const Joint& j = wanted[i];
    INFO(j.perceptor);
    IJoint &hinge = *joints[2 * i], &motor = *joints[2 * i + 1];
    for (IJoint* both : {&hinge, &motor}) {
      CHECK(&both->body(0)->leaf() == robot.agent.find("spacenao/" + j.child + "/body"));
      CHECK(&both->body(1)->leaf() == robot.agent.find("spacenao/" + j.parent + "/body"));
    }
    CHECK((vectorOf(hinge.leaf(), "getAnchor") - j.anchor).norm() < 1e-5);
    CHECK((vectorOf(hinge.leaf(), "getAxis") - j.axis.normalized()).norm() < 1e-6);
    using P = engine::JointParameter;
    CHECK(hinge.parameter(P::lowStop, 0) == Approx(degToRad(j.min)));
    CHECK(hinge.parameter(P::highStop, 0) == Approx(degToRad(j.max)));
    CHECK(hinge.parameter(P::maxForce, 0) == Approx(0.1));
    CHECK(motor.jointType() == engine::JointType::angularMotor);
    checkMotor(j, motor);
  }
}

TEST_CASE("The Nao V4 senses in the order of its specification") {
  Robot robot;
  std::vector<std::string> wanted{"GPS:torso",           "BatteryPerceptor:BAT", "TimePerceptor",
                                  "GameStatePerceptor",  "HearPerceptor",        "GyroRatePerceptor:torso",
                                  "Accelerometer:torso", "SonarPerceptor:Left",  "SonarPerceptor:Right"};
  for (const Joint& j : jointsOf()) {
    if (j.perceptor.ends_with("lj6")) wanted.push_back("ForceResistancePerceptor:" + j.perceptor.substr(0, 1) + "f");
    wanted.push_back("AngularMotorPerceptor:" + j.perceptor);
    if (j.perceptor == "hj2")
      wanted.insert(wanted.end(), {"RestrictedVisionPerceptor", "RestrictedVisionPerceptor", "GPS:head"});
  }
  CHECK(classesAndNames<Perceptor>(robot.agent) == wanted);
  CHECK(classesAndNames<Effector>(robot.agent).size() == 4 + 2 * 22);
}

TEST_CASE("The Nao V4's motors hold it, turn at the commanded speed up to their limit, and relax without stiffness") {
  Robot robot;
  robot.league.import("rsg/soccer/field.rsg", robot.league.scene());
  Predicates commands;
  readSexp("(he1 1)(he2 99)(rle3s 0)", commands);
  for (const Element e : commands) {
    std::vector<Effector*> effectors;
    robot.agent.collect(effectors);
    for (Effector* effector : effectors)
      if (effector->predicate() == e.head()) CHECK(effector->act(e) == "");
  }
  robot.league.run(10);
  CHECK(robot.hinge("neck").angle(0) == Approx(0.2).margin(0.03));
  CHECK(robot.motor("head").parameter(engine::JointParameter::velocity, 0) == Approx(7.19426));
  CHECK(robot.motor("rthigh").parameter(engine::JointParameter::maxForce, 0) == Approx(0));
  CHECK(robot.motor("lthigh").parameter(engine::JointParameter::maxForce, 0) == Approx(7.8));
  CHECK(std::abs(robot.hinge("lthigh").angle(0)) < 0.02);
}
