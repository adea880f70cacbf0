// The smallest simulation with physics: lua/boxes.lua, run as a config.

#include <catch2/catch.hpp>

#include "absence.h"
#include "api/physics.h"
#include "spark/script_server.h"
#include "spark/state.h"
#include "temporary_folder.h"
#include "test_support.h"

using namespace spark;

namespace {

struct Boxes {
  test::TestHost host;
  Kernel& kernel = host.kernel;
  Node* scene = nullptr;
  std::vector<IRigidBody*> bodies;

  Boxes() {
    const auto share = test::binFolder().parent_path() / "share" / "spark";
    scripts(kernel).addFolder(share / "lua");
    scripts(kernel).run("host = { share = [[" + share.string() + "]], scenePaths = {} }", "test");
    scripts(kernel).runConfig("boxes.lua");
    scene = kernel.root().find<Node>("/usr/scene");
    scene->collect(bodies);
    setProperty(simulation(), "rate", "max");
  }
  Leaf& simulation() { return *kernel.root().find("/sys/server/simulation"); }
  void run(double seconds) { callMethod(simulation(), "runCycles", List{static_cast<int>(seconds / 0.02)}); }
};

}  // namespace

TEST_CASE("54 bodies fall between the walls and stay there") {
  Boxes b;
  REQUIRE(b.bodies.size() == 54);
  int boxes = 0, spheres = 0, capsules = 0;
  std::vector<IVisual*> visuals;
  b.scene->collect(visuals);
  for (const IVisual* v : visuals) {
    spheres += v->load() == "StdUnitSphere";
    capsules += v->load().starts_with("StdCapsule ");
    boxes += v->load() == "StdUnitBox";
  }
  CHECK(boxes == 18 + 5);  // with the ground and four walls
  CHECK(spheres == 18);
  CHECK(capsules == 18);

  b.run(8);
  for (const IRigidBody* body : b.bodies) {
    const engine::BodyState s = body->state();
    INFO(s.position.transpose());
    CHECK(s.position.z() > 0.1);
    CHECK(s.position.z() < 2);
    CHECK(std::abs(s.position.x()) < 6);
    CHECK(std::abs(s.position.y()) < 6);
    CHECK((positionOf(body->bodyTransform()->world()).cast<double>() - s.position).norm() < 1e-5);
  }
  const std::string before = b.host.text;
  test::TemporaryFolder folder;
  folder.write("faulty.rsg", "(RSG 0 1)((nd Box (setExtents one)(setMaterial matNone)))");
  setProperty(b.kernel.create("DirectoryFileSystem", "/sys/server/file/faulty"), "path", folder.path().string());
  callMethod(*b.scene, "importScene", List{"faulty.rsg"});
  for (const char* const fault : {"skipped", "material"}) CHECK(test::lacks(before, fault, b.host.text));
}

TEST_CASE("two runs of the config end in the same state") {
  Boxes a, b;
  a.run(3);
  b.run(3);
  CHECK(stateHash(*a.scene) == stateHash(*b.scene));
  b.run(0.02);
  CHECK(stateHash(*a.scene) != stateHash(*b.scene));
}
