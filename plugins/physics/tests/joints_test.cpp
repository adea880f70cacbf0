#include "api/scene_calls.h"
#include "physics_house.h"

using namespace spark;
using namespace spark::test;
using engine::JointType;

namespace {

/// A body 1 m below a fixed one. The joint is a child of the lower body's transform, which is rotated by 90 degrees
/// about z.
struct Pair : PhysicsHost {
  Node& child;
  Node& parent;
  Pair() : child(thing("child", {0, 0, 0})), parent(thing("parent", {0, 0, 1})) {
    call(*scene.find("world"), "setGravity", {0.0, 0.0, 0.0});
    call(child, "setLocalRotation", {0.0, 0.0, 90.0});
    step();  // applies the rotation to the child's body
    Leaf& hold = parent.create("FixedJoint", "hold");
    call(hold, "attach", {"../body"});
    call(hold, "setFixed");
  }
  Leaf& joint(const char* className) {
    Leaf& j = child.create(className, "joint");
    call(j, "attach", {"../body", "../../parent/body"});
    return j;
  }
  IRigidBody& childBody() { return body(child); }
};

double number(Leaf& leaf, const char* method, const List& arguments = {}) {
  return callMethod(leaf, method, arguments).toNumber();
}

}  // namespace

TEST_CASE("anchors and axes can be set before or after the bodies are attached, with the same result") {
  const struct {
    const char* className;
    std::vector<std::pair<const char*, List>> calls;
    int axes;
  } cases[] = {
      {"HingeJoint", {{"setAnchor", {0.1, 0.2, 0.5}}, {"setAxis", {0.0, 0.0, 1.0}}, {"setAxis", {1}}}, 1},
      {"UniversalJoint",
       {{"setAnchor", {0.1, 0.2, 0.5}}, {"setAxis1", {0.0, 0.0, 1.0}}, {"setAxis2", {1.0, 0.0, 0.0}}},
       2},
      {"Hinge2Joint", {{"setAnchor", {0.1, 0.2, 0.5}}}, 2},
      {"BallJoint", {{"setAnchor", {0.1, 0.2, 0.5}}}, 0},
      {"AngularMotor",
       {{"setNumAxes", {2}}, {"setMotorAxis", {0, 1, 0.0, 1.0, 0.0}}, {"setMotorAxis", {1, 2, 0.0, 0.0, 1.0}}},
       2},
  };
  for (const auto& c : cases) {
    INFO(c.className);
    Vec3 anchors[2], axes[2][2];
    std::uint64_t hashes[2];
    for (const bool before : {false, true}) {
      Pair p;
      Leaf& j = p.child.create(c.className, "joint");
      if (!before) p.call(j, "attach", {"../body", "../../parent/body"});
      for (const auto& [method, arguments] : c.calls) p.call(j, method, arguments);
      if (before) p.call(j, "attach", {"../body", "../../parent/body"});
      auto& joint = *j.as<IJoint>();
      anchors[before] = joint.anchor();
      for (int a = 0; a < c.axes; ++a) axes[before][a] = joint.axisNow(a);
      p.childBody().setAngularVelocity({1, 2, 3});
      p.step(20);
      hashes[before] = stateHash(p.scene);
    }
    CHECK(anchors[0] == anchors[1]);
    for (int a = 0; a < c.axes; ++a) {
      CHECK(axes[0][a] == axes[1][a]);
      CHECK(axes[0][a].norm() == Approx(1));
    }
    CHECK(hashes[0] == hashes[1]);
  }
}

TEST_CASE("invalid axes and anchors are refused also before the bodies are attached") {
  Pair p;
  Leaf& j = p.child.create("HingeJoint", "joint");
  CHECK_THROWS_WITH(p.call(j, "setAxis", {0.0, 0.0, 0.0}), Catch::Contains("expected an axis longer than 0"));
  CHECK_THROWS_WITH(p.call(j, "setAnchor", {0.0, std::nan(""), 0.0}),
                    Catch::Contains("expected finite numbers for the anchor"));
}

TEST_CASE("a hinge has its anchor and axis in the joint's frame, angles and motor speed in degrees, and stops") {
  Pair p;
  Leaf& j = p.joint("HingeJoint");
  p.call(j, "setAnchor", {0.0, 0.0, 0.5});
  p.call(j, "setAxis", {0});
  const auto vec = [&](const char* m) {
    const Value v = p.call(j, m);
    return Vec3(v.at(std::size_t(0))->toNumber(), v.at(std::size_t(1))->toNumber(), v.at(std::size_t(2))->toNumber());
  };
  CHECK(vec("getAnchor").isApprox(Vec3(0, 0, 0.5), 1e-6));
  CHECK(vec("getAxis").isApprox(Vec3(0, 1, 0), 1e-6));  // x of a frame rotated by 90 degrees
  p.call(j, "setAxis", {0.0, 1.0, 0.0});
  CHECK(vec("getAxis").isApprox(Vec3(-1, 0, 0), 1e-6));
  CHECK_THROWS_WITH(p.call(j, "setAxis", {1.0, 2.0}), Catch::Contains("0, 1 or 2"));
  p.call(j, "setLowStopDeg", {0, -20.0});
  p.call(j, "setHighStopDeg", {0, 30.0});
  p.call(j, "setStopERP", {0, 0.8});
  CHECK(number(j, "getLowStopDeg", {0}) == Approx(-20));
  CHECK(number(j, "getHighStopPos", {0}) == Approx(degToRad(30)));
  p.call(j, "setMaxMotorForce", {0, 100.0});
  p.call(j, "setAngularMotorVelocity", {0, 90.0});
  p.step(10);
  CHECK(number(j, "getAngle") == Approx(18).margin(0.5));
  CHECK(number(j, "getAngleRate") == Approx(90).margin(1));
  p.step(30);
  CHECK(number(j, "getAngle") == Approx(30).margin(1));
  auto& i = *j.as<IJoint>();
  CHECK(i.jointType() == JointType::hinge);
  CHECK(i.angle(0) == Approx(degToRad(number(j, "getAngle"))));
  CHECK(i.body(0) == &p.childBody());
  CHECK(i.body(1) == p.parent.find<IRigidBody>("body"));
  CHECK_THROWS_WITH(p.call(j, "setMaxMotorForce", {1, 1.0}), Catch::Contains("axis 0"));
}

TEST_CASE("each setting of a joint has a getter that returns the value that was set") {
  Pair p;
  Leaf& j = p.joint("UniversalJoint");
  for (const char* name : {"LowStopPos", "HighStopPos", "LowStopDeg", "HighStopDeg", "FudgeFactor", "Bounce", "CFM",
                           "StopCFM", "StopERP", "LinearMotorVelocity", "AngularMotorVelocity", "MaxMotorForce"})
    for (int axis : {0, 1}) {
      INFO(name);
      p.call(j, (std::string("set") + name).c_str(), {axis, 0.25 + 0.5 * axis});
      CHECK(number(j, (std::string("get") + name).c_str(), {axis}) == Approx(0.25 + 0.5 * axis));
    }
  p.call(j, "setJointMaxSpeed1", {-6.5});
  p.call(j, "setJointMaxSpeed2", {2.0});
  CHECK(j.as<IJoint>()->maxSpeed(0) == 6.5);
  CHECK(j.as<IJoint>()->maxSpeed(1) == 2);
  p.call(j, "setAngularMotorVelocity", {0, 180.0});
  CHECK(j.as<IJoint>()->parameter(engine::JointParameter::velocity, 0) == Approx(kPi));
  j.as<IJoint>()->setParameter(engine::JointParameter::velocity, 0, 1.0);
  CHECK(number(j, "getLinearMotorVelocity", {0}) == 1);
}

TEST_CASE("a joint is written with its anchor and axis while it is as it was made, and not when it has moved") {
  Pair p;
  Leaf& j = p.joint("HingeJoint");
  p.call(j, "setAnchor", {0.1, 0.2, 0.5});
  p.call(j, "setAxis", {0.0, 1.0, 0.0});
  const auto written = [&](const char* method) -> List {
    for (const SceneCall& c : j.as<ISceneCalls>()->sceneCalls())
      if (c.method == method) return c.arguments;
    return {};
  };
  CHECK(written("attach") == List{"../body", "../../parent/body"});
  const List anchor = written("setAnchor");
  REQUIRE(anchor.size() == 3);
  for (int i = 0; i < 3; ++i) CHECK(anchor[i].toNumber() == Approx(List{0.1, 0.2, 0.5}[i].toNumber()).margin(1e-6));
  const List axis = written("setLocalAxis");
  REQUIRE(axis.size() == 4);
  for (int i = 0; i < 4; ++i) CHECK(axis[i].toNumber() == Approx(i == 2 ? 1 : 0).margin(1e-6));

  // Bodies that were put elsewhere, and a hinge that has turned.
  p.childBody().setPosition({0, 0, 0.25});
  CHECK_THROWS_WITH(written("attach"), Catch::Contains("its anchors are 0.25 m apart"));
  p.childBody().setPosition({0, 0, 0});
  p.childBody().setAngularVelocity({1, 0, 0});
  p.step(5);
  CHECK_THROWS_WITH(written("attach"), Catch::Contains("its axis 0 is at"));
}

TEST_CASE("a universal joint returns both angles") {
  Pair p;
  Leaf& j = p.joint("UniversalJoint");
  p.call(j, "setAnchor", {0.0, 0.0, 0.5});
  p.call(j, "setAxis1", {1.0, 0.0, 0.0});
  p.call(j, "setAxis2", {0.0, 1.0, 0.0});
  for (int axis : {0, 1}) {
    p.call(j, "setMaxMotorForce", {axis, 100.0});
    p.call(j, "setAngularMotorVelocity", {axis, axis == 0 ? 45.0 : -30.0});
  }
  p.step(10);
  CHECK(number(j, "getAngle", {0}) == Approx(9).margin(0.5));
  CHECK(number(j, "getAngle", {1}) == Approx(-6).margin(0.5));
  CHECK(number(j, "getAngle") == number(j, "getAngle", {0}));
  CHECK(number(j, "getAngleRate", {1}) == Approx(-30).margin(1));
}

TEST_CASE("a wheel steers about z and rolls about x of the joint's frame once its anchor is set") {
  Pair p;
  // The wheel is the second body.
  Leaf& j = p.child.create("Hinge2Joint", "joint");
  p.call(j, "attach", {"../../parent/body", "../body"});
  p.call(j, "setAnchor", {0.0, 0.0, 0.0});
  p.call(j, "setMaxMotorForce", {1, 100.0});
  p.call(j, "setAngularMotorVelocity", {1, 120.0});
  p.call(j, "setLowStopDeg", {0, 0.0});
  p.call(j, "setHighStopDeg", {0, 0.0});
  p.step(50);
  CHECK(std::abs(number(j, "getAngleRate", {1})) == Approx(120).margin(3));
  // The x axis of the joint's frame is the y axis of the world.
  CHECK(std::abs(p.childBody().state().angularVelocity.y()) == Approx(degToRad(120)).margin(0.05));
  CHECK(std::abs(number(j, "getAngle", {0})) < 2);
}

TEST_CASE("a slider slides along the z axis that the joint's frame had when it was attached") {
  Pair p;
  p.call(p.child, "setLocalRotation", {90.0, 0.0, 0.0});  // local z is world -y
  p.step();
  Leaf& j = p.joint("SliderJoint");
  p.childBody().setVelocity({0, -1, 0});
  p.step(10);
  CHECK(number(j, "getPosition") == Approx(0.2).margin(0.01));
  CHECK(number(j, "getPositionRate") == Approx(1).margin(0.02));
  p.childBody().setVelocity({1, 0, 0});
  p.step(10);
  CHECK(std::abs(p.childBody().state().position.x()) < 0.02);
  p.call(j, "setHighStopPos", {0, 0.3});
  p.call(j, "setLowStopPos", {0, -0.3});
  CHECK(number(j, "getHighStopPos", {0}) == 0.3);
}

TEST_CASE("a ball joint holds its anchor, and a fixed joint holds the pose even without setFixed") {
  Pair p;
  Leaf& j = p.joint("BallJoint");
  p.call(j, "setAnchor", {0.0, 0.0, 0.5});
  p.childBody().setAngularVelocity({1, 0, 1});
  p.step(20);
  const auto s = p.childBody().state();
  CHECK((s.position + s.rotation * Vec3(0, 0, 0.5) - Vec3(0, 0, 0.5)).norm() < 0.01);
  CHECK(s.angularVelocity.norm() > 0.3);
  p.child.remove(j);
  const Vec3 at = p.childBody().state().position;
  p.joint("FixedJoint");
  p.childBody().setVelocity({1, 0, 0});
  p.childBody().setAngularVelocity({0, 0, 1});
  p.step(20);
  CHECK((p.childBody().state().position - at).norm() < 0.03);
}

TEST_CASE("a path without a body is logged and attaches the joint to the static world") {
  Pair p;
  Leaf& j = p.child.create("BallJoint", "joint");
  p.call(j, "attach", {"../body", "../../nobody/body"});
  CHECK_THAT(p.text, Catch::Contains("/usr/scene/child/joint") && Catch::Contains("../../nobody/body") &&
                         Catch::Contains("static world"));
  CHECK(j.as<IJoint>()->body(1) == nullptr);
  CHECK(j.as<IJoint>()->body(0) == &p.childBody());
  CHECK_THROWS_WITH(p.call(j, "attach", {"../body", "../body"}), Catch::Contains("with itself"));
}

TEST_CASE("feedback gives the torque that a joint carries") {
  Pair p;
  Node& arm = p.thing("arm", {1, 0, 5});
  Leaf& j = arm.create("HingeJoint", "joint");
  p.call(j, "attach", {"../body"});
  p.call(j, "setAnchor", {-1.0, 0.0, 0.0});
  p.call(j, "setAxis", {2});
  CHECK(j.as<IJoint>()->feedbackTorque() == 0);
  p.call(j, "enableFeedback", {true});
  for (int i = 0; i < 20; ++i) {
    p.body(arm).addTorque({3, 4, 0});
    p.step();
  }
  CHECK(j.as<IJoint>()->feedbackTorque() == Approx(5).epsilon(0.01));
  CHECK(getProperty(j, "torque").toNumber() == j.as<IJoint>()->feedbackTorque());
  p.call(j, "enableFeedback", {false});
  CHECK(j.as<IJoint>()->feedbackTorque() == 0);
}

TEST_CASE("an angular motor drives its hinge and has the parameters of a real motor") {
  Pair p;
  Leaf& hinge = p.joint("HingeJoint");
  p.call(hinge, "setAnchor", {0.0, 0.0, 0.5});
  p.call(hinge, "setAxis", {2});
  Leaf& m = hinge.asNode()->create("AngularMotor", "motor");
  p.call(m, "setNumAxes", {1});
  p.call(m, "attach", {"../../body", "../../../parent/body"});
  p.call(m, "setMotorAxis", {0, 1, 0.0, 0.0, 1.0});
  CHECK(number(m, "getAxisAnchor", {0}) == 1);
  CHECK(p.call(m, "getMode").toString() == "user");
  p.call(m, "setMaxMotorForce", {0, 50.0});
  p.call(m, "setAngularMotorVelocity", {0, 60.0});
  p.step(20);
  CHECK(number(m, "getAxisAngleRate", {0}) == Approx(60).margin(1));
  CHECK(number(m, "getAxisAngle", {0}) == Approx(number(hinge, "getAngle")));
  CHECK(std::abs(number(hinge, "getAngle")) == Approx(24).margin(1));
  p.call(m, "setAxisAngle", {0, 12.0});
  CHECK(m.as<IJoint>()->angle(0) == Approx(degToRad(12)));
  p.call(m, "setEulerMode");
  CHECK(p.call(m, "getMode").toString() == "euler");
  p.call(m, "setUserMode");
  for (const auto& [name, standard] :
       std::initializer_list<std::pair<const char*, double>>{{"SpeedConstant", 4.3},
                                                             {"TorqueConstant", 4.3},
                                                             {"Resistance", 6.44},
                                                             {"EnvironmentTempeature", 20},
                                                             {"ThermalConductivity", 0.025},
                                                             {"HeatCapacity", 26},
                                                             {"ProtectionTempeature", 80},
                                                             {"ProtectionStiffness", 0.8},
                                                             {"MaxTorque", 0}}) {
    INFO(name);
    CHECK(number(m, (std::string("get") + name).c_str()) == standard);
    p.call(m, (std::string("set") + name).c_str(), {0.5});
    CHECK(number(m, (std::string("get") + name).c_str()) == 0.5);
  }
  p.call(m, "setBattery", {"../Battery"});
  CHECK_THROWS(p.call(m, "setNumAxes", {4}));
  CHECK_THROWS_WITH(p.call(m, "setMotorAxis", {0, 5, 0.0, 0.0, 1.0}), Catch::Contains("first body"));
  auto& server = *p.kernel.root().find("/sys/server/physics");
  p.call(server, "setJointHeating", {true});
  p.call(server, "setBatteryDischarge", {true});
  CHECK(getProperty(server, "jointHeating").toBool());
}

TEST_CASE("a simulated motor heats up and drains its battery, which makes it weaker or disables it") {
  Pair p;
  Leaf& hinge = p.joint("HingeJoint");
  p.call(hinge, "setAnchor", {0.0, 0.0, 0.0});
  p.call(hinge, "setAxis", {2});
  Leaf& battery = p.scene.create("Battery", "battery");
  p.call(battery, "setPower", {1000.0});
  Leaf& m = hinge.asNode()->create("AngularMotor", "motor");
  p.call(m, "setNumAxes", {1});
  p.call(m, "attach", {"../../body", "../../../parent/body"});
  p.call(m, "setMotorAxis", {0, 1, 0.0, 0.0, 1.0});
  p.call(m, "enableFeedback", {true});
  p.call(m, "setBattery", {"/usr/scene/battery"});
  p.call(m, "setMaxTorque", {2.0});
  p.call(m, "setTorqueConstant", {2.0});
  p.call(m, "setAngularMotorVelocity", {0, 20000.0});  // unreachable, so the motor uses its maximum torque
  const auto strength = [&] { return number(m, "getMaxMotorForce", {0}); };
  const auto value = [](const Leaf& leaf, const char* name) { return getProperty(leaf, name).toNumber(); };

  p.step();
  CHECK(strength() == 2);
  CHECK(value(m, "current") == Approx(1).epsilon(1e-3));
  CHECK(value(m, "temperature") == 20);  // heating is not simulated yet
  CHECK(value(battery, "power") == 1000);

  auto& server = *p.kernel.root().find("/sys/server/physics");
  p.call(server, "setJointHeating", {true});
  p.call(server, "setBatteryDischarge", {true});
  p.step();
  const double i = value(m, "current"), rate = std::abs(degToRad(number(hinge, "getAngleRate")));
  CHECK(value(m, "temperature") == Approx(20 + i * i * 6.44 * 0.02 / 26));
  CHECK(value(battery, "power") == Approx(1000 - (4.3 * rate * i + i * i * 6.44) * 0.02));

  p.call(m, "setTemperature", {81.0});
  CHECK(getProperty(m, "disabled") == Value(true));
  p.step();
  CHECK(strength() == Approx(1.6));
  p.call(m, "setStiffness", {0.5});
  p.step();
  CHECK(strength() == 1);
  p.call(m, "setTemperature", {30.0});
  CHECK(getProperty(m, "disabled") == Value(false));
  p.call(battery, "setPower", {0.0});
  CHECK(getProperty(m, "disabled") == Value(true));
  p.step();
  CHECK(strength() == 0);
  CHECK(value(battery, "power") == 0);
  Leaf& full = p.scene.create("Battery", "full");
  p.call(full, "setPower", {1000.0});
  p.call(m, "setBattery", {"/usr/scene/full"});
  p.call(battery, "setPower", {0.0});
  CHECK(getProperty(m, "disabled") == Value(false));
  p.call(m, "setBattery", {"/usr/scene/battery"});  // has an effect at once
  CHECK(getProperty(m, "disabled") == Value(true));
}

TEST_CASE("motors and batteries are available to other plugins through their interfaces") {
  Pair p;
  Leaf& store = p.scene.create("Battery", "battery");
  p.call(store, "setCapacity", {1000.0});
  p.call(store, "setPower", {250.0});
  const auto battery = store.as<IBattery>();
  REQUIRE(battery);
  CHECK(battery->power() == 250);
  CHECK(battery->capacity() == 1000);

  Leaf& node = p.joint("AngularMotor");
  auto motor = node.as<IMotor>();
  REQUIRE(motor);
  CHECK_FALSE(p.joint("HingeJoint").as<IMotor>());
  CHECK(motor->current() == 0);
  CHECK_FALSE(motor->disabled());
  motor->setStiffness(0.25);
  CHECK(getProperty(node, "stiffness").toNumber() == 0.25);
  motor->setStiffness(7);
  CHECK(motor->stiffness() == 1);
  p.call(node, "setMaxTorque", {2.0});
  p.call(node, "setTemperature", {81.0});
  CHECK(motor->temperature() == 81);
  CHECK(motor->disabled());
  CHECK_FALSE(node.as<IJoint>()->feedback());
  p.call(node, "enableFeedback", {true});
  CHECK(node.as<IJoint>()->feedback());
}

TEST_CASE("a cone twist joint is accepted and constrains nothing") {
  Pair p;
  Leaf& j = p.joint("ConeTwistJoint");
  p.childBody().setVelocity({0, 0, -1});
  p.step(10);
  CHECK(p.childBody().state().position.z() == Approx(-0.2).margin(0.01));
  CHECK(j.as<IJoint>()->angle(0) == 0);
  CHECK_THROWS_WITH(p.scene.create("Generic6DOFJoint"), Catch::Contains("Generic6DOFJoint"));
}

TEST_CASE("a script that sets a motor ends the controller, and one that sets a controller ends the motor") {
  Pair p;
  Leaf& j = p.joint("HingeJoint");
  p.call(j, "setAxis", {0.0, 0.0, 1.0});
  const auto rate = [&] { return p.step(100), number(j, "getAngleRate"); };
  p.call(j, "setController", {0, 0.0, 10.0, 0.0, degToRad(-90), 0.0, 1000.0});
  CHECK(rate() == Approx(-90).epsilon(0.05));
  p.call(j, "setMaxMotorForce", {0, 1000.0});
  p.call(j, "setAngularMotorVelocity", {0, 45.0});
  CHECK(rate() == Approx(45).epsilon(0.05));
  p.call(j, "setController", {0, 0.0, 10.0, 0.0, degToRad(-90), 0.0, 1000.0});
  CHECK(rate() == Approx(-90).epsilon(0.05));
  CHECK(number(j, "getMaxMotorForce", {0}) == 0);
}

TEST_CASE("a piston slides and turns: a slider and a hinge with a connector between them") {
  PhysicsHost host;
  setProperty(host.scene.require<Leaf>("world"), "gravity", List{0.0, 0.0, 0.0});
  Node& between = host.thing("between", {0, 0, 1});
  host.call(*between.find("body"), "setSphereTotal", {0.2, 0.1});
  setProperty(*between.find("body"), "connector", true);
  Node& rod = host.thing("rod", {0, 0, 1});
  host.call(*rod.find("body"), "setCylinderTotal", {1.0, 0.1, 0.5});
  Leaf& slider = between.create("SliderJoint", "slider");
  host.call(slider, "attach", {"../body"});
  Leaf& hinge = rod.create("HingeJoint", "hinge");
  host.call(hinge, "attach", {"../body", "../../between/body"});
  host.call(hinge, "setAnchor", {0.0, 0.0, 0.0});
  host.call(hinge, "setAxis", {0.0, 0.0, 1.0});
  for (Leaf* j : {&slider, &hinge}) host.call(*j, "setMaxMotorForce", {0, 100.0});
  host.call(slider, "setLinearMotorVelocity", {0, 0.2});
  host.call(hinge, "setAngularMotorVelocity", {0, 90.0});
  host.step(50);
  CHECK(host.call(slider, "getPosition").toNumber() == Approx(0.2).margin(0.01));
  CHECK(host.call(hinge, "getAngle").toNumber() == Approx(90).margin(4));
  const engine::BodyState s = host.body(rod).state();
  CHECK((s.position - Vec3(0, 0, 1.2)).norm() < 0.02);
  CHECK(s.rotation(2, 2) > 0.999);
}
