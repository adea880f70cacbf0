#include <catch2/catch.hpp>

#include "api/match.h"
#include "fake_physics.h"
#include "spark/state.h"
#include "test_support.h"

using namespace spark;
using namespace spark::test;

namespace {

/// An echo target without other features.
class Post : public SceneNode, public IEchoTarget {
  SPARK_CLASS(Post, SceneNode)
 public:
  static void describe(Description<Post>& d) { d.implements<IEchoTarget>(); }
};

/// A robot with a single transform `/usr/robot` and a body. Tests add sensors to it.
struct Robot : TestHost {
  Robot() {
    registerFakePhysics(kernel);
    kernel.plugins().use("sensors");
    transform = &kernel.create<Transform>("Transform", "/usr/robot");
    body = &transform->create<FakeBody>("FakeBody", "body");
  }
  std::string sense(Leaf& sensor) {
    Predicates out;
    sensor.as<Perceptor>()->sense(out, event("sense"));
    return sexpOf(out);
  }
  Event event(const char* name) { return {name, 7.36, 0.02, 1, nullptr}; }
  void prepare() { kernel.events().channel("prepare").emit(event("prepare")); }
  FakeJoint& joint(engine::JointType type) {
    auto& j = transform->create<FakeJoint>("FakeJoint", "joint");
    j.type = type;
    return j;
  }
  Transform* transform;
  FakeBody* body;
};

}  // namespace

TEST_CASE("the time perceptor reports simulated seconds") {
  Robot robot;
  CHECK(robot.sense(robot.transform->create("TimePerceptor", "t")) == "(time (now 7.36))");
}

TEST_CASE("joint sensors report degrees in the formats of the installed base") {
  Robot robot;
  SECTION("hinge") {
    auto& joint = robot.joint(engine::JointType::hinge);
    joint.angles = {degToRad(-1.154), 0, 0};
    CHECK(robot.sense(joint.create("HingePerceptor", "hj2")) == "(HJ (n hj2) (ax -1.15))");
  }
  SECTION("universal") {
    auto& joint = robot.joint(engine::JointType::universal);
    joint.angles = {degToRad(10), degToRad(-20), 0};
    CHECK(robot.sense(joint.create("UniversalJointPerceptor", "uj")) == "(UJ (n uj) (ax1 10.00) (ax2 -20.00))");
  }
  SECTION("hinge2 reports its axis first") {
    auto& joint = robot.joint(engine::JointType::hinge2);
    joint.angles = {degToRad(12.5), 1, 0};
    CHECK(robot.sense(joint.create("Hinge2Perceptor", "wheel")) == "(H2J (n wheel) (ax 0 12.50))");
  }
  SECTION("a joint of another type in between is skipped") {
    auto& outer = robot.joint(engine::JointType::hinge);
    outer.angles[0] = degToRad(5);
    auto& inner = outer.create<FakeJoint>("FakeJoint", "inner");
    inner.type = engine::JointType::angularMotor;
    CHECK(robot.sense(inner.create("HingePerceptor", "h")) == "(HJ (n h) (ax 5.00))");
  }
  SECTION("without a joint it is silent and logs why") {
    CHECK(robot.sense(robot.transform->create("HingePerceptor", "lost")).empty());
    CHECK(robot.text.find("/usr/robot/lost: expected a HingeJoint above it") != std::string::npos);
  }
}

TEST_CASE("the joint sensor reports angle and rate, in degrees unless the joint slides") {
  Robot robot;
  SECTION("hinge") {
    auto& joint = robot.joint(engine::JointType::hinge);
    joint.angles = {degToRad(-1.154), 9, 9};
    joint.rates = {degToRad(30), 9, 9};
    CHECK(robot.sense(joint.create("JointPerceptor", "q_hj1")) == "(HJ (n q_hj1) (ax -1.15) (vx 30.00))");
  }
  SECTION("slider: m and m/s") {
    auto& joint = robot.joint(engine::JointType::slider);
    joint.angles = {0.25, 0, 0};
    joint.rates = {-1.5, 0, 0};
    CHECK(robot.sense(joint.create("JointPerceptor", "lift")) == "(HJ (n lift) (ax 0.25) (vx -1.50))");
  }
  SECTION("the nearest joint above, of any type") {
    auto& outer = robot.joint(engine::JointType::hinge);
    outer.angles[0] = 1;
    auto& inner = outer.create<FakeJoint>("FakeJoint", "inner");
    inner.type = engine::JointType::slider;
    CHECK(robot.sense(inner.create("JointPerceptor", "j")) == "(HJ (n j) (ax 0.00) (vx 0.00))");
  }
  SECTION("without a joint it is silent and logs why") {
    CHECK(robot.sense(robot.transform->create("JointPerceptor", "lost")).empty());
    CHECK_THAT(robot.text, Catch::Contains("/usr/robot/lost: expected "));
  }
}

TEST_CASE("pose sensors report the position and the orientation of their transform in the world") {
  Robot robot;
  auto& head = robot.transform->create<Transform>("Transform", "head");
  Leaf& position = head.create("PositionPerceptor", "head_pos");
  Leaf& rotation = head.create("OrientationPerceptor", "head_quat");
  CHECK(robot.sense(position) == "(pos (n head_pos) (p 0.00 0.00 0.00))");
  CHECK(robot.sense(rotation) == "(quat (n head_quat) (q 1.00 0.00 0.00 0.00))");
  robot.transform->setLocalPos({1, 2, 3});
  robot.transform->setLocalRotationDeg(0, 0, 90);
  head.setLocalPos({0.5f, 0, -0.25f});
  CHECK(robot.sense(position) == "(pos (n head_pos) (p 1.00 2.50 2.75))");
  CHECK(robot.sense(rotation) == "(quat (n head_quat) (q 0.71 0.00 0.00 0.71))");
  // The pose is that of the last place phase.
  robot.transform->setLocalRotationDeg(60, 0, 0);
  CHECK(robot.sense(rotation) == "(quat (n head_quat) (q 0.71 0.00 0.00 0.71))");
  head.updateWorld(true);
  CHECK(robot.sense(rotation) == "(quat (n head_quat) (q 0.87 0.50 0.00 0.00))");
}

TEST_CASE("the angular motor's sensor reports the enabled items, and the temperature only after a change") {
  Robot robot;
  auto& hinge = robot.joint(engine::JointType::hinge);
  hinge.angles[0] = degToRad(3);
  hinge.rates[0] = degToRad(30);
  auto& motor = hinge.create<FakeJoint>("FakeJoint", "motor");
  motor.type = engine::JointType::angularMotor;
  motor.torque = 1.5;
  motor.device.current = 0.25;
  Leaf& sensor = motor.create("AngularMotorPerceptor", "hj1");
  CHECK(robot.sense(sensor) == "(HJ (n hj1) (ax 3.00))");
  for (const char* item : {"senseRate", "senseTorque", "senseTemperature", "senseCurrent"})
    setProperty(sensor, item, true);
  CHECK(robot.sense(sensor) == "(HJ (n hj1) (ax 3.00) (rt 30.00) (tq 1.50) (tp 23.00) (ct 250.00))");
  motor.device.temperature = 24;
  CHECK(robot.sense(sensor) == "(HJ (n hj1) (ax 3.00) (rt 30.00) (tq 1.50) (ct 250.00))");
  motor.device.temperature = 24.5;
  CHECK(robot.sense(sensor) == "(HJ (n hj1) (ax 3.00) (rt 30.00) (tq 1.50) (tp 24.50) (ct 250.00))");
}

TEST_CASE("the gyroscope reports degrees per second in the body's own frame") {
  Robot robot;
  Leaf& gyro = robot.transform->create("GyroRatePerceptor", "torso");
  robot.body->now.angularVelocity = {degToRad(90), 0, degToRad(1)};
  robot.transform->setLocalRotationDeg(0, 0, 90);
  CHECK(robot.sense(gyro) == "(GYR (n torso) (rt -0.00 -90.00 1.00))");
}

TEST_CASE("the accelerometer samples before the step and measures 0 in free fall") {
  Robot robot;
  Leaf& sensor = robot.transform->create("Accelerometer", "torso");
  CHECK(robot.sense(sensor) == "(ACC (n torso) (a 0.00 0.00 0.00))");
  robot.prepare();  // at rest
  CHECK(robot.sense(sensor) == "(ACC (n torso) (a 0.00 0.00 9.81))");
  robot.body->now.linearVelocity = {0, 0, -9.81 * 0.02};
  CHECK(robot.sense(sensor) == "(ACC (n torso) (a 0.00 0.00 9.81))");  // one cycle late
  robot.prepare();
  CHECK(robot.sense(sensor) == "(ACC (n torso) (a 0.00 0.00 0.00))");
  robot.body->now.linearVelocity = {0, 0, -2 * 9.81 * 0.02};
  robot.prepare();
  CHECK(robot.sense(sensor) == "(ACC (n torso) (a 0.00 0.00 0.00))");
  robot.body->now.linearVelocity = Vec3::Zero();  // stopped at once, as by a beam
  robot.prepare();
  CHECK(robot.sense(sensor) == "(ACC (n torso) (a 0.00 0.00 29.43))");
}

TEST_CASE("an accelerometer beside the centre of mass senses how its place is accelerated, in its own frame") {
  Robot robot;
  auto& rim = robot.transform->create<Transform>("Transform", "rim");
  auto& place = rim.create<Transform>("Transform", "place");
  rim.setLocalPos({0.5f, 0, 0});
  place.setLocalRotationDeg(0, 0, 90);  // its x axis is the body's y axis
  Leaf& sensor = place.create("Accelerometer", "rim");
  CHECK_THROWS_WITH(setProperty(sensor, "gravity", List{1.0}), Catch::Contains("expected 3 numbers"));
  setProperty(sensor, "gravity", List{0.0, 0.0, -2.0});
  robot.body->now.angularVelocity = {0, 0, 2};
  robot.prepare();
  robot.prepare();
  CHECK(robot.sense(sensor) == "(ACC (n rim) (a 0.00 2.00 2.00))");  // 2^2 * 0.5 to the centre
  robot.body->now.angularVelocity = {0, 0, 2.2};
  robot.prepare();
  CHECK(robot.sense(sensor) == "(ACC (n rim) (a 5.00 2.42 2.00))");  // 0.2 / 0.02 * 0.5 along its way
  setProperty(sensor, "gravity", List{});
  robot.prepare();
  CHECK(robot.sense(sensor) == "(ACC (n rim) (a 0.00 2.42 9.81))");
}

TEST_CASE("a foot sensor reports the force-weighted mean point and the total force in its frame, only on contact") {
  Robot robot;
  Leaf& sensor = robot.transform->create("ForceResistancePerceptor", "rf");
  auto& foot = robot.transform->create<FakeCollider>("FakeCollider", "foot");
  auto& floor = robot.kernel.create<FakeCollider>("FakeCollider", "/usr/floor");
  auto& handler = foot.create<CollisionHandler>("TouchPerceptorHandler", "touch");
  robot.transform->setLocalPos({1, 0, 0.5f});

  const auto contact = [&](Vec3 point, Vec3 force, bool direct, bool solve) {
    engine::Contact c{};
    c.position = point;
    c.solve = solve;
    const Collision collision{foot, floor, c, direct};
    handler.onCollision(collision);
    const bool wanted = c.feedback;
    c.forceOnA = force;
    handler.onSolved(collision);
    return wanted;
  };
  CHECK(handler.surface() != nullptr);

  robot.prepare();
  CHECK(robot.sense(sensor).empty());
  CHECK(contact({1.1, 0, 0.4}, {0, 0, 30}, true, true));
  CHECK(contact({0.9, 0, 0.4}, {0, 0, 10}, true, true));
  CHECK(robot.sense(sensor) == "(FRP (n rf) (c 0.05 0.00 -0.10) (f 0.00 0.00 40.00))");

  robot.prepare();
  CHECK(robot.sense(sensor).empty());

  robot.prepare();  // a sleeping body has contacts but no forces
  contact({1, 0, 0.4}, Vec3::Zero(), true, true);
  CHECK(robot.sense(sensor) == "(FRP (n rf) (c 0.05 0.00 -0.10) (f 0.00 0.00 40.00))");

  robot.prepare();  // symmetric contacts and contacts that are not solved are ignored
  CHECK_FALSE(contact({1, 0, 0.4}, {0, 0, 9}, false, true));
  contact({1, 0, 0.4}, {0, 0, 9}, true, false);
  CHECK(robot.sense(sensor).empty());

  robot.transform->setLocalRotationDeg(0, 0, 90);
  robot.prepare();
  contact({1, 0.2, 0.4}, {5, 0, 1}, true, true);
  CHECK(robot.sense(sensor) == "(FRP (n rf) (c 0.20 0.00 -0.10) (f -0.00 -5.00 1.00))");
}

TEST_CASE("collision sensors report the contacts since the last percept") {
  Robot robot;
  auto& shell = robot.transform->create<FakeCollider>("FakeCollider", "shell");
  auto& ball = robot.kernel.create<FakeCollider>("FakeCollider", "/usr/ball");
  auto& wall = robot.kernel.create<FakeCollider>("FakeCollider", "/usr/wall");
  auto& handler = shell.create<CollisionHandler>("PerceptorHandler", "handler");
  engine::Contact contact{};
  CHECK(handler.surface() == nullptr);

  SECTION("names") {
    Leaf& sensor = robot.transform->create("CollisionPerceptor", "c");
    CHECK(robot.sense(sensor).empty());
    handler.onCollision({shell, ball, contact, true});
    handler.onCollision({shell, ball, contact, true});
    handler.onCollision({shell, wall, contact, false});
    handler.onCollision({shell, ball, contact, true});
    const auto hash = stateHash(sensor);
    CHECK(robot.sense(sensor) == "(collision ball wall)");
    CHECK(stateHash(sensor) != hash);
    CHECK(robot.sense(sensor).empty());
  }
  SECTION("names that were not reported yet are part of the saved state") {
    Leaf& sensor = robot.transform->create("CollisionPerceptor", "c");
    StateWriter out(true);
    handler.onCollision({shell, ball, contact, true});
    handler.onCollision({shell, wall, contact, true});
    saveTree(sensor, out);
    const auto hash = stateHash(sensor);
    CHECK(robot.sense(sensor) == "(collision ball wall)");
    handler.onCollision({shell, shell, contact, true});
    StateReader in(out.bytes());
    loadTree(sensor, in);
    CHECK(in.atEnd());
    CHECK(stateHash(sensor) == hash);
    handler.onCollision({shell, ball, contact, true});
    CHECK(robot.sense(sensor) == "(collision ball wall)");
    CHECK(robot.sense(sensor).empty());
  }
  SECTION("touch") {
    Leaf& sensor = robot.transform->create("TouchPerceptor", "lf");
    CHECK(robot.sense(sensor) == "(TCH (n lf) (val 0))");
    handler.onCollision({shell, ball, contact, true});
    CHECK(robot.sense(sensor) == "(TCH (n lf) (val 1))");
    CHECK(robot.sense(sensor) == "(TCH (n lf) (val 0))");
  }
}

TEST_CASE("the GPS reports the world matrix, row-major") {
  Robot robot;
  robot.transform->setLocalPos({1, 2, 3});
  CHECK(robot.sense(robot.transform->create("GPS", "torso")) ==
        "(GPS (n torso) (tf 1.00 0.00 0.00 1.00 0.00 1.00 0.00 2.00 0.00 0.00 1.00 3.00 0.00 0.00 0.00 1.00))");
}

TEST_CASE("the battery sensor uses the name of its node, and is silent without a battery") {
  Robot robot;
  auto& battery = robot.transform->create<FakeBattery>("FakeBattery", "battery");
  CHECK(robot.sense(battery.create("BatteryPerceptor", "BAT")) == "(BAT 0.75)");
  CHECK(robot.sense(robot.transform->create("BatteryPerceptor", "BAT")).empty());
  CHECK(robot.text.find("expected an IBattery above it, found none. It senses nothing.") != std::string::npos);
}

TEST_CASE("sensors that are accepted but not simulated keep their settings and are silent") {
  Robot robot;
  for (const char* name : {"ImagePerceptor", "HMDPPerceptor"})
    CHECK(robot.sense(robot.transform->create(name, name)).empty());
  Leaf& image = *robot.transform->find("ImagePerceptor");
  callMethod(image, "setResolution", std::vector<Value>{640, 480});
  callMethod(image, "setFOV", std::vector<Value>{45.0});
  CHECK(getProperty(image, "width") == Value(640));
  CHECK(getProperty(image, "fov") == Value(45.0));
}

TEST_CASE("a sonar reports the echo targets in its cone, nearest first, without those of its own robot") {
  Robot robot;
  robot.kernel.registerClass<Post>();
  const auto put = [&](const char* aspect, const char* name, const Vec3f& at, const char* mark) -> Node& {
    auto& node = robot.kernel.create<Transform>(aspect, std::string("/usr/") + name);
    node.setLocalPos(at);
    node.create(mark, "mark");
    return node;
  };
  auto& self = robot.kernel.create<Transform>("AgentAspect", "/usr/self");
  self.create("Post", "torso");
  auto& chest = self.create<Transform>("Transform", "chest");
  chest.setLocalPos({0, 0, 0.4f});
  Leaf& sonar = chest.create("SonarPerceptor", "Left");
  setProperty(sonar, "maxEchoes", 4);
  CHECK(robot.sense(sonar) == "(US Left (5.00 5.00 5.00 5.00))");
  put("Transform", "post", {0, 3, 0.8f}, "Post");
  put("AgentAspect", "near", {1, 2, 0}, "Post");
  put("AgentAspect", "touching", {0, 0.1f, 0}, "Post");
  put("Transform", "beside", {2, 2, 0}, "Post");
  put("Transform", "behind", {0, -1, 0}, "Post");
  put("Transform", "far", {0, 5.1f, 0}, "Post");
  CHECK(robot.sense(sonar) == "(US Left (0.25 2.24 3.00 5.00))");
  // Targets come and go.
  Node& newcomer = put("AgentAspect", "newcomer", {0, 1.5f, 0}, "Post");
  CHECK(robot.sense(sonar) == "(US Left (0.25 1.50 2.24 3.00))");
  newcomer.parent()->remove(newcomer);
  robot.kernel.root().find("/usr/touching")->parent()->remove(*robot.kernel.root().find("/usr/touching"));
  CHECK(robot.sense(sonar) == "(US Left (2.24 3.00 5.00 5.00))");
  chest.setLocalRotationDeg(0, 0, 180);
  CHECK(robot.sense(sonar) == "(US Left (1.00 5.00 5.00 5.00))");
  callMethod(sonar, "setRange", std::vector<Value>{0.5, 0.9});
  CHECK(robot.sense(sonar) == "(US Left (0.90 0.90 0.90 0.90))");
  callMethod(sonar, "setRange", std::vector<Value>{0.5, 4.0});
  callMethod(sonar, "addNoise", std::vector<Value>{true});
  std::string all;
  for (int i = 0; i < 20; ++i) all += robot.sense(sonar);
  CHECK_THAT(all, Catch::Contains("(US Left (0.99 ") && Catch::Contains("(US Left (1.01 "));
}
