#include "api/scene.h"

#include <catch2/catch.hpp>
#include <utility>

#include "absence.h"
#include "api/files.h"
#include "api/phases.h"
#include "api/status.h"
#include "spark/script_server.h"
#include "spark/state.h"
#include "test_support.h"

using namespace spark;
using test::lacks;

namespace {

/// Counts the calls of follow() and stores the last position.
class Follower : public SceneNode, public IFollowsTransform {
  SPARK_CLASS(Follower, SceneNode)
 public:
  static void describe(Description<Follower>& d) {
    d.doc("Follows its transform.");
    d.implements<IFollowsTransform>();
  }
  void follow(const Matrix& world) override {
    ++count;
    at = positionOf(world);
  }
  int count = 0;
  Vec3f at = Vec3f::Zero();
};

/// A file system with one file.
class OneFile : public Leaf, public IFileSystem {
  SPARK_CLASS(OneFile, Leaf)
 public:
  static void describe(Description<OneFile>& d) {
    d.doc("One file.");
    d.implements<IFileSystem>();
  }
  std::optional<std::string> read(const std::string& name) override {
    return name == "models/x.obj" ? std::optional(text) : std::nullopt;
  }
  std::uint64_t stamp(const std::string& name) override { return name == "models/x.obj" ? 1 + text.size() : 0; }
  std::string where() const override { return "here"; }
  std::string text;
};

struct Fixture {
  test::TestHost host;
  Kernel& kernel = host.kernel;
  Node* scene = nullptr;
  ISceneServer* server = nullptr;
  Fixture() {
    kernel.plugins().use("files");
    kernel.plugins().use("scene");
    kernel.registerClass<Follower>();
    kernel.registerClass<OneFile>();
    kernel.create("FileServer", "/sys/server/file");
    server = &kernel.create<ISceneServer>("SceneServer", "/sys/server/scene");
    scene = &kernel.create<Node>("Scene", "/usr/scene");
  }
};

List numbers(std::initializer_list<double> v) { return List(v.begin(), v.end()); }

}  // namespace

TEST_CASE("place updates the world matrices below changed transforms") {
  Fixture f;
  auto& a = f.scene->create<Transform>("Transform", "a");
  auto& b = a.create<Transform>("Transform", "b");
  a.setLocalPos({1, 0, 0});
  b.setLocalPos({0, 2, 0});
  f.server->place();
  CHECK(positionOf(b.world()) == Vec3f(1, 2, 0));
  a.setLocalFromBody(translation({5, 0, 0}));
  CHECK(positionOf(b.world()) == Vec3f(1, 2, 0));
  f.server->place();
  CHECK(positionOf(b.world()) == Vec3f(5, 2, 0));
  auto& c = b.create<Transform>("Transform", "c");
  CHECK(positionOf(c.world()) == Vec3f(5, 2, 0));
  c.setLocalPos({0, 0, 3});
  f.kernel.events().define(phase::kPlace, Order::parentsFirst, "");
  f.kernel.events().channel(phase::kPlace).emit({phase::kPlace});
  CHECK(positionOf(c.world()) == Vec3f(5, 2, 3));
}

TEST_CASE("followers below a transform that is set get one call, and none if a body moved it") {
  Fixture f;
  auto& a = f.scene->create<Transform>("Transform", "a");
  auto& b = a.create<Transform>("Transform", "b");
  auto& follower = b.create<Follower>("Follower", "f");
  f.server->place();
  follower.count = 0;
  f.server->place();
  CHECK(follower.count == 0);
  b.setLocalFromBody(translation({9, 0, 0}));
  f.server->place();
  CHECK(follower.count == 0);
  a.setLocalPos({0, 0, 4});
  f.server->place();
  f.server->place();
  CHECK(follower.count == 1);
  CHECK(follower.at == Vec3f(9, 0, 4));
  a.create("Follower", "beside").as<Follower>()->count = 0;
  a.setLocalRotationDeg(0, 0, 90);
  f.server->place();
  CHECK(f.scene->require<Follower>("a/beside").count == 1);
  CHECK((follower.at - Vec3f(0, 9, 4)).norm() < 1e-5f);
}

TEST_CASE("place handles removed and new transforms") {
  Fixture f;
  auto& a = f.scene->create<Transform>("Transform", "a");
  f.server->place();
  f.scene->remove(a);
  f.server->place();
  auto& b = f.scene->create<Transform>("Transform", "b");
  b.setLocalFromBody(translation({0, 1, 0}));
  f.server->place();
  CHECK(positionOf(b.world()) == Vec3f(0, 1, 0));
  f.kernel.root().require<Node>("/usr").remove(*f.scene);
  CHECK_NOTHROW(f.server->place());
  CHECK_THROWS_WITH(f.server->scene(), Catch::Contains("there is no scene at '/usr/scene'"));
}

TEST_CASE("the local matrix of a transform is state, and followers get no call when it is restored") {
  Fixture f;
  auto& a = f.scene->create<Transform>("Transform", "a");
  auto& follower = a.create<Follower>("Follower", "f");
  a.setLocalPos({1, 2, 3});
  f.server->place();
  StateWriter out(true);
  saveTree(*f.scene, out);
  const std::uint64_t before = stateHash(*f.scene);
  a.setLocalPos({4, 5, 6});
  f.server->place();
  CHECK(stateHash(*f.scene) != before);
  follower.count = 0;
  StateReader in(out.bytes());
  loadTree(*f.scene, in);
  f.server->place();
  CHECK(positionOf(a.world()) == Vec3f(1, 2, 3));
  CHECK(follower.count == 0);
  CHECK(stateHash(*f.scene) == before);
}

TEST_CASE("the active scene may be at another path") {
  Fixture f;
  callMethod(*f.kernel.root().find("/sys/server/scene"), "createScene", List{"/usr/other"});
  CHECK(f.server->scene().path() == "/usr/other");
  setProperty(*f.kernel.root().find("/sys/server/scene"), "activeScene", "/usr/scene");
  CHECK(&f.server->scene() == f.scene);
}

TEST_CASE("positions, angles and matrices that are not finite or too large are refused") {
  Fixture f;
  auto& t = f.scene->create<Transform>("Transform", "t");
  callMethod(t, "setLocalPos", List{1.0, 2.0, -1e9});
  const auto refused = [&](const char* method, const List& arguments, const char* what) {
    INFO(method);
    CHECK_THROWS_WITH(callMethod(t, method, arguments), Catch::Contains(what));
    CHECK(t.localPos() == Vec3f(1, 2, -1e9f));
    std::string whyNot;
    CHECK_THROWS_AS(callLoosely(t, *t.classObject()->method(method), arguments, whyNot), RefusedValue);
  };
  const double nan = std::nan("");
  refused("setLocalPos", {nan, 0.0, 1.0}, "expected a position of finite numbers from -1e9 to 1e9, found nan 0.0 1.0");
  refused("setLocalPos", {0.0, 1.1e9, 1.0}, "found 0.0 1.1e+09 1.0");
  refused("setLocalPos", {1e300, 0.0, 0.0}, "found inf 0.0 0.0");
  refused("setLocalRotation", {0.0, 0.0, nan}, "expected angles of finite numbers from -1e9 to 1e9");
  List matrix(16, Value(0.0));
  matrix[5] = HUGE_VAL;
  for (const char* method : {"setLocalTransform", "SLT"})
    refused(method, matrix, "expected a matrix of finite numbers");
  CHECK_THROWS_WITH(setProperty(t, "localPos", List{0.0, nan, 0.0}),
                    Catch::Contains("cannot set /usr/scene/t.localPos") && Catch::Contains("found 0.0 nan 0.0"));
}

TEST_CASE("changing the active scene counts as a change of the tree") {
  Fixture f;
  const auto before = f.kernel.structureVersion();
  f.kernel.create("Scene", "/usr/other");
  const auto made = f.kernel.structureVersion();
  CHECK(made > before);
  setProperty(*f.kernel.root().find("/sys/server/scene"), "activeScene", "/usr/other");
  CHECK(f.kernel.structureVersion() > made);
}

TEST_CASE("an import without an importer is an error") {
  Fixture f;
  CHECK_THROWS_WITH(f.server->importScene("x.rsg", *f.scene, {}), Catch::Contains("has no importer below it"));
}

TEST_CASE("standard meshes have the names that monitors expect") {
  Fixture f;
  const auto load = [&](const char* className, const char* method, const List& arguments) -> IVisual& {
    Leaf& leaf = f.scene->create(className);
    if (*method) callMethod(leaf, method, arguments);
    return *leaf.as<IVisual>();
  };
  CHECK(load("Capsule", "setParams", {0.015, 0.08}).load() == "StdCapsule 0.015 0.08");
  CHECK(load("Cylinder", "setParams", {1.0, 1.0}).load() == "StdUnitCylinder 1 1");
  CHECK(load("StaticMesh", "load", {"models/x.obj"}).load() == "models/x.obj");
  IVisual& box = load("Box", "setExtents", {1, 2, 3});
  CHECK(box.load() == "StdUnitBox");
  CHECK(box.scale() == Vec3f(1, 2, 3));
  CHECK(box.kind() == IVisual::Kind::singleMaterial);
  CHECK(load("Sphere", "setRadius", {0.5}).scale() == Vec3f(0.5f, 0.5f, 0.5f));
}

TEST_CASE("setVisible reads its argument as a number like the installed base, so the text true hides") {
  Fixture f;
  Leaf& box = f.scene->create("Box");
  const auto& visual = *box.as<IVisual>();
  CHECK(visual.visible());
  const Method& set = *box.classObject()->method("setVisible");
  std::string why;
  CHECK(callLoosely(box, set, List{"true"}, why));
  CHECK_FALSE(visual.visible());
  CHECK(callLoosely(box, set, List{"1"}, why));
  CHECK(visual.visible());
  callMethod(box, "setVisible", List{false});
  CHECK_FALSE(visual.visible());
  CHECK_FALSE(visual.transparent());
  callMethod(box, "setTransparent", {});
  CHECK(visual.transparent());
}

TEST_CASE("a mesh has the materials of its file in alphabetical order, or those declared for it") {
  Fixture f;
  auto& file = f.kernel.create<OneFile>("OneFile", "/sys/server/file/one");
  file.text =
      "# a\n# b\nmtllib x.mtl\no x\nv 0 0 0\nusemtl white\r\nf 1/1/1 1/1/1 1/1/1\nusemtl matTeam\r\n"
      "f 1//1 1//1 1//1\nusemtl unused\nusemtl white\nf 1//1 1//1 1//1\n";
  Leaf& mesh = f.scene->create("StaticMesh");
  callMethod(mesh, "load", List{"models/x.obj"});
  auto& visual = *mesh.as<IVisual>();
  CHECK(visual.materials() == std::vector<std::string>{"matTeam", "white"});
  const auto before = f.server->modifiedCount();
  visual.setMaterialName(0, "matLeft");
  visual.setMaterialName(7, "no");
  CHECK(visual.materials() == std::vector<std::string>{"matLeft", "white"});
  CHECK(f.server->modifiedCount() == before + 1);
  StateWriter saved(true);
  saveTree(mesh, saved);
  visual.setMaterialName(1, "black");
  StateReader restored(saved.bytes());
  loadTree(mesh, restored);
  CHECK(visual.materials() == std::vector<std::string>{"matLeft", "white"});
  callMethod(mesh, "load", List{"models/none.obj"});
  CHECK(visual.materials().empty());
  callMethod(*f.kernel.root().find("/sys/server/scene"), "defineMesh", List{"models/none.obj", "a", "b"});
  callMethod(mesh, "load", List{"models/none.obj"});
  CHECK(visual.materials() == std::vector<std::string>{"a", "b"});
  callMethod(mesh, "resetMaterials", List{"c"});
  CHECK(visual.materials() == std::vector<std::string>{"c"});
}

TEST_CASE("an unknown material is logged once, and a known one is not") {
  Fixture f;
  Leaf& materials = f.kernel.create("MaterialServer", "/sys/server/material");
  callMethod(materials, "define", List{"matRed", 1, 0, 0, 1});
  Leaf& box = f.scene->create("Box");
  callMethod(box, "setMaterial", List{"matRed"});
  const std::string known = f.host.text;
  callMethod(box, "setMaterial", List{"matRad"});
  CHECK(f.host.text.find("'matRad'") != std::string::npos);
  CHECK(lacks(known, "material", f.host.text));
  CHECK(f.host.text.find("Did you mean 'matRed'") != std::string::npos);
  const auto once = f.host.text;
  callMethod(box, "setMaterial", List{"matRad"});
  CHECK(f.host.text == once);
  CHECK(box.as<IVisual>()->materials() == std::vector<std::string>{"matRad"});
}

TEST_CASE("lights and cameras return the values that were set") {
  Fixture f;
  Leaf& light = f.scene->create("Light");
  callMethod(light, "setAmbient", numbers({0.1, 0.2, 0.3, 1}));
  CHECK(light.as<IVisual>()->lightColors()[1].g == 0.2f);
  CHECK(light.as<IVisual>()->kind() == IVisual::Kind::light);
  Leaf& camera = f.scene->create("Camera");
  callMethod(camera, "setViewport", List{0, 0, 320, 200});
  callMethod(camera, "setFOV", List{90});
  callMethod(camera, "lookAt", numbers({1, 2, 3}));
  CHECK(callMethod(camera, "getViewportWidth", {}) == Value(320));
  CHECK(callMethod(camera, "getFOV", {}) == Value(90.0));
}

TEST_CASE("another colour of a light or a material at run time is a change of the scene, and the same one is none") {
  Fixture f;
  Leaf& materials = f.kernel.create("MaterialServer", "/sys/server/material");
  Leaf& light = f.scene->create("Light");
  callMethod(materials, "define", List{"paint", 1, 0, 0, 1});
  Leaf& wood = f.kernel.create("Material2DTexture", "/sys/server/material/wood");
  auto changes = [&, before = f.server->modifiedCount()]() mutable {
    return f.server->modifiedCount() - std::exchange(before, f.server->modifiedCount());
  };
  for (const char* part : {"diffuse", "ambient", "specular"}) {
    INFO(part);
    setProperty(light, part, numbers({0.5, 0, 0, 1}));
    setProperty(wood, part, numbers({0.5, 0, 0, 1}));
    CHECK(changes() == 2);
    setProperty(light, part, numbers({0.5, 0, 0, 1}));
    setProperty(wood, part, numbers({0.5, 0, 0, 1}));
    CHECK(changes() == 0);
  }
  setProperty(wood, "emission", numbers({0, 0, 1, 1}));
  setProperty(wood, "shininess", 7.0);
  setProperty(wood, "diffuseTexture", "textures/oak.png");
  CHECK(changes() == 3);
  callMethod(materials, "define", List{"paint", 0, 1, 0, 1});
  CHECK(changes() == 1);
  callMethod(materials, "define", List{"paint", 0, 1, 0, 1});
  setProperty(light, "radius", 5.0);
  CHECK(changes() == 0);
}

TEST_CASE("a game in Lua reports its status with a group of variables, which are state") {
  Fixture f;
  f.kernel.create("StatusVariables", "/sys/variables/Status");
  scripts(f.kernel).run(
      "Status.round = 3 Status.teams = {'East', 'West'} Status.playMode = 'Push' Status.score = {2, 1}", "test");
  const auto reported = [&] {
    std::string text;
    for (const StatusEntry& e : StatusReporters().read(f.kernel)) text += e.name + " " + e.value.text() + "; ";
    return text;
  };
  const std::string all = "playMode \"Push\"; score {2, 1}; teams {\"East\", \"West\"}; round 3; ";
  CHECK(reported() == all);
  auto& group = f.kernel.root().require<Leaf>("/sys/variables/Status");
  StateWriter saved(true);
  saveTree(group, saved);
  const std::uint64_t hash = stateHash(group);
  scripts(f.kernel).run("Status.score = {5, 5} Status.round = nil Status.wind = 0.5", "test");
  CHECK(reported() == "playMode \"Push\"; score {5, 5}; teams {\"East\", \"West\"}; wind 0.5; ");
  CHECK(stateHash(group) != hash);
  StateReader read(saved.bytes());
  loadTree(group, read);
  CHECK(reported() == all);
  CHECK(stateHash(group) == hash);
}

TEST_CASE("variables are read by name, and a list by its group's name alone") {
  Fixture f;
  Leaf& soccer = f.kernel.create("Variables", "/sys/variables/Soccer");
  callMethod(soccer, "set", List{"FieldLength", 30.0});
  const auto& read = *soccer.as<IVariables>();
  CHECK(read.variable("FieldLength") == Value(30.0));
  CHECK(read.variable("FieldWidth").isNil());
  CHECK(read.variable("").isNil());
  setProperty(soccer, "value", List{1, 2});
  CHECK(read.variable("") == Value(List{1, 2}));
  CHECK(getProperty(soccer, "names") == Value(List{"FieldLength"}));
}
