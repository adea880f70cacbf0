#include "all_plugins.h"
#include "spark/state.h"

// Most classes are at home in a scene: a small house with a world and a body, into which one object of each class
// moves.

using namespace spark;
using spark::test::AllPlugins;

namespace {
/// Servers, a scene with world and space, a ground, and a transform with a body and a collider.
struct SmallHouse : AllPlugins {
  Node* place = nullptr;
  SmallHouse() {
    kernel.create("FileServer", "/sys/server/file");
    kernel.create("SceneServer", "/sys/server/scene");
    kernel.create("PhysicsServer", "/sys/server/physics");
    kernel.create("OdeCollision", "/sys/server/physics/collision");
    kernel.create("OdeEngine", "/sys/server/physics/engine");
    kernel.create("Simulation", "/sys/server/simulation");
    setProperty(*kernel.root().find("/sys/server/simulation"), "rate", "max");
    kernel.create("SoccerSettings", "/sys/variables/Soccer");
    kernel.create("GameControl", "/sys/server/gamecontrol");
    kernel.create("MonitorServer", "/sys/server/monitor");
    kernel.create("Scene", "/usr/scene");
    kernel.create("World", "/usr/scene/world");
    kernel.create("Space", "/usr/scene/space");
    place = &kernel.create<Node>("Transform", "/usr/scene/thing");
    place->create("RigidBody", "body");
    place->create<Node>("SphereCollider", "shape").create("ContactJointHandler", "surface");
  }
  /// Where an object of the class finds what it looks for above it: nodes that are made for another's inside go there.
  std::vector<Node*> homes() {
    std::vector<Node*> out;
    for (const char* path :
         {"/usr/scene/thing", "/usr/scene/thing/shape", "/sys/server/gamecontrol", "/sys/server/monitor", "/lonely"})
      out.push_back(&kernel.root().require<Node>(path));
    return out;
  }
  /// The object, linked at the first place that takes it; nullptr when none does.
  Leaf* settle(ClassObject& c) {
    for (Node* home : homes()) {
      try {
        return &home->create(c.name(), "guest");
      } catch (const Error&) {
        continue;  // not its home
      }
    }
    return nullptr;
  }
  void run(int cycles) {
    callMethod(*kernel.root().find("/sys/server/simulation"), "runCycles", std::vector<Value>{cycles});
  }
};

/// Sockets and transports need more than a house.
bool isForeign(const ClassObject& c) { return c.plugin()->name() == "net-tcp" || c.plugin()->name() == "control"; }
}  // namespace

TEST_CASE("An object of each class lives in a house, is stepped with it, and leaves nothing") {
  SmallHouse house;
  house.kernel.create("Node", "/lonely");
  house.run(1);
  for (ClassObject* c : house.kernel.classes()) {
    if (!c->plugin() || c->isAbstract() || isForeign(*c)) continue;
    INFO("plugin " << c->plugin()->name() << ", class " << c->name());
    const std::size_t before = c->living();
    house.text.clear();
    const Ref<Leaf> guest(house.settle(*c));
    REQUIRE(guest);
    for (const Property* p : c->properties()) {
      INFO("property " << p->name);
      if (p->readOnly || p->name == "name") continue;
      try {
        setProperty(*guest, p->name, p->get(*guest));
      } catch (const std::exception& e) {
        FAIL_CHECK(e.what());
      }
    }
    house.run(2);
    if (guest) guest->parent()->remove(*guest);  // it may have left by itself
    CHECK(c->living() == before);
    house.run(1);
    CHECK_THAT(house.text, !Catch::Contains("no std::exception"));
  }
}

TEST_CASE("A house's saved state goes on as it would have, to the same hash") {
  SmallHouse house;
  house.kernel.create("Node", "/lonely");
  setProperty(house.kernel.root().require<Leaf>("/usr/scene/thing"), "localPos", List{0, 0, 3});
  Leaf& controller = house.kernel.root().require<Node>("/usr/scene/thing/body").create("DragController");
  setProperty(controller, "linearDrag", 0.5);
  house.kernel.create("PlaneCollider", "/usr/scene/ground");
  house.run(7);
  StateWriter saved(true);
  saveTree(house.kernel.root(), saved);
  const std::uint64_t before = stateHash(house.kernel.root());
  house.run(40);
  const std::uint64_t after = stateHash(house.kernel.root());
  CHECK(after != before);
  StateReader in(saved.bytes());
  loadTree(house.kernel.root(), in);
  CHECK(in.atEnd());
  CHECK(stateHash(house.kernel.root()) == before);
  house.run(40);
  CHECK(stateHash(house.kernel.root()) == after);
}
