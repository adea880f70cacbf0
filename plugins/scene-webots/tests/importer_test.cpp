#include <catch2/catch.hpp>

#include "../../physics/tests/physics_house.h"
#include "api/agents.h"
#include "api/scene.h"
#include "robots.h"
#include "temporary_folder.h"

using namespace spark;
using namespace spark::test;
using namespace spark::webots::test;
using Catch::Contains;

namespace {

struct WebotsHost : PhysicsHost {
  TemporaryFolder folder;
  WebotsHost() {
    for (const char* plugin : {"files", "scene-webots", "gamecontrol", "sensors", "effectors"})
      kernel.plugins().use(plugin);
    kernel.create("FileServer", "/sys/server/file");
    setProperty(kernel.create("DirectoryFileSystem", "/sys/server/file/folder"), "path", folder.path().string());
    kernel.create("WebotsImporter", "/sys/server/scene/webots");
  }
  void import(const std::string& text, const List& arguments = {}) {
    folder.write("r.wbt", text);
    List all{"r.wbt"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    call(scene, "importScene", all);
  }
  Leaf* find(const std::string& path) { return kernel.root().find("/usr/scene/" + path); }
  std::string classAt(const std::string& path) {
    Leaf* const node = find(path);
    return node ? node->classObject()->name() : "";
  }
};

}  // namespace

TEST_CASE("A world is in the tree with its robot, ground, lamp and gravity") {
  WebotsHost h;
  h.import(kCar);
  CHECK(h.find("car/car/body"));
  CHECK(h.classAt("car/left wheel/left motor") == "HingeJoint");
  CHECK(h.classAt("car/left wheel/left motor/left sensor") == "JointPerceptor");
  CHECK(h.classAt("LAMP/light") == "Light");
  CHECK(h.find("scenery"));
  std::vector<Perceptor*> perceptors;
  std::vector<Effector*> effectors;
  h.find("car")->asNode()->collect(perceptors);
  h.find("car")->asNode()->collect(effectors);
  CHECK(perceptors.size() == 4);
  REQUIRE(effectors.size() == 2);
  CHECK(effectors[0]->predicate() == "left_motor");
  CHECK(getProperty(*h.find("world"), "gravity").toList()[2].toNumber() == Approx(-9.8));
}

TEST_CASE("A foot that feels has a perceptor, fed by its own shape") {
  WebotsHost h;
  h.import(kHumanoid);
  CHECK(h.classAt("walker/LShin/LFoot") == "TouchPerceptor");
  int handlers = 0;
  for (const auto& child : h.find("walker/LShin")->asNode()->children())
    if (child->asNode() && child->asNode()->child("bumper")) ++handlers;
  CHECK(handlers == 1);
}

TEST_CASE("Robots stand side by side, each with a prefix, and leave the gravity of the world") {
  WebotsHost h;
  setProperty(*h.find("world"), "gravity", List{0.0, 0.0, -1.0});
  h.import(kCar, {"a-"});
  h.import(kCar, {"b-", "fixed"});
  CHECK(h.find("a-car/a-car/body"));
  CHECK_FALSE(h.find("b-car/b-car/body"));
  CHECK(h.find("b-car/b-left wheel/body"));
  CHECK(getProperty(*h.find("world"), "gravity").toList()[2].toNumber() == -1);
  CHECK_THROWS_WITH(h.import(kCar, {"c-", "loose"}),
                    Contains("expected a prefix for names, and 'fixed' or 'free', found 'loose'"));
}

TEST_CASE("PROTOs are looked for in the folders that a property names, and templates are run") {
  WebotsHost h;
  h.folder.write("shared/protos/Lamp.proto", R"(#VRML_SIM R2023b utf8
# template language: javascript
PROTO Lamp [ field SFFloat height 2 ] {
  Solid { name "lamp" boundingObject Pose { translation 0 0 %<= fields.height.value / 2 >% children Sphere { } } } })");
  const std::string text = "#VRML_SIM R2023b utf8\nLamp { height 3 }";
  setProperty(*h.kernel.root().find("/sys/server/scene/webots"), "strict", true);
  CHECK_THROWS_WITH(h.import(text), Contains("the PROTO 'Lamp' is not in its place"));
  setProperty(*h.kernel.root().find("/sys/server/scene/webots"), "protos", List{"nowhere", "shared"});
  h.import(text);
  REQUIRE(h.find("lamp"));
  CHECK(getProperty(*h.find("lamp/shape2"), "localPos").toList()[2].toNumber() == 1.5);
}

TEST_CASE("A PROTO that is not in its place is taken from another folder, and is an error with strict") {
  WebotsHost h;
  const std::string proto =
      "#VRML_SIM R2023b utf8\nPROTO Lamp [ ] { Solid { name \"lamp\" boundingObject Sphere { } } }";
  h.folder.write("other/parts/Lamp.proto", proto);
  const std::string text = "#VRML_SIM R2023b utf8\nLamp { }";
  setProperty(*h.kernel.root().find("/sys/server/scene/webots"), "strict", true);
  CHECK_THROWS_WITH(
      h.import(text),
      Contains("r.wbt:2:1: the PROTO 'Lamp' is not in its place: that in 'other/parts/Lamp.proto' is taken"));
  // As in versions of Webots in which the folders of a project were searched.
  h.import("#VRML_SIM R2021b utf8\nLamp { }");
  CHECK(h.find("lamp"));
}

TEST_CASE("A world that cannot be read leaves the tree as it was") {
  WebotsHost h;
  const std::size_t before = h.scene.asNode()->children().size();
  const std::string good = kCar;
  CHECK_THROWS_WITH(h.import(good + "Robot { children }"), Contains("r.wbt:") && Contains("expected a value"));
  setProperty(*h.kernel.root().find("/sys/server/scene/webots"), "strict", true);
  CHECK_THROWS_WITH(h.import(good + "Robot { children LED { } }"), Contains("hidden fields"));
  CHECK_THROWS_WITH(h.import("#VRML_SIM R2023b utf8\nRobot { children [ Missing { } ] }"),
                    Contains("r.wbt:2:20: a node 'Missing' is empty"));
  CHECK(h.scene.asNode()->children().size() == before);
}
