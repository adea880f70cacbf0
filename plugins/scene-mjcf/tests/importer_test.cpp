// Imports models into the tree.

#include "absence.h"
#include "mjcf_host.h"

namespace spark::test {
namespace {

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
  CHECK(h.at<IRigidBody>("m/b-1/body").mass() == Approx(3e-6));
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
  CHECK_THAT(h.failure("<mujoco model='m'><worldbody><body><joint type='ball' armour='1'/><geom "
                       "size='1'/></body></worldbody></mujoco>"),
             Catch::Contains("armour"));
  // MuJoCo 2.2.2 keeps a part of a damping that is switched off, of each kind of joint.
  for (const char* kind : {"free", "ball", "hinge"}) {
    CAPTURE(kind);
    CHECK_THAT(h.failure(fmt::format("<mujoco model='m'><option><flag passive='disable'/></option><worldbody><body>"
                                     "<joint type='{}' damping='1'/><geom size='1'/></body></worldbody></mujoco>",
                                     kind)),
               Catch::Contains("passive"));
  }
  CHECK_FALSE(h.scene.child("m"));
  h.import("<mujoco model='m'><worldbody><body><joint/><geom size='1'/></body></worldbody></mujoco>");
  CHECK(h.scene.child("m"));
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
  CHECK(getProperty(world.asNode()->require<Leaf>("mujoco"), "density").toNumber() == 1.2);
  CHECK(getProperty(world.asNode()->require<Leaf>("mujoco"), "cone").toString() == "elliptic");
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

/// Mass of a tetrahedron with three edges of 1 m along the axes and a density of 6, as libmujoco 2.2.2 prints it: the
/// volume is that of the box with the mesh's inertia.
constexpr double kTetrahedron = 1.3942740046;

TEST_CASE("a mesh file becomes a mesh collider") {
  MjcfHost h;
  h.folder.write("meshes/tent.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  h.import(
      "<mujoco model='m'><compiler meshdir='meshes'/><asset><mesh name='t' file='tent.obj'/></asset><worldbody>"
      "<body name='b'><freejoint/><geom name='g' type='mesh' mesh='t' density='6'/></body></worldbody></mujoco>");
  CHECK(h.at<IRigidBody>("m/b/body").mass() == Approx(kTetrahedron));
  CHECK(h.position("m/b/body").isApprox(Vec3(0.25, 0.25, 0.25)));
  CHECK(h.at<ICollider>("m/b/g").shape()->mesh->triangles.size() == 12);
}

TEST_CASE("a body with moments of inertia that no engine computes with gets those of a sphere of water") {
  MjcfHost h;
  h.import(
      "<mujoco model='m'><worldbody><body name='a'><freejoint/><inertial pos='0 0 0' mass='1' diaginertia='1 1 0'/>"
      "</body></worldbody></mujoco>");
  CHECK_THAT(h.text, Catch::Contains("m.xml:1:30: <body> 'a' has moments of inertia that no body can have"));
  CHECK(h.at<IRigidBody>("m/a/body").mass() == 1);
}

TEST_CASE("a model that cannot be imported leaves nothing in the tree") {
  MjcfHost h;
  const auto in = [](const std::string& s) { return "<mujoco model='m'><worldbody>" + s + "</worldbody></mujoco>"; };
  const std::pair<std::string, const char*> cases[] = {
      {in("<body><joint name='j'/><geom size='1'/><body><joint name='j'/><geom size='1'/></body></body>"),
       "there are two joints 'j'"},
      {in("<body><geom size='1'/><body><freejoint/><geom size='1'/></body></body>"),
       "m.xml:1:52: expected a free joint as the only one"},
  };
  for (const auto& [text, message] : cases) {
    CHECK_THAT(h.failure(text), Catch::Contains(message));
    CHECK_FALSE(h.scene.child("m"));
  }
  h.import(in("<body><freejoint/><geom size='1'/></body>"));
  CHECK(h.scene.child("m"));
  h.step(1);
}

TEST_CASE("what names something that is not there is left out and named, and is an error with strict") {
  const std::pair<const char*, const char*> cases[] = {
      {"<contact><exclude body1='x' body2='b'/></contact>", "<exclude> is left out: there is no body 'x'"},
      {"<contact><pair geom1='g' geom2='x'/></contact>", "<pair> is left out: there is no geom 'x'"},
      {"<actuator><motor joint='q'/></actuator>", "<motor> is left out: there is no joint 'q' to act on"},
      {"<actuator><motor name='t' tendon='q'/></actuator>", "<motor> 't' is left out: there is no tendon 'q'"},
      {"<sensor><jointpos joint='q'/></sensor>", "<jointpos> is left out: there is no joint 'q'"},
      {"<sensor><gyro name='i' site='q'/></sensor>", "<gyro> 'i' is left out: there is no site 'q'"},
      {"<sensor><framepos objtype='body' objname='q'/></sensor>", "<framepos> is left out: there is no body 'q'"},
  };
  for (const auto& [section, message] : cases) {
    CAPTURE(section);
    const std::string text =
        "<mujoco model='m'><worldbody><body name='b'><freejoint/><geom name='g' size='.1'/></body></worldbody>\n" +
        std::string(section) + "</mujoco>";
    RobotHost h;
    h.kernel.plugins().use("physics-mujoco");
    h.import(text);
    CHECK_THAT(h.text, Catch::Contains("m.xml:2:") && Catch::Contains(message));
    CHECK(h.find("m/b/body"));
    h.step(2);
    h.scene.remove(*h.scene.child("m"));
    setProperty(*h.kernel.root().find("/sys/server/scene/mjcf"), "strict", true);
    CHECK_THAT(h.failure(text), Catch::Contains(message));
    CHECK_FALSE(h.scene.child("m"));
  }
}

TEST_CASE("sensors and actuators become perceptors and effectors") {
  RobotHost h;
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
  for (const char* path : {"m/b/j/q_j1", "m/c/s/g", "m/c/s/p", "m/b/b-link/o"})
    CHECK(h.kernel.root().find("/usr/scene/" + std::string(path)));
  CHECK_FALSE(h.kernel.root().find("/usr/scene/m/b/j/dq_j1"));
  std::vector<Perceptor*> perceptors;
  h.scene.collect(perceptors);
  CHECK(perceptors.size() == 4);
}

TEST_CASE("a spring counts from its own position") {
  MjcfHost h;
  h.import(R"(<mujoco model='m'><compiler angle='radian'/><option gravity='0 0 0'/><worldbody>
    <body name='b'><joint name='j' axis='0 0 1' stiffness='4' springref='0.3' ref='0.1' damping='1'/>
    <geom size='.1' pos='.5 0 0' mass='1'/></body><body name='c'><joint name='k' type='slide' stiffness='40' damping='9'
    springref='0.3' axis='1 0 0'/><geom size='.1' mass='1'/></body></worldbody></mujoco>)");
  h.step(1000);
  CHECK(h.at<IJoint>("m/b/j").angle(0) == Approx(0.2).margin(1e-2));
  CHECK(h.at<IJoint>("m/c/k").angle(0) == Approx(0.3).margin(1e-2));
}

TEST_CASE("flags switch limits, springs, contacts and actuators off") {
  const auto model = [](const std::string& flag) {
    return "<mujoco model='m'><option gravity='0 0 0'><flag " + flag + R"(/></option><worldbody>
      <body name='b'><joint name='j' axis='0 0 1' range='-10 10' damping='2' frictionloss='3' stiffness='4'
      springref='5'/><geom name='g' size='.1'/></body></worldbody>
      <actuator><motor name='t' joint='j' ctrlrange='-1 1'/></actuator></mujoco>)";
  };
  using P = engine::JointParameter;
  {
    RobotHost h;
    h.import(model("limit='disable' clampctrl='disable'"));
    CHECK(std::isinf(h.at<IJoint>("m/b/j").parameter(P::highStop, 0)));
    CHECK(h.at<IJoint>("m/b/j").parameter(P::damping, 0) == 2);
    CHECK(std::isinf(getProperty(*h.find("m/b/j/t"), "most").toNumber()));
    CHECK(h.find("m/b/g"));
  }
  {
    RobotHost h;
    h.import(model("passive='disable' contact='disable'"));
    CHECK(h.at<IJoint>("m/b/j").parameter(P::damping, 0) == 0);
    CHECK(h.at<IJoint>("m/b/j").parameter(P::dryFriction, 0) == 3);
    CHECK_FALSE(h.find("m/b/g"));
    h.step(20);
    CHECK(h.at<IJoint>("m/b/j").angle(0) == Approx(0).margin(1e-9));
  }
  {
    RobotHost h;
    h.import(model("constraint='disable' actuation='disable'"));
    CHECK(h.at<IJoint>("m/b/j").parameter(P::dryFriction, 0) == 0);
    CHECK_FALSE(h.find("m/b/j/t"));
  }
  {
    RobotHost h;  // an attached model has the flags of its world
    h.import(model("limit='disable'"), {"p-"});
    CHECK_FALSE(std::isinf(h.at<IJoint>("p-m/p-b/p-j").parameter(P::highStop, 0)));
  }
}

TEST_CASE("gravity can be compensated for whole bodies") {
  MjcfHost h;
  h.import(R"(<mujoco model='m'><worldbody><body name='a' gravcomp='1'><freejoint/><geom size='.1'/>
    <body gravcomp='1'><geom size='.1'/></body></body>
    <body name='b' pos='3 0 0' gravcomp='0.5'><freejoint/><geom size='.1'/></body></worldbody></mujoco>)");
  CHECK_FALSE(getProperty(*h.kernel.root().find("/usr/scene/m/a/body"), "gravityOn").toBool());
  CHECK(getProperty(*h.kernel.root().find("/usr/scene/m/b/body"), "gravityOn").toBool());
  CHECK_THAT(h.text, Catch::Contains("m.xml:3:5: <body> 'b' has a gravcomp other than 1"));
}

TEST_CASE("mesh files may be MSH files, and OBJ files without faces") {
  MjcfHost h;
  setProperty(*h.kernel.root().find("/sys/server/scene/mjcf"), "strict", true);
  const auto model = [](const std::string& file) {
    return "<mujoco model='m'><asset><mesh name='t' file='" + file +
           "'/></asset><worldbody><body name='b'><freejoint/><geom name='g' type='mesh' mesh='t' density='6'/></body>"
           "</worldbody></mujoco>";
  };
  const auto check = [&] {
    CHECK(h.at<IRigidBody>("m/b/body").mass() == Approx(kTetrahedron));
    CHECK(h.at<ICollider>("m/b/g").shape()->mesh->triangles.size() == 12);
    h.scene.remove(*h.scene.child("m"));
  };
  h.folder.write("points.obj", "# a tetrahedron\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n");
  h.import(model("points.obj"));
  check();
  std::string msh;
  const auto put = [&](auto v) { msh.append(reinterpret_cast<const char*>(&v), sizeof v); };
  for (const std::int32_t count : {4, 0, 0, 4}) put(count);
  for (const float v : {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}) put(v);
  for (const std::int32_t v : {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}) put(v);
  h.folder.write("t.MSH", msh);
  h.import(model("t.MSH"));
  check();
  h.folder.write("short.msh", msh.substr(0, msh.size() - 1));
  CHECK_THAT(h.failure(model("short.msh")), Catch::Contains("expected 112 bytes, found 111"));
  h.folder.write("beyond.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n");
  CHECK_THAT(h.failure(model("beyond.obj")), Catch::Contains("expected a face of its 3 vertices, found number 4"));
  h.folder.write("empty.obj", "# nothing\n");
  CHECK_THAT(h.failure(model("empty.obj")), Catch::Contains("expected vertices, found none"));
}

TEST_CASE("a timestep that does not divide the cycle is reported") {
  MjcfHost h;
  h.kernel.plugins().use("simulation");
  setProperty(h.kernel.create("Simulation", "/sys/server/simulation"), "step", 0.02);
  for (const char* const fits : {"0.02", "0.01", "0.005", "0.002"})
    h.import(std::string("<mujoco model='m'><option timestep='") + fits + "'/></mujoco>");
  const std::string before = h.text;
  h.import("<mujoco model='m'><option timestep='0.003'/></mujoco>");
  CHECK_THAT(h.text,
             Catch::Contains("m.xml:1:19: the timestep of 0.003 s does not divide the cycle of 0.02 s: 7 steps of "
                             "0.00285714 s each are used in its place"));
  CHECK(lacks(before, "timestep", h.text));
  h.import("<mujoco model='m'><option timestep='0.05'/></mujoco>");
  CHECK_THAT(h.text, Catch::Contains("the timestep of 0.05 s does not divide the cycle of 0.02 s"));
}

}  // namespace spark::test
