// Files of each language become files of Spark's own, which load to the same tree and move in the same way.

#include <catch2/catch.hpp>
#include <fstream>
#include <sstream>

#include "import_house.h"

using namespace spark;
using namespace spark::test;

namespace {

const std::string kScenes = SPARK_SOURCES "/scenes/";

std::string textOf(const std::string& file) {
  std::ifstream in(file);
  REQUIRE(in);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

bool agree(const Value& a, const Value& b) {
  if (a.isList() && b.isList())
    return std::equal(a.toList().begin(), a.toList().end(), b.toList().begin(), b.toList().end(), agree);
  if (a.isNumber() && b.isNumber()) return a.toNumber() == Approx(b.toNumber()).margin(1e-6) || a == b;
  return a == b;
}

/// All nodes below have the same names, classes and readable properties.
void checkSame(const Node& a, const Node& b) {
  INFO(a.path());
  REQUIRE(a.children().size() == b.children().size());
  for (std::size_t i = 0; i < a.children().size(); ++i) {
    const Leaf &first = *a.children()[i], &second = *b.children()[i];
    REQUIRE(first.path() == second.path());
    REQUIRE(first.classObject()->name() == second.classObject()->name());
    for (const Property* p : first.classObject()->properties()) {
      if (p->ofProcess || p->type == "random stream") continue;
      INFO(first.path() << '.' << p->name << ": " << p->get(first).text() << " and " << p->get(second).text());
      CHECK(agree(p->get(first), p->get(second)));
    }
    if (first.asNode()) checkSame(*first.asNode(), *second.asNode());
  }
}

struct ConvertHost : ImportHost {
  ConvertHost() {
    Leaf& share = kernel.create("DirectoryFileSystem", "/sys/server/file/share");
    setProperty(share, "path", kScenes);
    setProperty(share, "prefix", "rsg");
    kernel.create("SceneWriter", "/sys/host/writer");
  }
  std::string written() { return call(*kernel.root().find("/sys/host/writer"), "text", {"/usr/scene/place"}).plain(); }
  void importText(const std::string& name, const std::string& text) {
    folder.write(name, text);
    settle();  // the place is where it is: what is imported there is not moved again
    import(name);
    settle();  // origins move to the centres of mass
  }
  void settle() { call(*kernel.root().find("/sys/server/physics"), "settle"); }
  std::vector<engine::BodyState> bodies() {
    std::vector<IRigidBody*> all;
    scene.collect(all);
    std::vector<engine::BodyState> out;
    for (const IRigidBody* b : all) out.push_back(b->state());
    return out;
  }
};

/// Converts a file, and compares trees and 100 steps from that height. Returns the converted text.
std::string convertAndCompare(const std::string& name, const std::string& text, double height = 0.5) {
  ConvertHost original, converted;
  for (ConvertHost* h : {&original, &converted}) ConvertHost::call(h->place, "setLocalPos", {0, 0, height});
  original.importText(name, text);
  const std::string file = original.written();
  INFO(file);
  converted.importText("converted.rsg", file);
  checkSame(original.place, converted.place);
  for (ConvertHost* h : {&original, &converted}) h->step(100);
  const auto a = original.bodies(), b = converted.bodies();
  REQUIRE(a.size() == b.size());
  REQUIRE(a.size() > 1);  // the crate of the house is one
  for (std::size_t i = 0; i < a.size(); ++i) {
    INFO("body " << i);
    CHECK((a[i].position - b[i].position).norm() < 1e-6);
    CHECK((a[i].rotation - b[i].rotation).norm() < 1e-6);
  }
  return file;
}

}  // namespace

TEST_CASE("a robot of URDF is converted, with joints, stops and controllers") {
  const std::string file = convertAndCompare("arm.urdf", textOf(kScenes + "robots/arm.urdf"));
  CHECK_THAT(file, Catch::StartsWith("(RSG 0 2)\n(\n  (nd Space (setName arm)\n"));
  CHECK_THAT(file, Catch::Contains("(attach ../body ../../upper/body)"));
  CHECK_THAT(file, Catch::Contains("(setLowStopPos 0 -2.5)"));
  CHECK_THAT(file, Catch::Contains("(set boxLengths 0.08 0.08 0.4)"));
}

TEST_CASE("a robot of Webots is converted, with its wheels, sensors and colours") {
  const std::string file = convertAndCompare("rover.wbt", textOf(kScenes + "robots/rover.wbt"));
  CHECK_THAT(file, Catch::Contains("(nd DistancePerceptor (setName eye)"));
  CHECK_THAT(file, Catch::Contains("(resetMaterials rgbe6801a)"));
}

TEST_CASE("a humanoid in MJCF is converted") {
  // It falls, because where limp limbs meet the ground the last digit decides.
  convertAndCompare("t1.xml", textOf(kScenes + "robots/t1.xml"), 30);
}

TEST_CASE("a model in MJCF with hulls, parts, excluded pairs, equalities and tendons is converted") {
  convertAndCompare("m.xml", R"(<mujoco model="odd">
    <asset><mesh name="t" vertex="0 0 0 .1 0 0 0 .1 0 0 0 .1"/></asset>
    <worldbody>
      <body name="a" pos="0 0 2"><freejoint/><geom name="ga" size=".1"/>
        <body name="fixed" pos=".2 0 0"><geom size=".05"/></body>
        <body name="b" pos="0 0 .3"><joint name="j" type="slide" axis="1 2 3" range="-1 1" limited="true" armature=".1"/>
          <geom name="gb" type="mesh" mesh="t"/></body>
        <body name="c" pos="0 .3 0"><joint name="x" axis="1 0 0" springref="5" stiffness="2"/>
          <joint name="y" axis="0 1 0" damping=".1"/><geom type="capsule" size=".05 .1" euler="30 20 10"/></body>
        <body name="d" pos="0 -.4 0"><joint name="k" type="ball" damping=".2"/><geom size=".1"/></body>
      </body>
    </worldbody>
    <contact><exclude body1="a" body2="b"/><pair geom1="ga" geom2="gb"/></contact>
    <equality><joint joint1="x" joint2="y" polycoef="0 2 0 0 0"/></equality>
    <tendon><fixed stiffness="3"><joint joint="x" coef="1"/><joint joint="j" coef="-2"/></fixed></tendon>
  </mujoco>)");
}

TEST_CASE("scene files of the installed base are converted, with the calls that set masses and joints") {
  convertAndCompare("buggy.rsg", textOf(kScenes + "agent/buggy/buggy.rsg"));
  convertAndCompare("legged.rsg", textOf(kScenes + "agent/legged-sphere/legged-sphere.rsg"));
  convertAndCompare("odd.rsg", R"((RSG 0 1)(
    (nd Transform (setName "a (b) \"c\"; 'd'") (setLocalPos 0.1 0.2 1.3) (setLocalRotation 10 20 30)
      (nd RigidBody (setBoxTotal 1 0.1 0.2 0.3) (addSphereTotal 0.5 0.1 0.3 0 0 0 0 0))
      (nd BoxCollider (setBoxLengths 0.1 0.2 0.3) (setLocalPosition 0.1 0 0) (setRotation 0 0 0 0 0 45)
        (addNotCollideWithColliderName other true)
        (nd ContactJointHandler (setContactBounceMode false)))
      (nd StaticMesh (load models/thing.obj) (sSc 1 2 3) (setTransparent) (resetMaterials m1 m2)))
    (nd Transform (setName b) (nd RayCollider (setParams 0 0 0 0 0 -1 2)))
    (nd Transform (setName (join $ x)) (setLocalPos 0 0 3) (nd RigidBody (setSphereTotal 1 0.1))
      (nd UniversalJoint (attach ../RigidBody) (setAnchor 0 0 0.1) (setAxis1 1 0 0) (setAxis2 0 1 0)
        (setMaxMotorForce 1 3) (setStopERP 0 0.5)))))",
                    30);
}

TEST_CASE("what the language cannot express is an error with node and property") {
  ConvertHost h;
  h.importText("a.rsg",
               "(RSG 0 1)((nd Transform (setName t)(setLocalPos 0 0 2)(nd RigidBody)(nd HingeJoint (attach "
               "../RigidBody)(setAnchor 0 0 1)(setAxis 0))))");
  CHECK_NOTHROW(h.written());
  auto& body = h.place.require<IRigidBody>("t/RigidBody");
  const Pose hanging{body.state().position, body.state().rotation};
  Mat3 turn;  // by a quarter about the axis
  turn << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  body.setPose({hanging.position + Vec3(0, 1, 1), turn});
  CHECK_THROWS_WITH(h.written(),
                    Catch::Contains("t/HingeJoint (HingeJoint): cannot be written: its axis 0 is at 1.57"));
  body.setPose({hanging.position + Vec3(0, 0, 1), hanging.rotation});
  CHECK_THROWS_WITH(h.written(), Catch::Contains("cannot be written: its anchors are 1 m apart"));
  h.place.removeChildren();
  h.place.create("Node", "plain");
  CHECK_THROWS_WITH(h.written(), Catch::StartsWith("cannot call text") &&
                                     Catch::Contains("/usr/scene/place/plain cannot be written to a scene file: its "
                                                     "class Node is none of scene nodes"));
}

TEST_CASE("a file of version 0.2 uses the plugins of its classes and their bases") {
  PhysicsHost h;
  TemporaryFolder folder;
  for (const char* plugin : {"files", "scene-rsg"}) h.kernel.plugins().use(plugin);
  h.kernel.create("FileServer", "/sys/server/file");
  setProperty(h.kernel.create("DirectoryFileSystem", "/sys/server/file/folder"), "path", folder.path().string());
  h.kernel.create("RsgImporter", "/sys/server/scene/rsg");
  const std::string body =
      "((nd Transform (nd RigidBody)(nd HingeJoint (attach ../RigidBody)(setAxis 0)(nd ActuatorEffector))))";
  folder.write("old.rsg", "(RSG 0 1)" + body);
  folder.write("new.rsg", "(RSG 0 2)" + body);
  auto& server = h.kernel.root().require<ISceneServer>();
  CHECK_THROWS_WITH(server.importScene("old.rsg", h.scene, {}),
                    Catch::Contains("there is no class 'ActuatorEffector'"));
  CHECK_NOTHROW(server.importScene("new.rsg", h.scene, {}));
}
