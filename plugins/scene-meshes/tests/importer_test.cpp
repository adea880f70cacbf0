#include "../../physics/tests/mesh_house.h"
#include "spark/access.h"

using namespace spark;
using namespace spark::test;
using Catch::Contains;

namespace {

struct ModelHost : MeshHouse {
  ModelHost() {
    for (const char* plugin : {"scene-meshes", "scene-rsg"}) kernel.plugins().use(plugin);
    kernel.create("MeshImporter", "/sys/server/scene/meshes");
    kernel.create("RsgImporter", "/sys/server/scene/rsg");
    for (const char* name : {"models/small box.obj", "models/box.obj"})
      folder.write(name, boxFile({-1, -1, 0}, {1, 1, 0.5}));
  }
  Leaf* find(const std::string& path) { return kernel.root().find("/usr/scene/" + path); }
  /// The height at which a ray from above meets something at x = y = 0.3.
  Value below() {
    return call(*kernel.root().find("/sys/server/physics"), "castRay",
                {List{0.3, 0.3, 5.0}, List{0.0, 0.0, -1.0}, 10.0});
  }
};

}  // namespace

TEST_CASE("A 3D model becomes a transform with its mesh, and collides with it") {
  ModelHost h;
  Node& place = *h.scene.create("Transform", "place").asNode();
  h.call(place, "setLocalPos", {0.0, 0.0, 1.0});
  h.call(place, "importScene", {"models/small box.obj"});
  REQUIRE(h.find("place/small_box/shape"));
  h.step();
  const Value hit = h.below();
  REQUIRE(hit.isList());
  CHECK(hit.toList()[0].toNumber() == Approx(3.5));
  CHECK(hit.toList()[1].plain() == "/usr/scene/place/small_box/space/collider");
}

TEST_CASE("A 3D model is scaled, shown only, and named anew, as its arguments say") {
  ModelHost h;
  h.folder.write("s.rsg", "(RSG 0 1)(importScene models/box.obj 2)");
  h.call(h.scene, "importScene", {"models/small box.obj", "shown"});
  h.step();
  CHECK(h.below().isNil());
  CHECK_FALSE(h.find("small_box/space"));
  h.call(h.scene, "importScene", {"models/small box.obj", "shown"});
  CHECK(h.find("small_box_2/shape"));
  h.call(h.scene, "importScene", {"s.rsg"});
  h.step();
  REQUIRE(h.find("box/space/collider"));
  REQUIRE(h.below().isList());
  CHECK(h.below().toList()[0].toNumber() == Approx(4));
  const Value box = h.call(*h.kernel.root().find("/sys/server/physics"), "boundingBox", {"/usr/scene/box"});
  REQUIRE(box.isList());
  CHECK(box.toList()[0].toList()[0].toNumber() == Approx(-2));
  CHECK(box.toList()[1].toList()[2].toNumber() == Approx(1));
}

TEST_CASE("What is no 3D model is an error that leaves the tree as it was") {
  ModelHost h;
  h.folder.write("empty.obj", "# nothing\n");
  h.folder.write("bad.stl", "solid");
  for (const char* file : {"empty.obj", "bad.stl", "missing.dae"}) {
    INFO(file);
    CHECK_THROWS_WITH(h.call(h.scene, "importScene", {file}), Contains(file));
  }
  CHECK_THROWS_WITH(h.call(h.scene, "importScene", {"models/small box.obj", 1, 2}), Contains("one number or three"));
  CHECK_THROWS_WITH(h.call(h.scene, "importScene", {"models/small box.obj", "hidden"}), Contains("found 'hidden'"));
  CHECK(h.scene.children().size() == 2);  // world and space
}

TEST_CASE("Scripts ask for boxes around nodes, and for what a ray meets") {
  ModelHost h;
  Leaf& physics = *h.kernel.root().find("/sys/server/physics");
  h.ground();
  h.step();
  CHECK(h.call(physics, "boundingBox", {"/usr/scene"}).isNil());  // a plane has none
  CHECK_THROWS_WITH(h.call(physics, "boundingBox", {"/usr/nothing"}), Contains("/usr/nothing"));
  CHECK_THROWS_WITH(h.call(physics, "castRay", {List{0.0, 0.0, 5.0}, List{0.0, 0.0, 0.0}, 1.0}), Contains("direction"));
  const Value ground = h.call(physics, "castRay", {List{0.0, 0.0, 5.0}, List{0.0, 0.0, -2.0}, 10.0});
  REQUIRE(ground.isList());
  CHECK(ground.toList()[0].toNumber() == Approx(5));
  CHECK(ground.toList()[3].toList()[2].toNumber() == Approx(1));
  CHECK(h.call(physics, "castRay", {List{0.0, 0.0, 5.0}, List{0.0, 0.0, -2.0}, 4.0}).isNil());
}
