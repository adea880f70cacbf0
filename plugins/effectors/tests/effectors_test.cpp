#include <catch2/catch.hpp>

#include "api/robot_parts.h"
#include "fake_physics.h"
#include "test_support.h"

using namespace spark;
using namespace spark::test;

namespace {

/// A robot with a single transform `/usr/robot`, a body and a joint. Tests add effectors to it.
struct Robot : TestHost {
  Robot() {
    registerFakePhysics(kernel);
    kernel.plugins().use("effectors");
    transform = &kernel.create<Transform>("Transform", "/usr/robot");
    body = &transform->create<FakeBody>("FakeBody", "body");
    joint = &transform->create<FakeJoint>("FakeJoint", "joint");
    joint->bodies = {body, nullptr};
  }
  Effector& add(engine::JointType type, const char* className, const char* name) {
    joint->type = type;
    return joint->create<Effector>(className, name);
  }
  std::string act(Effector& effector, std::string_view message) {
    Predicates actions;
    REQUIRE(readSexp(message, actions).message.empty());
    return effector.act(*actions.begin());
  }
  void prepare() { kernel.events().channel("prepare").emit({"prepare", 0, 0.02, 1, nullptr}); }
  Transform* transform;
  FakeBody* body;
  FakeJoint* joint;
};

}  // namespace

TEST_CASE("a command sets the speed of a hinge at once, limited to its maximum speed") {
  Robot robot;
  auto& he1 = robot.add(engine::JointType::hinge, "HingeEffector", "he1");
  CHECK(he1.predicate() == "he1");
  CHECK(robot.act(he1, "(he1 99)").empty());
  CHECK(robot.joint->velocity(0) == 99);
  robot.joint->maxSpeeds[0] = 6.1395;
  CHECK(robot.act(he1, "(he1 99)").empty());
  CHECK(robot.joint->velocity(0) == 6.1395);
  CHECK(robot.act(he1, "(he1 -99 surplus)") == "expected 1 argument, found 2: the others are ignored");
  CHECK(robot.joint->velocity(0) == -6.1395);
  CHECK(robot.act(he1, "(he1 2e-1)").empty());
  CHECK(robot.joint->velocity(0) == 0.2);
}

TEST_CASE("text that is not a number is read as in the installed base, and is reported") {
  Robot robot;
  auto& he1 = robot.add(engine::JointType::hinge, "HingeEffector", "he1");
  CHECK(robot.act(he1, "(he1 1.5x)") == "expected a number as argument 1, found '1.5x', which counts as 1.5");
  CHECK(robot.joint->velocity(0) == 1.5);
  CHECK(robot.act(he1, "(he1 abc)") == "expected a number as argument 1, found 'abc', which counts as 0");
  CHECK(robot.joint->velocity(0) == 0);
  CHECK(robot.act(he1, "(he1 " + std::string(500, 'a') + ")").size() < 150);
  auto& uj = robot.add(engine::JointType::universal, "UniversalJointEffector", "uj");
  CHECK(robot.act(uj, "(uj 1 two)") == "expected a number as argument 2, found 'two', which counts as 0");
  CHECK(robot.joint->velocity(0) == 1);
  auto& force = robot.transform->create<Effector>("ForceEffector", "f");
  CHECK(robot.act(force, "(force x y 3)") == "expected a number as argument 1, found 'x', which counts as 0");
  robot.prepare();
  CHECK(robot.body->force == Vec3(0, 0, 3));
}

TEST_CASE("invalid arguments are refused with an explanation and change nothing") {
  Robot robot;
  auto& he1 = robot.add(engine::JointType::hinge, "HingeEffector", "he1");
  robot.act(he1, "(he1 2)");
  CHECK(robot.act(he1, "(he1)") == "expected a number as argument 1, found none");
  CHECK(robot.act(he1, "(he1 (1))") == "expected a number as argument 1, found a list");
  CHECK(robot.act(he1, "(he1 nan)") == "expected a finite number as argument 1, found nan");
  CHECK(robot.act(he1, "(he1 -inf)") == "expected a finite number as argument 1, found -inf");
  CHECK(robot.joint->velocity(0) == 2);
  auto& uj = robot.add(engine::JointType::universal, "UniversalJointEffector", "uj");
  CHECK(robot.act(uj, "(uj 1)") == "expected a number as argument 2, found none");
  CHECK(robot.joint->velocity(0) == 2);
}

TEST_CASE("at or beyond a stop, commands are ignored unless ignoreCommandAtStop is off") {
  Robot robot;
  auto& he1 = robot.add(engine::JointType::hinge, "HingeEffector", "he1");
  robot.joint->setParameter(engine::JointParameter::lowStop, 0, -1);
  robot.joint->setParameter(engine::JointParameter::highStop, 0, 1);
  robot.act(he1, "(he1 0.5)");
  for (const double angle : {1.0, 1.1, -1.0, -1.2}) {
    robot.joint->angles[0] = angle;
    CHECK(robot.act(he1, "(he1 3)").empty());
    CHECK(robot.joint->velocity(0) == 0.5);
  }
  setProperty(he1, "ignoreCommandAtStop", false);
  CHECK(robot.act(he1, "(he1 3)").empty());
  CHECK(robot.joint->velocity(0) == 3);
  setProperty(he1, "ignoreCommandAtStop", true);
  robot.joint->angles[0] = 0.999;
  robot.act(he1, "(he1 4)");
  CHECK(robot.joint->velocity(0) == 4);
}

TEST_CASE("a frozen hinge keeps its speed until the next command, which sets it to 0") {
  Robot robot;
  auto& he1 = robot.add(engine::JointType::hinge, "HingeEffector", "he1");
  robot.act(he1, "(he1 2)");
  auto freezable = he1.as<IFreezable>();
  REQUIRE(freezable);
  freezable->freeze(true);
  CHECK(getProperty(he1, "frozen") == Value(true));
  CHECK(robot.joint->velocity(0) == 2);
  CHECK(robot.act(he1, "(he1 3)").empty());
  CHECK(robot.joint->velocity(0) == 0);
  freezable->freeze(false);
  CHECK(robot.joint->velocity(0) == 0);
  robot.act(he1, "(he1 3)");
  CHECK(robot.joint->velocity(0) == 3);
}

TEST_CASE("only a nonzero speed wakes the body") {
  Robot robot;
  auto& he1 = robot.add(engine::JointType::hinge, "HingeEffector", "he1");
  robot.body->awake = false;
  robot.act(he1, "(he1 0)");
  CHECK_FALSE(robot.body->awake);
  robot.act(he1, "(he1 0.1)");
  CHECK(robot.body->awake);
}

TEST_CASE("a command with a nonzero speed wakes the body even if the motor ignores it") {
  Robot robot;
  auto& he1 = robot.add(engine::JointType::hinge, "HingeEffector", "he1");
  robot.body->awake = false;
  SECTION("at a stop") {
    robot.joint->setParameter(engine::JointParameter::highStop, 0, 1);
    robot.joint->angles[0] = 1;
    robot.act(he1, "(he1 0)");
    CHECK_FALSE(robot.body->awake);
    robot.act(he1, "(he1 -0.1)");
    CHECK(robot.body->awake);
  }
  SECTION("frozen") {
    he1.as<IFreezable>()->freeze(true);
    robot.act(he1, "(he1 0)");
    CHECK_FALSE(robot.body->awake);
    robot.act(he1, "(he1 -0.1)");
    CHECK(robot.body->awake);
  }
  CHECK(robot.joint->velocity(0) == 0);
}

TEST_CASE("effectors of other joints have their own units and limits") {
  Robot robot;
  robot.joint->maxSpeeds = {2, 3, 0};
  SECTION("universal: both axes are limited to their maximum speeds, and stops are ignored") {
    auto& uj = robot.add(engine::JointType::universal, "UniversalJointEffector", "uj");
    robot.joint->angles = {9, 9, 0};
    robot.joint->setParameter(engine::JointParameter::highStop, 0, 1);
    CHECK(robot.act(uj, "(uj -5 5)").empty());
    CHECK(robot.joint->velocity(0) == -2);
    CHECK(robot.joint->velocity(1) == 3);
  }
  SECTION("hinge2: degrees per second about the wheel's axis, without a limit") {
    auto& wheel = robot.add(engine::JointType::hinge2, "Hinge2Effector", "wheel");
    CHECK(robot.act(wheel, "(wheel 720)").empty());
    CHECK(robot.joint->velocity(1) == Approx(4 * kPi));
    CHECK(robot.joint->velocity(0) == 0);
  }
  SECTION("slider: metres per second") {
    auto& lift = robot.add(engine::JointType::slider, "SliderEffector", "lift");
    CHECK(robot.act(lift, "(lift -0.5)").empty());
    CHECK(robot.joint->velocity(0) == -0.5);
    CHECK(robot.act(lift, "(lift 50)").empty());
    CHECK(robot.joint->velocity(0) == 2);
    robot.joint->type = engine::JointType::hinge;
  }
  SECTION("angular motor with several axes: a speed for each") {
    auto& motor = robot.transform->create<FakeJoint>("FakeJoint", "motor");
    motor.type = engine::JointType::angularMotor;
    motor.count = 3;
    auto& effector = motor.create<Effector>("AngularMotorEffector", "shoulder");
    CHECK(robot.act(effector, "(shoulder 1 -2 3)").empty());
    CHECK(motor.velocity(0) == 1);
    CHECK(motor.velocity(1) == -2);
    CHECK(motor.velocity(2) == 3);
    CHECK(robot.act(effector, "(shoulder 4)").empty());
    CHECK(motor.velocity(0) == 4);
    CHECK(motor.velocity(1) == -2);
    CHECK(robot.act(effector, "(shoulder 1 x)") == "expected a number as argument 2, found 'x', which counts as 0");
    motor.device.disabled = true;
    CHECK(robot.act(effector, "(shoulder 1 1 1)").empty());
    CHECK(motor.velocity(2) == 0);
  }
  SECTION("angular motor: the hinge's maximum speed applies too") {
    auto& motor = robot.joint->create<FakeJoint>("FakeJoint", "motor");
    motor.type = engine::JointType::angularMotor;
    auto& effector = motor.create<Effector>("AngularMotorEffector", "he1");
    auto& stiffness = motor.create<Effector>("StiffnessEffector", "he1s");
    CHECK(robot.act(effector, "(he1 50)").empty());
    CHECK(motor.velocity(0) == 2);
    motor.device.disabled = true;
    CHECK(robot.act(effector, "(he1 1)").empty());
    CHECK(motor.velocity(0) == 0);
    CHECK(robot.act(stiffness, "(he1s 1.5)") == "expected a stiffness of 0 to 1, found 1.5, which counts as 1");
    CHECK(motor.device.stiffness == 1);
    CHECK(robot.act(stiffness, "(he1s 0.25)").empty());
    CHECK(motor.device.stiffness == 0.25);
    CHECK(robot.act(stiffness, "(he1s nan)") == "expected a finite number as argument 1, found nan");
    CHECK(motor.device.stiffness == 0.25);
  }
}

TEST_CASE("a control effector sets the controller of its joint") {
  Robot robot;
  const engine::Control& law = robot.joint->controls[0];
  SECTION("hinge: degrees") {
    auto& effector = robot.add(engine::JointType::hinge, "ControlEffector", "he1");
    CHECK(effector.predicate() == "he1");
    CHECK(robot.act(effector, "(he1 30 -90 25 0.6 1.5)").empty());
    CHECK(law.position == Approx(kPi / 6));
    CHECK(law.velocity == Approx(-kPi / 2));
    CHECK(law.stiffness == 25);
    CHECK(law.damping == 0.6);
    CHECK(law.force == 1.5);
    CHECK(std::isinf(law.maxForce));
    setProperty(effector, "maxForce", 12.0);
    CHECK(robot.act(effector, "(he1 0 0 0 0 -2 surplus)") == "expected 5 arguments, found 6: the others are ignored");
    CHECK(law.stiffness == 0);
    CHECK(law.force == -2);
    CHECK(law.maxForce == 12);
  }
  SECTION("slider: m and m/s") {
    auto& effector = robot.add(engine::JointType::slider, "ControlEffector", "lift");
    CHECK(robot.act(effector, "(lift 0.5 -0.25 100 10 0)").empty());
    CHECK(law.position == 0.5);
    CHECK(law.velocity == -0.25);
  }
}

TEST_CASE("invalid commands of a control effector are refused and change nothing") {
  Robot robot;
  auto& he1 = robot.add(engine::JointType::hinge, "ControlEffector", "he1");
  const engine::Control& law = robot.joint->controls[0];
  CHECK(robot.act(he1, "(he1 0 0 25 0.5 7)").empty());
  const std::pair<const char*, const char*> cases[] = {
      {"(he1)", "expected a number as argument 1, found none"},
      {"(he1 1 2 3 4)", "expected a number as argument 5, found none"},
      {"(he1 1 (2) 3 4 5)", "expected a number as argument 2, found a list"},
      {"(he1 1 2 nan 4 5)", "expected a finite number as argument 3, found nan"},
      {"(he1 1 2 3 4 -inf)", "expected a finite number as argument 5, found -inf"},
      {"(he1 1 2 -3 4 5)", "expected a stiffness and a damping of 0 or more, found -3 and 4"},
      {"(he1 1 2 3 -4 5)", "expected a stiffness and a damping of 0 or more, found 3 and -4"},
  };
  for (const auto& [command, remark] : cases) {
    CHECK(robot.act(he1, command) == remark);
    CHECK(law.stiffness == 25);
    CHECK(law.damping == 0.5);
    CHECK(law.force == 7);
  }
  // Text is read as in the installed base.
  CHECK(robot.act(he1, "(he1 1 2 3 4 x)") == "expected a number as argument 5, found 'x', which counts as 0");
  CHECK(law.stiffness == 3);
  CHECK(law.force == 0);
}

TEST_CASE("gains that make a joint faster and faster are named, once") {
  Robot robot;
  auto& he1 = robot.add(engine::JointType::hinge, "ControlEffector", "he1");
  const auto command = [&](double rate, const char* message = "(he1 0 0 0 0.5 0)") {
    robot.joint->rates[0] = rate;
    CHECK(robot.act(he1, message).empty());
  };
  for (const double rate : {1.0, 3.0, 5.0, 7.0, 9.0, 11.0, 13.0}) command(rate);                // a load
  for (const double rate : {1.0, 2.0, 4.0, 8.0, 16.0, 32.0}) command(rate, "(he1 0 0 0 0 3)");  // no controller
  CHECK(robot.text.empty());
  for (const double rate : {1.0, -2.0, 4.0, -8.0, 16.0, -32.0, 64.0}) command(rate);
  CHECK_THAT(robot.text, Catch::Contains("the gains are too high for the inertia that it moves"));
  CHECK(std::count(robot.text.begin(), robot.text.end(), '\n') == 1);
}

TEST_CASE("an actuator's control sets a force in addition to its spring and damping") {
  Robot robot;
  auto& turn = robot.add(engine::JointType::hinge, "ActuatorEffector", "turn");
  const engine::Control& law = robot.joint->controls[0];
  CHECK(turn.predicate() == "turn");
  CHECK(robot.act(turn, "(turn 2)").empty());
  CHECK(law.force == 2);
  CHECK(law.stiffness == 0);
  CHECK(std::isinf(law.maxForce));
  for (const auto& [name, v] : {std::pair{"gain", 3.0},
                                {"bias", 0.5},
                                {"stiffness", 40.0},
                                {"damping", 4.0},
                                {"maxForce", 9.0},
                                {"least", -1.0},
                                {"most", 2.0}})
    setProperty(turn, name, v);
  CHECK(robot.act(turn, "(turn 1.5 surplus)") == "expected 1 argument, found 2: the others are ignored");
  CHECK(law.force == 3 * 1.5 + 0.5);
  CHECK(law.stiffness == 40);
  CHECK(law.damping == 4);
  CHECK(law.position == 0);
  CHECK(law.velocity == 0);
  CHECK(law.maxForce == 9);
  CHECK(robot.act(turn, "(turn 99)").empty());
  CHECK(law.force == 3 * 2 + 0.5);
  CHECK(robot.act(turn, "(turn -99)").empty());
  CHECK(law.force == 3 * -1 + 0.5);
  // A script may set the control, too.
  setProperty(turn, "control", 0.5);
  CHECK(law.force == 3 * 0.5 + 0.5);
  CHECK(getProperty(turn, "control").toNumber() == 0.5);
}

TEST_CASE("actuators of one joint add up, and a control can set stiffness and damping") {
  Robot robot;
  auto& a = robot.add(engine::JointType::hinge, "ActuatorEffector", "a");
  auto& b = a.parent()->create<Effector>("ActuatorEffector", "b");
  const engine::Control& law = robot.joint->controls[0];
  setProperty(a, "bias", 0.5);
  setProperty(a, "stiffness", 10.0);
  setProperty(a, "maxForce", 9.0);
  setProperty(b, "gain", 3.0);
  setProperty(b, "gainStiffness", 2.0);
  setProperty(b, "gainDamping", 4.0);
  CHECK(robot.act(a, "(a 2)").empty());
  CHECK(robot.act(b, "(b 1.5)").empty());
  CHECK(law.force == 2 + 0.5 + 4.5);
  CHECK(law.stiffness == 10 + 3);
  CHECK(law.damping == 6);
  CHECK(law.maxForce == 9);
  CHECK(robot.act(a, "(a 0)").empty());
  CHECK(law.force == 0.5 + 4.5);
  // A spring cannot push away.
  CHECK(robot.act(b, "(b -99)").empty());
  CHECK(law.stiffness == 10);
  CHECK(law.damping == 0);
}

TEST_CASE("a control effector may have gears, limits and a reference") {
  Robot robot;
  auto& he1 = robot.add(engine::JointType::hinge, "ControlEffector", "he1");
  const engine::Control& law = robot.joint->controls[0];
  setProperty(he1, "gears", List{2.0, 3.0, 4.0});
  setProperty(he1, "leastControls", List{-1.0, -2.0, -3.0});
  setProperty(he1, "mostControls", List{1.0, 2.0, 3.0});
  setProperty(he1, "reference", 0.25);
  CHECK(robot.act(he1, "(he1 28.64788975654116 0 25 0.6 1.5)").empty());
  CHECK(law.position == Approx(0.5 / 2 - 0.25));
  CHECK(law.stiffness == 100);
  CHECK(law.damping == Approx(5.4));
  CHECK(law.force == 6);
  CHECK(robot.act(he1, "(he1 90 -900 25 0.6 -9)").empty());
  CHECK(law.position == Approx(1.0 / 2 - 0.25));
  CHECK(law.velocity == Approx(-2.0 / 3));
  CHECK(law.force == -12);
}

TEST_CASE("an effector may have another name in messages than in the tree") {
  Robot robot;
  auto& effector = robot.add(engine::JointType::hinge, "ControlEffector", "arm_j");
  CHECK(effector.predicate() == "arm_j");
  setProperty(effector, "messageName", "arm/j");
  CHECK(effector.predicate() == "arm/j");
  CHECK(effector.name() == "arm_j");
}

TEST_CASE("invalid commands of an actuator are refused and change nothing") {
  Robot robot;
  auto& turn = robot.add(engine::JointType::hinge, "ActuatorEffector", "turn");
  const engine::Control& law = robot.joint->controls[0];
  CHECK(robot.act(turn, "(turn 2)").empty());
  CHECK(robot.act(turn, "(turn)") == "expected a number as argument 1, found none");
  CHECK(robot.act(turn, "(turn (3))") == "expected a number as argument 1, found a list");
  CHECK(robot.act(turn, "(turn nan)") == "expected a finite number as argument 1, found nan");
  CHECK(robot.act(turn, "(turn inf)") == "expected a finite number as argument 1, found inf");
  CHECK(law.force == 2);
  CHECK(robot.act(turn, "(turn x)") == "expected a number as argument 1, found 'x', which counts as 0");
  CHECK(law.force == 0);
}

TEST_CASE("the steering effector turns its wheel to the last angle, as fast as it may, in each cycle") {
  Robot robot;
  auto& steering = robot.add(engine::JointType::hinge2, "SteeringEffector", "lf");
  CHECK(robot.act(steering, "(lf 5)").empty());
  CHECK(robot.joint->velocity(0) == 0);
  robot.prepare();
  CHECK(robot.joint->velocity(0) == Approx(10 * degToRad(5)));
  robot.joint->angles[0] = degToRad(6);
  robot.prepare();
  CHECK(robot.joint->velocity(0) == Approx(-10 * degToRad(1)));
  robot.act(steering, "(lf -90)");
  CHECK(getProperty(steering, "angle").toNumber() == -40);
  robot.prepare();
  CHECK(robot.joint->velocity(0) == Approx(-degToRad(180)));
  CHECK(robot.joint->velocity(1) == 0);
}

TEST_CASE("every effector reports arguments that are missing, of another type or superfluous") {
  struct Case {
    engine::JointType above;
    const char *className, *right;  ///< the arguments of a command without a remark
  };
  using engine::JointType;
  const Case c = GENERATE(
      Case{JointType::hinge, "HingeEffector", "1"}, Case{JointType::universal, "UniversalJointEffector", "1 2"},
      Case{JointType::hinge2, "Hinge2Effector", "1"}, Case{JointType::hinge2, "SteeringEffector", "1"},
      Case{JointType::angularMotor, "AngularMotorEffector", "1"}, Case{JointType::slider, "SliderEffector", "1"},
      Case{JointType::hinge, "ControlEffector", "1 2 3 4 5"}, Case{JointType::hinge, "ActuatorEffector", "1"},
      Case{JointType::hinge, "ForceEffector", "1 2 3"}, Case{JointType::hinge, "AgentSyncEffector", ""});
  CAPTURE(c.className);
  Robot robot;
  Effector& effector = std::string(c.className) == "ForceEffector" ? robot.body->create<Effector>(c.className, "x")
                                                                   : robot.add(c.above, c.className, "x");
  const std::string right = c.right;
  const auto remark = [&](const std::string& arguments) { return robot.act(effector, "(x " + arguments + ")"); };
  CHECK(remark(right).empty());
  const auto count = (right.size() + 1) / 2;
  CHECK_THAT(remark(right + " 9"), Catch::StartsWith("expected " + (count == 0 ? "no" : std::to_string(count))));
  CHECK_THAT(remark(right + " 9"), Catch::Contains("found " + std::to_string(count + 1)));
  if (count == 0) return;
  const std::string most = right.substr(0, right.size() - 1), last = std::to_string(count);
  CHECK(remark(most) == "expected a number as argument " + last + ", found none");
  CHECK(remark(most + "(1)") == "expected a number as argument " + last + ", found a list");
  CHECK(remark(most + "nan") == "expected a finite number as argument " + last + ", found nan");
  CHECK(remark(most + "a1") == "expected a number as argument " + last + ", found 'a1', which counts as 0");
}

TEST_CASE("commands that an effector accepts for compatibility, or cannot carry out, are reported") {
  Robot robot;
  CHECK(robot.act(robot.transform->create<Effector>("HMDPEffector", "chip"), "(HMDP x)") ==
        "the motor chip is not emulated: commands have no effect");
  CHECK(robot.act(robot.transform->create<Effector>("CreateEffector", "c"), "(create)") ==
        "expected a file in its property scene, found none: nothing is created");
  Effector& lost = robot.kernel.create<Effector>("ForceEffector", "/usr/lost");
  CHECK(robot.act(lost, "(force 1 2 3)") == "expected a body above or beside it, found none");
}

TEST_CASE("an effector without its joint reports this") {
  Robot robot;
  auto& lost = robot.transform->create<Effector>("HingeEffector", "lost");
  CHECK(robot.act(lost, "(lost 1)") == "expected a HingeJoint above it, found none");
  CHECK(robot.text.find("/usr/robot/lost: expected a HingeJoint above it, found none") != std::string::npos);
  for (const char* className : {"ControlEffector", "ActuatorEffector"})
    CHECK(robot.act(robot.transform->create<Effector>(className, className), "(x 1 2 3 4 5)") ==
          "expected a joint above it, found none");
}

TEST_CASE("only the last force command of a cycle acts, once in the prepare phase") {
  Robot robot;
  auto& force = robot.transform->create<Effector>("ForceEffector", "f");
  CHECK(force.predicate() == "force");
  robot.body->awake = false;
  CHECK(robot.act(force, "(force 1 1 1)").empty());
  CHECK(robot.act(force, "(force 0 0 10)").empty());
  CHECK(robot.act(force, "(force 0 0 inf)") == "expected a finite number as argument 3, found inf");
  CHECK(robot.body->force == Vec3(0, 0, 0));
  robot.prepare();
  CHECK(robot.body->force == Vec3(0, 0, 10));
  CHECK(robot.body->awake);
  robot.prepare();
  CHECK(robot.body->force == Vec3(0, 0, 10));
}

TEST_CASE("some effectors have a fixed predicate, and the one for syn is an ISyncEffector") {
  Robot robot;
  auto& syn = robot.transform->create<Effector>("AgentSyncEffector", "s");
  CHECK(syn.predicate() == "syn");
  CHECK(syn.as<ISyncEffector>() != nullptr);
  CHECK(robot.act(syn, "(syn 1 2 3)") == "expected no arguments, found 3: they are ignored");
  auto& chip = robot.transform->create<Effector>("HMDPEffector", "h");
  CHECK(chip.predicate() == "HMDP");
  auto& create = robot.transform->create<Effector>("CreateEffector", "c");
  CHECK(create.predicate() == "create");
}

TEST_CASE("create tries to build its scene once, and a failure is logged") {
  Robot robot;
  auto& agent = robot.kernel.create<AgentAspect>("AgentAspect", "/usr/agent1");
  auto& create = agent.create<Effector>("CreateEffector", "c");
  setProperty(create, "scene", "rsg/robot.rsg");
  CHECK(robot.act(create, "(create)").empty());
  robot.prepare();
  CHECK(robot.text.find("/usr/agent1/c: nothing is created: ") != std::string::npos);
  robot.text.clear();
  robot.prepare();
  CHECK(robot.text.empty());
}
