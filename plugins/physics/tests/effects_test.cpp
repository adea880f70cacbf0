#include "absence.h"
#include "api/engine.h"
#include "physics_house.h"

using namespace spark;
using namespace spark::test;

namespace {

/// An engine that moves nothing, with a choice of capabilities.
class Choosy : public Leaf, public engine::IEngine {
  SPARK_CLASS(Choosy, Leaf)
 public:
  static void describe(Description<Choosy>& d) {
    d.doc("Moves nothing.");
    d.implements<engine::IEngine>();
  }
  struct Solver : engine::ISolver {
    void step(engine::Step&) override {}
  };
  Leaf& leaf() override { return *this; }
  engine::Capabilities capabilities() const override { return can; }
  std::unique_ptr<engine::ISolver> create(const engine::Model&) override { return std::make_unique<Solver>(); }
  inline static engine::Capabilities can;
};

/// Three bodies; hinges from one to the next, and a box on the ground with a surface.
struct Loop : PhysicsHost {
  Loop() {
    kernel.registerClass<Choosy>();
    for (const char* const name : {"a", "b", "c"}) thing(name, {name[0] - 'a' + 0.0, 0, 1});
    hinge("a", "b");
    hinge("b", "c");
    scene.require<Node>("a").create("BoxCollider", "box").asNode()->create("ContactJointHandler", "surface");
  }
  Leaf& hinge(const std::string& from, const std::string& to) {
    Leaf& j = scene.require<Node>(from).create("HingeJoint", "to-" + to);
    call(j, "attach", {"../body", "../../" + to + "/body"});
    return j;
  }
  /// What the log says with an engine of these capabilities.
  std::string said(const engine::Capabilities& can) {
    Choosy::can = can;
    Node& server = kernel.root().require<Node>("/sys/server/physics");
    server.remove(*server.child("engine"));
    server.create("Choosy", "engine");
    text.clear();
    step(3);
    return text;
  }
};

}  // namespace

TEST_CASE("the log says once for each kind what has no effect with an engine, and where it is") {
  Loop l;
  const std::string before = l.said({.armature = true});
  l.call(l.scene.require<Leaf>("a/to-b"), "setArmature", {0, 0.1});
  l.call(l.scene.require<Leaf>("b/to-c"), "setArmature", {0, 0.1});
  CHECK(l.said({}).find("/usr/scene/a/to-b: the inertia of rotors (armature) has no effect with Choosy") !=
        std::string::npos);
  CHECK(count(l.text, "no effect") == 1);
  CHECK(lacks(before, "no effect", l.text));

  CHECK(l.said({.joints = false}).find("/usr/scene/a/to-b: joints have no effect with Choosy") != std::string::npos);
  CHECK(count(l.text, "no effect") == 1);

  CHECK(l.said({.armature = true, .surfaces = false}).find("/usr/scene/a/box/surface: bounce has no effect") !=
        std::string::npos);

  const std::string open = l.said({.loops = false, .armature = true});
  // The trees are a-b and a-c: the joint between b and c is the one that engines leave out.
  l.hinge("c", "a");
  l.step();
  CHECK_THAT(l.text,
             Catch::Contains("/usr/scene/b/to-c: joints that close a loop of bodies have no effect with Choosy"));
  CHECK(lacks(open, "no effect", l.text));
}
