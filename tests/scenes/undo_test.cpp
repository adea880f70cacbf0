// Imports that fail are undone: nested ones, those that change older nodes, and those of agents in a running match.

#include <catch2/catch.hpp>

#include "api/agents.h"
#include "import_house.h"
#include "spark/predicates.h"

using namespace spark;
using namespace spark::test;

TEST_CASE("the outermost file decides what a file that it imports leaves behind") {
  ImportHost h;
  h.folder.write("inner.rsg", "(RSG 0 1)((nd Transform (setName kept)(nd RigidBody))\n(nd Sphare))");
  h.folder.write("inner.xml", "<mujoco><worldbody><body><freejoint/></body></worldbody></mujoco>");
  h.folder.write("base.rsg",
                 "(RSG 0 1)((nd Transform (setName t)(importScene inner.rsg)(importScene inner.xml)(nd Sphere)))");
  const std::string why = "the import of 'inner.rsg' failed";
  CHECK_THAT(h.failure("base.rsg"), Catch::Contains(why));
  CHECK(h.place.find("t/kept/RigidBody"));
  CHECK(h.place.find("t/Sphere"));  // the rest goes on
  h.place.removeChildren();
  h.setTransactional("true");
  CHECK_THAT(h.failure("base.rsg"), Catch::Contains(why));
  CHECK(h.place.children().empty());
  setProperty(*h.kernel.root().find("/sys/server/scene/rsg"), "looseImports", true);  // as the installed base
  CHECK(h.failure("base.rsg").empty());
  CHECK_FALSE(h.place.find("t/kept"));
  CHECK(h.place.find("t/Sphere"));
  h.place.removeChildren();
  h.setTransactional("byLanguage");
  h.folder.write("ours.rsg", "(RSG 0 2)((nd Transform (setName t))\n(importScene inner.rsg))");
  CHECK_THAT(h.failure("ours.rsg"), Catch::StartsWith("ours.rsg:2:2: ") && Catch::Contains("inner.rsg:2:2: "));
  CHECK(h.place.children().empty());
}

TEST_CASE("older nodes that a failing file named, moved or changed get back what they had") {
  ImportHost h;
  h.setTransactional("true");
  h.place.create("SphereCollider", "ball");
  h.place.create("Transform", "post");
  h.step(1);
  const std::uint64_t hash = h.hash();
  const auto radius = [&] { return getProperty(*h.place.child("ball"), "radius").toNumber(); };
  const double before = radius();
  const std::string failing = "\n(nd Sphare)";
  for (const std::string body : {"(setLocalPos 1 2 3)(setName other)", "(setLocalRotation 10 20 30)(setLocalPos 0 0 9)",
                                 "(sel ball (setName x)(setRadius 7))", "(sel post (setLocalPos 1 1 1)(nd Sphere))"}) {
    INFO(body);
    h.folder.write("f.rsg", "(RSG 0 1)(" + std::string(body) + failing + ")");
    CHECK_THAT(h.failure("f.rsg"), Catch::StartsWith("f.rsg:2:2: "));
    CHECK(h.hash() == hash);
    REQUIRE(h.place.child("ball"));
    CHECK(radius() == before);
    CHECK(h.place.name() == "place");
  }
  // What is removed cannot be brought back, so it is not removed.
  for (const std::string body : {"(sel post (unlinkLeaf))", "(unlinkChildren)"}) {
    h.folder.write("f.rsg", "(RSG 0 1)(" + std::string(body) + ")");
    CHECK_THAT(h.failure("f.rsg"), Catch::Contains("it was there before the import"));
    CHECK(h.place.child("post"));
  }
  h.folder.write("f.rsg", "(RSG 0 1)((nd Transform (setName mine)(nd Sphere)(unlinkChildren)(nd Box)))");
  CHECK(h.failure("f.rsg").empty());
  CHECK(h.place.find("mine")->asNode()->children().size() == 1);
}

TEST_CASE("a file that succeeds may change older nodes, and a second one that fails does not take that back") {
  ImportHost h;
  h.setTransactional("true");
  h.folder.write("good.rsg", "(RSG 0 1)((setLocalPos 1 2 3)(nd Sphere))");
  h.folder.write("bad.rsg", "(RSG 0 1)((setLocalPos 4 5 6)(importScene good.rsg)(nd Sphare))");
  CHECK(h.failure("good.rsg").empty());
  CHECK_FALSE(h.failure("bad.rsg").empty());
  CHECK(h.place.as<Transform>()->localPos() == Vec3f(1, 2, 3));
  CHECK(h.place.children().size() == 1);
}

TEST_CASE("the gravity of a model is not left in the world when the file that imports it fails") {
  ImportHost h;
  const auto gravity = [&] { return getProperty(*h.scene.child("world"), "gravity").toList()[2].toNumber(); };
  const double before = gravity();
  const std::string good =
      "#VRML_SIM R2023b utf8\nWorldInfo { gravity 1 }\nSolid { boundingObject Box { } physics Physics { } }\n";
  h.folder.write("w.wbt", good);
  h.folder.write("f.rsg", "(RSG 0 2)((importScene w.wbt)\n(nd Sphare))");
  CHECK_THAT(h.failure("f.rsg"), Catch::StartsWith("f.rsg:2:2: "));
  CHECK(gravity() == before);
  CHECK(h.place.children().empty());
  CHECK(h.failure("w.wbt").empty());
  CHECK(gravity() == -1);
}

TEST_CASE("the text of a file says its language, and its name only where the text says none") {
  ImportHost h;
  const auto says = [&](const std::string& name, const std::string& text) {
    h.folder.write(name, text);
    return h.failure(name);
  };
  CHECK(says("robot.urdf", "<mujoco model='m'><worldbody/></mujoco>").empty());
  CHECK(h.place.child("m"));
  CHECK(says("model.xml", "(RSG 0 2)((nd Sphere))").empty());
  CHECK(says("model.xml", "#VRML_SIM R2023b utf8\nRobot { }").empty());
  CHECK_THAT(says("robot.urdf", "<!-- no more"), Catch::StartsWith("robot.urdf:1:"));
  CHECK_THAT(says("world.wbt", "<html/>"), Catch::StartsWith("world.wbt:1:1: "));
  CHECK_THAT(says("thing.proto", "PROTO A"), Catch::StartsWith("thing.proto:1:8: "));
  CHECK_THAT(says("scene.rsg", "RSG 0 1"), Catch::StartsWith("scene.rsg:1:"));
  CHECK_THAT(says("model.mjcf", "<html/>"), Catch::StartsWith("model.mjcf:1:1: expected the element <mujoco>"));
  CHECK_THAT(says("model.txt", "<html/>"), Catch::Contains("neither its beginning nor its name"));
}

namespace {
/// A match in which an agent asks for a robot; its state after 20 more cycles.
std::uint64_t matchWith(const std::string& robot, const char* transactional, std::size_t& nodes) {
  ImportHost h;
  h.setTransactional(transactional);
  h.folder.write("late.rsg",
                 "(RSG 0 1)((nd Transform (setName torso)(setLocalPos 3 0 1)(nd RigidBody (setSphereTotal 1 0.1))(nd "
                 "SphereCollider (setRadius 0.1)))(nd Transform (setName arm)(nd RigidBody)(nd HingeJoint (attach "
                 "../RigidBody ../../torso/RigidBody)(nd HingeEffector)))\n(nd Sphare))");
  h.folder.write("late.xml",
                 "<mujoco><worldbody><body><freejoint/><geom size='.1'/><body><joint name='j'/><geom size='.1'/></body>"
                 "<body>\n<joint name='j'/><geom size='.1'/></body></body></worldbody></mujoco>");
  Node& agent = *h.kernel.create("AgentAspect", "/usr/scene/agent").asNode();
  auto& effector = agent.create<Effector>("SceneEffector", "scene");
  h.step(5);
  Predicates action;
  readSexp("(scene " + robot + ")", action);
  REQUIRE(effector.act(*action.begin()).empty());
  h.step(20);
  CHECK(h.text.find("gets no robot") != std::string::npos);
  nodes = countBelow(h.kernel.root().require<Node>("/usr"));
  return h.hash();
}
}  // namespace

TEST_CASE("an agent's robot that fails leaves a running match as one that is not there") {
  std::size_t nodes = 0, expected = 0;
  for (const char* transactional : {"byLanguage", "true"}) {
    const std::uint64_t hash = matchWith("none.rsg", transactional, expected);
    for (const char* robot : {"late.rsg", "late.xml"}) {
      INFO(robot << ", " << transactional);
      CHECK(matchWith(robot, transactional, nodes) == hash);
      CHECK(nodes == expected);
    }
  }
}
