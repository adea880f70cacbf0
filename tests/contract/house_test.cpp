#include <fmt/ranges.h>

#include <set>

#include "../readable.h"
#include "absence.h"
#include "all_plugins.h"
#include "api/phases.h"
#include "spark/state.h"

// Most classes are made for a scene. These tests add one object of each class to a small scene with a world and a body.

using namespace spark;
using namespace spark::test;

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
  SmallScene faulty;
  faulty.kernel.events().channel(phase::kRule).add(faulty.kernel.create("Node", "/faulty"), [](Leaf&, const Event&) {
    throw 42;
  });
  faulty.run(1);
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
    CHECK(lacks(host.text, "no std::exception", faulty.text));
  }
}

namespace {
/// Runs a world with an object of a class, loads its state into a second one that is some cycles behind, and runs both
/// on. Returns how they differ: a line for each property that can be read.
std::string afterLoading(const std::string& className, const std::function<void(Leaf&)>& prepare) {
  SmallScene one, two;
  for (SmallScene* s : {&one, &two}) {
    s->kernel.create("Node", "/lonely");
    s->kernel.plugins().scan(binFolder().parent_path() / "tests" / "forgetful-plugins");
    if (!s->kernel.findClass(className)) s->kernel.plugins().use("forgetful");
    Leaf* const guest = s->insert(s->kernel.classOf(className));
    if (guest) prepare(*guest);
  }
  two.run(2);
  one.run(7);
  StateWriter saved(true);
  saveTree(one.kernel.root(), saved);
  StateReader in(saved.bytes());
  loadTree(two.kernel.root(), in);
  for (int cycle = 0; cycle <= 5; ++cycle) {
    if (cycle > 0) one.run(1), two.run(1);
    if (const auto lines = readableDifferences(one.kernel, two.kernel); !lines.empty())
      return fmt::format("{} cycles after loading: {}", cycle, fmt::join(lines, "; "));
    if (stateHash(one.kernel.root()) != stateHash(two.kernel.root()))
      return fmt::format("{} cycles after loading: another state hash", cycle);
  }
  return in.atEnd() ? "" : "the state is longer than it was read";
}
}  // namespace

TEST_CASE("An object of each class goes on from saved state in another scene as in its own") {
  AllPlugins all;
  for (const ClassObject* c : all.kernel.classes()) {
    if (!c->plugin() || c->isAbstract() || needsNetwork(*c)) continue;
    INFO("plugin " << c->plugin()->name() << ", class " << c->name());
    CHECK(afterLoading(c->name(), [](Leaf&) {}) == "");
  }
}

TEST_CASE("A class that forgets to save a member is found") {
  CHECK_THAT(afterLoading("Forgetful", [](Leaf&) {}), Catch::Contains("/guest.forgotten (Forgetful): 7 against 2"));
}

TEST_CASE("Each property that can be set is in the hash of the state or in that of the configuration") {
  SmallScene host;
  host.kernel.create("Node", "/lonely");
  int changed = 0;
  std::set<std::string> inNone;  // names of those that tell of the process
  for (ClassObject* c : host.kernel.classes()) {
    if (!c->plugin() || c->isAbstract() || needsNetwork(*c)) continue;
    const Ref<Leaf> guest(host.insert(*c));
    REQUIRE(guest);
    for (const Property* p : c->properties()) {
      if (p->readOnly || p->name == "name") continue;
      INFO("plugin " << c->plugin()->name() << ", class " << c->name() << ", property " << p->name);
      if (p->ofProcess) {
        inNone.insert(p->name);
        continue;
      }
      const Leaf& root = host.kernel.root();
      const Value before = p->get(*guest), other = anotherOrList(*p, before);
      if (other.isNil()) continue;
      const auto hashes = std::pair(stateHash(root), configurationHash(root));
      try {
        setProperty(*guest, p->name, other);
      } catch (const Error&) {
        continue;  // not at this place
      }
      if (same(p->get(*guest), before)) continue;
      ++changed;
      CHECK(std::pair(stateHash(root), configurationHash(root)) != hashes);
    }
    guest->parent()->remove(*guest);
  }
  CHECK(changed > 300);
  CHECK(inNone == std::set<std::string>{"address", "arguments", "commServers", "database", "file", "level", "logs",
                                        "path", "port", "time", "viewer", "viewerLacks", "whilePlayed"});
}

TEST_CASE("A run leaves the configuration as it is") {
  SmallScene host;
  host.kernel.create("Node", "/lonely");
  for (ClassObject* c : host.kernel.classes()) {
    if (!c->plugin() || c->isAbstract() || needsNetwork(*c)) continue;
    const Ref<Leaf> guest(host.insert(*c));
    REQUIRE(guest);
    const auto before = configurationOf(host.kernel.root());
    const std::uint64_t hash = configurationHash(host.kernel.root());
    host.run(5);
    INFO("plugin " << c->plugin()->name() << ", class " << c->name());
    CHECK(configurationOf(host.kernel.root()) == before);
    CHECK(configurationHash(host.kernel.root()) == hash);
    if (guest) guest->parent()->remove(*guest);
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
