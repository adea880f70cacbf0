// Equalities and tendons in the tree. That they move as in MuJoCo is tested in tests/models.

#include "absence.h"
#include "mjcf_host.h"

namespace spark::test {
namespace {

const char* const kBodies = R"(<mujoco model='m'><worldbody>
  <body name='a' pos='0 0 1'><joint name='ja' axis='0 1 0'/><geom size='.1' mass='1'/><site name='sa' pos='.1 0 0'/></body>
  <body name='b' pos='1 0 1'><joint name='jb' axis='0 1 0'/><geom size='.1' mass='1'/>
    <body name='c' pos='.2 0 0'><geom size='.1' mass='1'/><site name='sc' pos='0 .1 0'/></body></body>
  <body name='f' pos='2 0 1'><freejoint name='free'/><geom size='.1' mass='1'/></body>
  <body name='ball' pos='3 0 1'><joint name='round' type='ball'/><geom size='.1' mass='1'/></body>
  <site name='sw' pos='0 0 2'/></worldbody>
)";
std::string with(const std::string& section) { return kBodies + section + "</mujoco>"; }

/// A scene that MuJoCo steps.
struct MujocoHost : MjcfHost {
  MujocoHost() {
    kernel.plugins().use("physics-mujoco");
    Node& server = kernel.root().require<Node>("/sys/server/physics");
    server.remove(*server.child("engine"));
    server.create("MujocoEngine", "engine");
  }
};

const char* const kAll = R"(<equality>
  <connect name='pin' body1='a' body2='f' anchor='0 0 .3'/><weld body1='c' body2='world'/>
  <joint name='gear' joint1='ja' joint2='jb'/></equality>
  <tendon><fixed name='sum'><joint joint='ja' coef='2'/></fixed>
  <spatial name='rope' stiffness='3'><site site='sw'/><site site='sa'/><site site='sc'/></spatial></tendon>)";

}  // namespace

TEST_CASE("equalities and tendons are nodes of the model, in the frames of links") {
  MujocoHost h;
  h.import(with(kAll), {"r-"});
  Leaf& pin = h.at<Leaf>("r-m/r-pin");
  CHECK(getProperty(pin, "first").plain() == "../r-a/body");
  CHECK(getProperty(pin, "anchor1").toList()[2].toNumber() == Approx(.3));
  CHECK(getProperty(pin, "anchor2").toList()[0].toNumber() == Approx(-2));
  CHECK(getProperty(h.at<Leaf>("r-m/r-gear"), "second").plain() == "../r-b/r-jb");
  // Without a length of its own, the spring rests where the file has the bodies.
  CHECK(getProperty(h.at<Leaf>("r-m/r-rope"), "springLength").toNumber() ==
        Approx(std::hypot(.1, 1) + Vec3(1.1, .1, 0).norm()));
  Node& stone = h.thing("stone", {9, 9, 5});
  h.step(5);
  CHECK(h.body(stone).state().position.z() < 5);  // MuJoCo takes the world
  const std::string before = h.text;
  h.at<Node>("r-m").remove(h.at<Leaf>("r-m/r-f"));
  h.step(5);
  CHECK(lacks(before, "no effect", h.text));
}

TEST_CASE("a model with equalities and tendons may be there twice, and be removed") {
  MujocoHost h;
  Node& first = h.transform(h.scene, "first", {0, 0, 0});
  h.folder.write("m.xml", with(kAll));
  h.call(first, "importScene", {"m.xml", "r-"});
  Node& second = h.transform(h.scene, "second", {0, 5, 0});
  h.call(second, "importScene", {"m.xml", "s-"});
  h.step(5);
  first.remove(*first.child("r-m"));
  h.step(5);
  // A body that a constraint names goes alone.
  Node& model = *second.child("s-m")->asNode();
  model.remove(*model.child("s-f"));
  Node& stone = h.thing("stone", {9, 9, 5});
  h.step(5);
  CHECK_THAT(h.text, Catch::Contains("/usr/scene/second/s-m/s-pin: no effect in MuJoCo"));
  CHECK(count(h.text, "no effect") == 1);
  CHECK(h.body(stone).state().position.z() < 5);  // MuJoCo takes the world
  CHECK(h.at<IRigidBody>("second/s-m/s-a/body").state().position.allFinite());
}

TEST_CASE("other engines say that equalities and tendons have no effect") {
  for (const auto& [plugin, engine] : {std::pair{"physics-ode", "OdeEngine"},
                                       {"physics-articulated", "ArticulatedEngine"},
                                       {"physics-bullet", "BulletEngine"}}) {
    MjcfHost h;
    h.kernel.plugins().use(plugin);
    Node& server = h.kernel.root().require<Node>("/sys/server/physics");
    server.remove(*server.child("engine"));
    server.create(engine, "engine");
    h.import(with(kAll));
    h.step();
    CHECK_THAT(h.text, Catch::Contains(
                           fmt::format("/usr/scene/m/pin: <connect> 'pin' (m.xml:9:3) has no effect with {}", engine)));
    CHECK_THAT(h.text, Catch::Contains(
                           fmt::format("/usr/scene/m/sum: <fixed> 'sum' (m.xml:11:11) has no effect with {}", engine)));
  }
}

TEST_CASE("equalities and tendons of what is not there are left out, and are errors with strict") {
  const std::pair<const char*, const char*> cases[] = {
      {"<equality><weld body1='a' body2='nobody'/></equality>",
       "m.xml:8:11: <weld> is left out: there is no body 'nobody'"},
      {"<equality><joint joint1='free'/></equality>",
       "m.xml:8:11: <joint> is left out: there is no joint 'free' with a coordinate"},
      {"<equality><joint joint1='round'/></equality>",
       "m.xml:8:11: <joint> is left out: expected a joint with one coordinate, found the ball"},
      {"<tendon><fixed><joint joint='none' coef='1'/></fixed></tendon>",
       "m.xml:8:9: <fixed> is left out: m.xml:8:16: there is no joint 'none'"},
      {"<equality><weld body1='a' body2='a'/></equality>",
       "m.xml:8:11: <weld> is left out: expected two different elements"},
      {"<equality><joint joint1='ja' joint2='ja'/></equality>",
       "m.xml:8:11: <joint> is left out: expected two different elements"},
      {"<tendon><fixed><joint joint='ja'/></fixed></tendon>",
       "m.xml:8:9: <fixed> is left out: m.xml:8:16: expected an attribute 'coef'"},
      {"<tendon><spatial><site site='sa'/><site site='sa'/></spatial></tendon>",
       "m.xml:8:9: <spatial> is left out: m.xml:8:35: expected another site than the one before"},
      {"<tendon><spatial><site site='sa'/><site site='no'/></spatial></tendon>",
       "m.xml:8:9: <spatial> is left out: m.xml:8:35: there is no site 'no'"},
  };
  // What is imported and loses a body later: the log of the engine says that it has no effect.
  MujocoHost bereft;
  bereft.import(with(kAll));
  bereft.at<Node>("m").remove(bereft.at<Leaf>("m/f"));
  bereft.step();
  const auto hasTendon = [](MujocoHost& h) {
    const auto& children = h.at<Node>("m").children();
    return std::any_of(children.begin(), children.end(),
                       [](const auto& c) { return c->classObject()->name() == std::string("MujocoTendon"); });
  };
  CHECK(hasTendon(bereft));
  for (const auto& [section, message] : cases) {
    MujocoHost h;
    h.import(with(section));
    CHECK_THAT(h.text, Catch::Contains(message));
    CHECK_FALSE(hasTendon(h));
    h.step();
    CHECK(lacks(h.text, "no effect", bereft.text));
    setProperty(*h.kernel.root().find("/sys/server/scene/mjcf"), "strict", true);
    h.scene.remove(*h.scene.child("m"));
    CHECK_THAT(h.failure(with(section)), Catch::Contains(message));
    CHECK_FALSE(h.kernel.root().find("/usr/scene/m"));
  }
}

TEST_CASE("numbers of equalities and tendons are finite") {
  MujocoHost h;
  Leaf& tendon = h.scene.create("MujocoTendon", "t");
  Leaf& equality = h.scene.create("MujocoEquality", "e");
  const double nan = std::nan("");
  CHECK_THROWS_WITH(h.call(tendon, "addJoint", {"nowhere", nan}), Catch::Contains("finite"));
  CHECK_THROWS_WITH(setProperty(tendon, "range", List{0.0, nan}), Catch::Contains("finite"));
  for (const char* name : {"anchor1", "anchor2"})
    CHECK_THROWS_WITH(setProperty(equality, name, List{0.0, nan, 0.0}), Catch::Contains("finite"));
  CHECK_THROWS_WITH(setProperty(equality, "torqueScale", nan), Catch::Contains("finite"));
}

TEST_CASE("the spring of a spatial tendon is judged by the joints that move it") {
  const auto model = [](const char* tendon) {
    return std::string(R"(<mujoco model='m'><worldbody>
      <body name='a' pos='0 0 1'><joint name='ja' axis='0 1 0'/><geom size='.1' mass='1'/><site name='sa' pos='.1 0 0'/>
        <site name='sa2'/></body>
      <body name='b' pos='1 0 1'><joint name='jb' axis='0 1 0' springref='10'/><geom size='.1' mass='1'/>
        <site name='sb'/><site name='sb2' pos='0 .1 0'/></body><site name='sw' pos='0 0 2'/></worldbody>
      <tendon><spatial name='rope' stiffness='3'>)") +
           tendon + "</spatial></tendon></mujoco>";
  };
  // Below 0: MuJoCo finds where it rests.
  const auto isOpen = [&](const char* tendon) {
    MujocoHost h;
    h.import(model(tendon));
    return getProperty(*h.kernel.root().find("/usr/scene/m/rope"), "springLength").toNumber() < 0;
  };
  CHECK(isOpen("<site site='sw'/><site site='sb'/>"));
  CHECK(isOpen("<site site='sa'/><site site='sb'/>"));
  CHECK_FALSE(isOpen("<site site='sw'/><site site='sa'/>"));
  CHECK_FALSE(isOpen("<site site='sb'/><site site='sb2'/>"));
}

TEST_CASE("a tendon takes joints or points, and only so many") {
  MujocoHost h;
  Leaf& tendon = h.scene.create("MujocoTendon", "t");
  h.call(tendon, "addJoint", {"nowhere", 1.0});
  CHECK_THROWS_WITH(h.call(tendon, "addPoint", {"", 0.0, 0.0, 0.0}), Catch::Contains("joints or points, not both"));
  for (int i = 1; i < 64; ++i) h.call(tendon, "addJoint", {"nowhere", 1.0});
  CHECK_THROWS_WITH(h.call(tendon, "addJoint", {"nowhere", 1.0}), Catch::Contains("at most 64"));
  Leaf& equality = h.scene.create("MujocoEquality", "e");
  CHECK_THROWS_WITH(setProperty(equality, "type", "glue"),
                    Catch::Contains("expected connect or weld or joint or tendon"));
  h.step(2);
  CHECK_THAT(h.text, Catch::Contains("/usr/scene/t: no effect in MuJoCo"));
  CHECK_THAT(h.text, Catch::Contains("/usr/scene/e: no effect in MuJoCo"));
}

}  // namespace spark::test
