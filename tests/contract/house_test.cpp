#include "all_plugins.h"
#include "spark/state.h"

// Most classes are made for a scene. These tests add one object of each class to a small scene with a world and a body.

using namespace spark;
using spark::test::AllPlugins;

namespace {
/// Servers, a scene with world and space, a ground, and a transform with a body and a collider.
struct SmallScene : AllPlugins {
  SmallScene() {
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
    Node& thing = kernel.create<Node>("Transform", "/usr/scene/thing");
    thing.create("RigidBody", "body");
    thing.create<Node>("SphereCollider", "shape").create("ContactJointHandler", "surface");
  }
  /// Nodes under which an object may find what it needs above it.
  std::vector<Node*> parents() {
    std::vector<Node*> out;
    for (const char* path :
         {"/usr/scene/thing", "/usr/scene/thing/shape", "/sys/server/gamecontrol", "/sys/server/monitor", "/lonely"})
      out.push_back(&kernel.root().require<Node>(path));
    return out;
  }
  /// Makes an object of the class under the first node that accepts it; nullptr if none does.
  Leaf* insert(ClassObject& c) {
    for (Node* parent : parents()) {
      try {
        return &parent->create(c.name(), "guest");
      } catch (const Error&) {
        continue;
      }
    }
    return nullptr;
  }
  void run(int cycles) {
    callMethod(*kernel.root().find("/sys/server/simulation"), "runCycles", std::vector<Value>{cycles});
  }
};

/// Sockets and transports need more than a scene.
bool needsNetwork(const ClassObject& c) { return c.plugin()->name() == "net-tcp" || c.plugin()->name() == "control"; }
}  // namespace

TEST_CASE("An object of each class can be added to a scene, stepped, and removed without traces") {
  SmallScene host;
  host.kernel.create("Node", "/lonely");
  host.run(1);
  for (ClassObject* c : host.kernel.classes()) {
    if (!c->plugin() || c->isAbstract() || needsNetwork(*c)) continue;
    INFO("plugin " << c->plugin()->name() << ", class " << c->name());
    const std::size_t before = c->living();
    host.text.clear();
    const Ref<Leaf> guest(host.insert(*c));
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
    host.run(2);
    if (guest) guest->parent()->remove(*guest);  // it may have removed itself
    CHECK(c->living() == before);
    host.run(1);
    CHECK_THAT(host.text, !Catch::Contains("no std::exception"));
  }
}

TEST_CASE("A scene that is restored from saved state continues with the same hash") {
  SmallScene host;
  host.kernel.create("Node", "/lonely");
  setProperty(host.kernel.root().require<Leaf>("/usr/scene/thing"), "localPos", List{0, 0, 3});
  Leaf& controller = host.kernel.root().require<Node>("/usr/scene/thing/body").create("DragController");
  setProperty(controller, "linearDrag", 0.5);
  host.kernel.create("PlaneCollider", "/usr/scene/ground");
  host.run(7);
  StateWriter saved(true);
  saveTree(host.kernel.root(), saved);
  const std::uint64_t before = stateHash(host.kernel.root());
  host.run(40);
  const std::uint64_t after = stateHash(host.kernel.root());
  CHECK(after != before);
  StateReader in(saved.bytes());
  loadTree(host.kernel.root(), in);
  CHECK(in.atEnd());
  CHECK(stateHash(host.kernel.root()) == before);
  host.run(40);
  CHECK(stateHash(host.kernel.root()) == after);
}
