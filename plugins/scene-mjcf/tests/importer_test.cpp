// Imports models into the tree.

#include "../../physics/tests/physics_house.h"
#include "api/agents.h"
#include "temporary_folder.h"

namespace spark::test {
namespace {

struct MjcfHost : PhysicsHost {
  TemporaryFolder folder;
  MjcfHost() {
    for (const char* plugin : {"files", "scene-mjcf"}) kernel.plugins().use(plugin);
    kernel.create("FileServer", "/sys/server/file");
    setProperty(kernel.create("DirectoryFileSystem", "/sys/server/file/folder"), "path", folder.path().string());
    kernel.create("MjcfImporter", "/sys/server/scene/mjcf");
  }
  void import(const std::string& text, const List& arguments = {}) {
    folder.write("m.xml", text);
    List all{"m.xml"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    call(scene, "importScene", all);
  }
  std::string failure(const std::string& text) {
    try {
      import(text);
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  }
  template <class T>
  T& at(const std::string& path) {
    return kernel.root().require<T>("/usr/scene/" + path);
  }
  Vec3 position(const std::string& body) { return at<IRigidBody>(body).state().position; }
};

const char* const kArm = R"(<mujoco model='arm'><compiler autolimits='true'/><worldbody>
  <body name='upper' pos='0 0 1'><joint name='shoulder' axis='0 1 0' range='-90 90'/>
    <inertial mass='2' pos='0.5 0 0' diaginertia='0.1 0.2 0.3'/>
    <geom name='bar' type='box' size='0.5 0.1 0.1' pos='0.5 0 0'/>
    <site name='tip' pos='1 0 0'/>
    <body name='lower' pos='1 0 0'><joint name='elbow' axis='0 0 1' damping='0.5'/>
      <geom name='rod' type='capsule' size='0.05' fromto='0 0 0 1 0 0' mass='1'/>
      <body name='hand' pos='1 0 0'><geom name='ball' size='0.1' mass='1'/></body></body></body></worldbody>
  <contact><exclude body1='upper' body2='hand'/></contact></mujoco>)";

}  // namespace

TEST_CASE("bodies, joints and colliders have the poses of the file") {
  MjcfHost h;
  h.import(kArm);
  CHECK(h.position("arm/upper/body").isApprox(Vec3(0.5, 0, 1)));
  // The hand has no joint, so it is part of the lower arm.
  CHECK(h.at<IRigidBody>("arm/lower/body").mass() == 2);
  CHECK(h.position("arm/lower/body").isApprox(Vec3(1.75, 0, 1)));
  auto& shoulder = h.at<IJoint>("arm/upper/shoulder");
  CHECK(shoulder.anchor().isApprox(Vec3(0, 0, 1)));
  CHECK(shoulder.axisNow(0).isApprox(Vec3::UnitY()));
  CHECK(shoulder.parameter(engine::JointParameter::highStop, 0) == Approx(kPi / 2));
  auto& elbow = h.at<IJoint>("arm/lower/elbow");
  CHECK(elbow.body(1) == &h.at<IRigidBody>("arm/upper/body"));
  CHECK(elbow.anchor().isApprox(Vec3(1, 0, 1)));
  CHECK(elbow.parameter(engine::JointParameter::damping, 0) == 0.5);
  Vec3 low, high;
  h.at<ICollider>("arm/lower/ball").bounds(low, high);
  CHECK(low.isApprox(Vec3(1.9, -0.1, 0.9), 1e-6));
  CHECK(toPose(h.at<Transform>("arm/upper/tip").worldNow()).position.isApprox(Vec3(1, 0, 1), 1e-6));
  CHECK(getProperty(h.at<ICollider>("arm/upper/bar").leaf(), "notCollideWith").toList().size() == 1);
  h.step(25);
  CHECK(h.position("arm/lower/body").z() < 0.9);
}

TEST_CASE("a model can be imported with a prefix for its names and below a transform, and be removed") {
  MjcfHost h;
  Node& parent = h.transform(h.scene, "place", {5, 0, 0});
  h.folder.write("m.xml", kArm);
  h.call(parent, "importScene", {"m.xml", "r-"});
  CHECK(h.position("place/r-arm/r-upper/body").isApprox(Vec3(5.5, 0, 1)));
  h.import(kArm);
  h.step(2);
  parent.remove(*parent.child("r-arm"));
  h.step(2);
  CHECK(h.kernel.root().find("/usr/scene/arm/upper/body"));
}

TEST_CASE("a body with several joints gets light bodies between them") {
  MjcfHost h;
  h.import(
      "<mujoco model='m'><worldbody><body name='b' pos='0 0 1'><joint name='x' axis='1 0 0'/><joint name='y' axis='0 1 "
      "0'/>"
      "<joint name='s' type='slide' axis='0 0 1'/><geom size='0.1' mass='3'/></body></worldbody></mujoco>");
  CHECK(h.at<IJoint>("m/b-1/x").body(1) == nullptr);
  CHECK(h.at<IJoint>("m/b-2/y").body(1) == &h.at<IRigidBody>("m/b-1/body"));
  CHECK(h.at<IJoint>("m/b/s").jointType() == engine::JointType::slider);
  CHECK(h.at<IRigidBody>("m/b/body").mass() + 2 * h.at<IRigidBody>("m/b-1/body").mass() == Approx(3));
  CHECK_THAT(h.text, Catch::Contains("m.xml:1:57: a body with 3 joints gets light bodies"));
  h.step(10);
}

TEST_CASE("similar names of bodies are kept apart") {
  MjcfHost h;
  h.import(
      "<mujoco model='m'><worldbody><body name='a-1' pos='5 0 0'><freejoint/><geom size='.1'/></body>"
      "<body name='a' pos='0 0 1'><joint name='x' axis='1 0 0'/><joint name='y' axis='0 1 0'/><geom size='.1'/></body>"
      "<body name='b/' pos='0 3 1'><joint name='p'/><geom size='.1'/><body name='b_' pos='0 1 0'><joint "
      "name='q'/><geom size='.1'/></body></body>"
      "</worldbody></mujoco>");
  CHECK(h.at<IJoint>("m/a/y").body(1)->state().position.isApprox(Vec3(0, 0, 1)));
  CHECK(h.at<IJoint>("m/b_~2/q").body(1) == &h.at<IRigidBody>("m/b_/body"));
}

TEST_CASE("a body may get all of its mass from a fixed child body") {
  MjcfHost h;
  h.import(
      "<mujoco model='m'><worldbody><body name='b'><joint/><body pos='1 0 0'><geom type='box' size='.1 .2 "
      ".3'/></body></body></worldbody></mujoco>");
  CHECK(h.at<IRigidBody>("m/b/body").mass() == Approx(48));
  CHECK(h.position("m/b/body").isApprox(Vec3(1, 0, 0)));
}

TEST_CASE("if an option cannot be set, no parameter of the world is changed") {
  MjcfHost h;
  CHECK_THAT(h.failure("<mujoco model='m'><option timestep='0.001' gravity='1e300 0 0'/></mujoco>"),
             Catch::Contains("m.xml:1:19: cannot set an option"));
  Leaf& world = *h.kernel.root().find("/usr/scene/world");
  CHECK(getProperty(world, "timestep").toNumber() == 0);
  CHECK(getProperty(world, "gravity").toList()[2].toNumber() == -9.81);
}

TEST_CASE("with strict, a model that the tree cannot represent exactly is refused") {
  MjcfHost h;
  setProperty(*h.kernel.root().find("/sys/server/scene/mjcf"), "strict", true);
  CHECK_THAT(
      h.failure("<mujoco model='m'><worldbody><body><joint/><joint/><geom size='1'/></body></worldbody></mujoco>"),
      Catch::Contains("2 joints gets light bodies"));
  CHECK_FALSE(h.scene.child("m"));
}

TEST_CASE("the options of a model set the world's parameters, unless it is imported with a prefix") {
  MjcfHost h;
  const char* const text =
      "<mujoco model='m'><option timestep='0.004' gravity='0 0 -1' density='1.2' cone='elliptic'/></mujoco>";
  h.import(text, {"p"});
  Leaf& world = *h.kernel.root().find("/usr/scene/world");
  CHECK(getProperty(world, "timestep").toNumber() == 0);
  h.import(text);
  CHECK(getProperty(world, "timestep").toNumber() == 0.004);
  CHECK(getProperty(world, "mujocoDensity").toNumber() == 1.2);
  CHECK(getProperty(world, "mujocoCone").toString() == "elliptic");
  CHECK(getProperty(world, "gravity").toList()[2].toNumber() == -1);
}

TEST_CASE("geoms collide as contype and conaffinity say, and explicit pairs always collide") {
  MjcfHost h;
  h.import(R"(<mujoco model='m'><worldbody><geom name='floor' type='plane' size='1 1 1' contype='2' conaffinity='2'/>
    <body name='through' pos='0 0 0.2'><freejoint/><geom size='0.1' contype='4' conaffinity='4'/></body>
    <body name='lies' pos='1 0 0.2'><freejoint/><geom size='0.1' contype='2' conaffinity='0'/></body>
    <body name='paired' pos='2 0 0.2'><freejoint/>
      <geom name='foot' size='0.1' contype='0' conaffinity='0'/></body></worldbody>
    <contact><pair geom1='foot' geom2='floor'/></contact></mujoco>)");
  h.step(50);
  CHECK(h.position("m/through/body").z() < -1);
  CHECK(h.position("m/lies/body").z() == Approx(0.1).margin(0.01));
  CHECK(h.position("m/paired/body").z() == Approx(0.1).margin(0.01));
}

TEST_CASE("a mesh file becomes a mesh collider") {
  MjcfHost h;
  h.folder.write("meshes/tent.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  h.import(
      "<mujoco model='m'><compiler meshdir='meshes'/><asset><mesh name='t' file='tent.obj'/></asset><worldbody>"
      "<body name='b'><freejoint/><geom name='g' type='mesh' mesh='t' density='6'/></body></worldbody></mujoco>");
  CHECK(h.at<IRigidBody>("m/b/body").mass() == Approx(1));
  CHECK(h.position("m/b/body").isApprox(Vec3(0.25, 0.25, 0.25)));
  CHECK(h.at<ICollider>("m/b/g").shape()->triangles.size() == 12);
}

TEST_CASE("a model that cannot be imported leaves nothing in the tree") {
  MjcfHost h;
  const auto in = [](const std::string& s) { return "<mujoco model='m'><worldbody>" + s + "</worldbody></mujoco>"; };
  const std::pair<std::string, const char*> cases[] = {
      {in("<body><freejoint/></body>"), "m.xml:1:30: a body that moves needs a mass above 0"},
      {in("<body name='a'><freejoint/><inertial mass='1' diaginertia='1 1 -1'/></body>"),
       "m.xml:1:30: cannot make the body 'a'"},
      {in("<body><joint name='j'/><geom size='1'/><body><joint name='j'/><geom size='1'/></body></body>"),
       "there are two joints 'j'"},
      {in("<body><geom size='1'/><body><freejoint/><geom size='1'/></body></body>"),
       "m.xml:1:52: expected a free joint as the only one"},
      {"<mujoco model='m'><contact><exclude body1='x' body2='y'/></contact></mujoco>",
       "m.xml:1:28: there is no body 'x'"},
      {"<mujoco model='m'><actuator><motor joint='q'/></actuator></mujoco>",
       "m.xml:1:29: there is no joint 'q' to act on"},
  };
  for (const auto& [text, message] : cases) {
    CHECK_THAT(h.failure(text), Catch::Contains(message));
    CHECK_FALSE(h.scene.child("m"));
  }
  h.step(1);
}

TEST_CASE("sensors and actuators become perceptors and effectors") {
  MjcfHost h;
  for (const char* plugin : {"gamecontrol", "sensors", "effectors"}) h.kernel.plugins().use(plugin);
  h.import(R"(<mujoco model='m'><worldbody><body name='b' pos='0 0 1'>
    <joint name='j' axis='0 1 0' actuatorfrcrange='-3 3'/><geom size='0.1' pos='0.2 0 0' mass='1'/>
    <body name='c'><joint name='k' axis='0 0 1'/><geom size='0.1' mass='1'/><site name='s'/></body></body></worldbody>
    <actuator><motor name='j1_tau' joint='j'/><position name='j1_pos' joint='j' kp='7'/>
    <velocity name='j1_vel' joint='j' kv='2'/>
    <motor name='turn' joint='k' gear='2' ctrlrange='-1 1'/></actuator>
    <sensor><jointpos name='q_j1' joint='j'/><jointvel name='dq_j1' joint='j'/><gyro name='g' site='s'/>
    <framepos name='p' objtype='site' objname='s'/>
    <framequat name='o' objtype='body' objname='b'/></sensor></mujoco>)");
  CHECK(h.kernel.root().find("/usr/scene/m/b/j/j1")->classObject()->name() == "ControlEffector");
  CHECK(h.kernel.root().find("/usr/scene/m/c/k/turn")->classObject()->name() == "ActuatorEffector");
  CHECK(getProperty(*h.kernel.root().find("/usr/scene/m/b/j/j1"), "maxForce").toNumber() == 3);
  for (const char* path : {"m/b/j/q_j1", "m/c/g", "m/c/s/p", "m/b/b-link/o"})
    CHECK(h.kernel.root().find("/usr/scene/" + std::string(path)));
  CHECK_FALSE(h.kernel.root().find("/usr/scene/m/b/j/dq_j1"));
  std::vector<Perceptor*> perceptors;
  h.scene.collect(perceptors);
  CHECK(perceptors.size() == 4);
}

}  // namespace spark::test
