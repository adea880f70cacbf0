#include <catch2/catch.hpp>

#include "../../physics/tests/physics_house.h"
#include "api/agents.h"
#include "api/scene.h"
#include "robots.h"
#include "temporary_folder.h"

using namespace spark;
using namespace spark::test;
using namespace spark::urdf::test;
using Catch::Contains;

namespace {

struct UrdfHost : PhysicsHost {
  TemporaryFolder folder;
  UrdfHost() {
    for (const char* plugin : {"files", "scene-urdf", "gamecontrol", "sensors", "effectors"})
      kernel.plugins().use(plugin);
    kernel.create("FileServer", "/sys/server/file");
    setProperty(kernel.create("DirectoryFileSystem", "/sys/server/file/folder"), "path", folder.path().string());
    kernel.create("UrdfImporter", "/sys/server/scene/urdf");
  }
  void import(const std::string& text, const List& arguments = {}) {
    folder.write("r.urdf", text);
    List all{"r.urdf"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    call(scene, "importScene", all);
  }
  Leaf* find(const std::string& path) { return kernel.root().find("/usr/scene/" + path); }
};

/// A cube of 1 m as OBJ.
std::string cube() {
  std::string out;
  for (int i = 0; i < 8; ++i) out += fmt::format("v {} {} {}\n", i & 1, i >> 1 & 1, i >> 2 & 1);
  return out + "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n";
}

}  // namespace

TEST_CASE("A robot of URDF is in the tree with its joints, perceptors and effectors") {
  UrdfHost h;
  h.import(kArm);
  for (const char* path : {"arm/upper/body", "arm/upper/shoulder", "arm/fore/elbow", "arm/tool/lift"})
    CHECK(h.find(path));
  CHECK(h.find("arm/upper/shoulder")->classObject()->name() == "HingeJoint");
  CHECK(h.find("arm/tool/lift")->classObject()->name() == "SliderJoint");
  std::vector<Perceptor*> perceptors;
  std::vector<Effector*> effectors;
  h.scene.asNode()->collect(perceptors);
  h.scene.asNode()->collect(effectors);
  CHECK(perceptors.size() == 3);
  REQUIRE(effectors.size() == 2);
  CHECK(effectors[0]->predicate() == "shoulder");
  CHECK(effectors[1]->predicate() == "elbow");
  CHECK(getProperty(*h.find("arm"), "innerCollisionDisabled").toBool());
  CHECK(h.text.empty());
  h.import("<robot name='odd'><link name='l'><wheel/></link></robot>");
  CHECK_THAT(h.text, Contains("<wheel>"));
}

TEST_CASE("Two robots stand side by side, each with a prefix, fixed or free") {
  UrdfHost h;
  h.import(kCar, {"a-"});
  h.import(kCar, {"b-", "fixed"});
  CHECK(h.find("a-car/a-base_footprint/body"));
  CHECK(h.find("b-car/b-left_wheel/b-left"));
  CHECK_FALSE(h.find("b-car/b-base_footprint/body"));
  CHECK_THROWS_WITH(h.import(kCar, {"c-", "loose"}),
                    Contains("expected a prefix for names, and 'fixed' or 'free', found 'loose'"));
}

TEST_CASE("Meshes are found by the names of packages") {
  UrdfHost h;
  std::filesystem::create_directories(h.folder.path() / "dog_description/meshes");
  std::filesystem::create_directories(h.folder.path() / "dog_description/urdf");
  h.folder.write("dog_description/meshes/trunk.obj", cube());
  h.folder.write("dog_description/urdf/dog.urdf", kQuadruped);
  h.call(h.scene, "importScene", List{"dog_description/urdf/dog.urdf"});
  CHECK(h.find("dog/trunk/body"));
  CHECK(h.text.empty());
}

TEST_CASE("A mesh that is not where its name says is looked for by its base name") {
  UrdfHost h;
  const auto robot = [](const std::string& mesh) {
    return "<robot name='r'><link name='l'><inertial><mass value='1'/></inertial><collision><geometry>\n<mesh "
           "filename='" +
           mesh + "'/></geometry></collision></link></robot>";
  };
  std::filesystem::create_directories(h.folder.path() / "parts/left");
  std::filesystem::create_directories(h.folder.path() / "parts/right");
  for (const char* name : {"parts/left/Leg.obj", "parts/right/Leg.obj"}) h.folder.write(name, cube());
  const std::vector<std::pair<std::string, std::string>> cases{
      {"package://other/meshes/right/leg.OBJ", "parts/right/Leg.obj"},
      {"file:///home/me/robots/left/Leg.obj", "parts/left/Leg.obj"},
      {"C:\\robots\\right\\Leg.obj", "parts/right/Leg.obj"},
      {"Leg.obj", "parts/left/Leg.obj"},
  };
  for (const auto& [name, found] : cases) {
    h.text.clear();
    h.import(robot(name));
    CHECK_THAT(h.text,
               Contains("r.urdf:2:1: the mesh '" + name + "' is not there: '" + found + "' is read in its place"));
  }
  // One that only has the same name is not taken from far away: it may be a part of another robot.
  std::filesystem::create_directories(h.folder.path() / "a/b/c");
  h.folder.write("a/b/c/r.urdf", robot("package://other/Leg.obj"));
  h.text.clear();
  h.call(h.scene, "importScene", List{"a/b/c/r.urdf"});
  CHECK_THAT(h.text, Contains("a <collision> is left out"));
  h.text.clear();
  h.import(robot("package://other/arm.obj"));
  CHECK_THAT(h.text, Contains("there is no such file in the folders around 'r.urdf'") && Contains("--scene-path"));
}

TEST_CASE("What would be left out is an error with strict") {
  UrdfHost h;
  setProperty(*h.kernel.root().find("/sys/server/scene/urdf"), "strict", true);
  CHECK_THROWS_WITH(h.import(kQuadruped),
                    Contains("r.urdf:5:26:") && Contains("cannot read the mesh") && Contains("meshes/trunk.obj"));
}

TEST_CASE("A robot that cannot be read leaves the tree as it was") {
  UrdfHost h;
  const std::size_t before = h.scene.asNode()->children().size();
  CHECK_THROWS_WITH(h.import("<robot name='r'><link name='a'>"), Contains("r.urdf:1:"));
  CHECK(h.scene.asNode()->children().size() == before);
}
