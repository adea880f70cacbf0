#include "physics_house.h"
#include "spark/script_server.h"

using namespace spark;
using namespace spark::test;

namespace {

/// Counts its calls.
class CountingHandler : public ContactJointHandler {
  SPARK_CLASS(CountingHandler, ContactJointHandler)
 public:
  static void describe(Description<CountingHandler>& d) { d.doc("Counts contacts, for tests."); }
  void onCollision(const Collision& c) override {
    ++(c.direct ? direct : symmetric);
    if (asks) c.contact.feedback = true;
    if (breaksRules) c.self.leaf().asNode()->create("RecorderHandler");
  }
  void onSolved(const Collision& c) override {
    ++solved;
    if (c.direct) force += c.contact.forceOnA;
  }
  int direct = 0, symmetric = 0, solved = 0;
  bool asks = true;
  Vec3 force = Vec3::Zero();
  bool breaksRules = false;
};

struct Ground : PhysicsHost {
  Node& ground;
  Node& box1;
  Ground() : ground(*scene.create("PlaneCollider", "ground").asNode()), box1(box("box", {0, 0, 0.49}, {1, 1, 1})) {}
  Node& collider() { return *box1.find("collider")->asNode(); }
  /// Height of the box after `steps` steps; by default after half a second.
  double heightAfter(int steps = 25) {
    step(steps);
    return body(box1).state().position.z();
  }
};

}  // namespace

TEST_CASE("two colliders without handlers are solid and bounce by default") {
  Ground g;
  g.box1.as<Transform>()->setLocalPos({0, 0, 3});
  double highest = 0;
  g.step(38);
  for (int i = 0; i < 60; ++i) {
    g.step();
    highest = std::max(highest, Ground::body(g.box1).state().position.z());
  }
  CHECK(highest > 1.5);  // it rebounds with 0.8 of the speed of a fall from 2.5 m
}

TEST_CASE("a contact is solid only if each collider has a contact joint handler or no handler at all") {
  struct Case {
    const char *first, *second;
    bool solid;
  };
  for (const Case& c : {Case{"", "", true},
                        {"ContactJointHandler", "", true},
                        {"ContactJointHandler", "ContactJointHandler", true},
                        {"RecorderHandler", "", false},
                        {"RecorderHandler", "ContactJointHandler", false},
                        {"", "RecorderHandler", false}}) {
    Ground g;
    INFO("'" << c.first << "' on '" << c.second << "'");
    if (*c.first) g.collider().create(c.first);
    if (*c.second) g.ground.create(c.second);
    if (c.solid)
      CHECK(g.heightAfter() > 0.4);
    else
      CHECK(g.heightAfter() < 0.0);
  }
}

TEST_CASE("the first contact joint handler of a collider determines its surface") {
  Ground g;
  g.collider().create("RecorderHandler");
  Leaf& first = g.collider().create("ContactJointHandler");
  Leaf& second = g.collider().create("ContactJointHandler");
  Leaf& below = g.ground.create("ContactJointHandler");
  for (Leaf* h : {&first, &below}) Ground::call(*h, "setContactBounceMode", {false});
  Ground::call(second, "setContactBounceValue", {1.0});
  Ground::call(first, "setContactMu", {0.0});
  Ground::call(below, "setContactMu", {0.0});
  Ground::body(g.box1).setVelocity({1, 0, 0});
  g.step(25);
  // Without friction the box keeps sliding. With the bounce or the friction of the second handler it would not.
  CHECK(Ground::body(g.box1).state().linearVelocity.x() == Approx(1).margin(0.05));
  CHECK(std::abs(Ground::body(g.box1).state().linearVelocity.z()) < 0.1);
}

TEST_CASE("a recorder of either collider lists each touched collider once until it is cleared") {
  Ground g;
  auto& upper = *g.collider().create("RecorderHandler").as<ICollisionRecorder>();
  auto& lower = *g.ground.create("RecorderHandler").as<ICollisionRecorder>();
  g.step(2);
  REQUIRE(upper.colliders().size() == 1);
  CHECK(upper.colliders()[0].get() == &g.ground);
  REQUIRE(lower.colliders().size() == 1);
  CHECK(lower.colliders()[0].get() == &g.collider());
  CHECK(getProperty(*g.ground.find("RecorderHandler"), "colliders").toList().at(0).toString() ==
        "/usr/scene/box/collider");
  Ground::call(*g.ground.find("RecorderHandler"), "clear");
  CHECK(lower.colliders().empty());
  g.step();
  CHECK(lower.colliders().size() == 1);
  g.scene.remove(g.box1);
  CHECK_FALSE(lower.colliders()[0]);
  CHECK(getProperty(*g.ground.find("RecorderHandler"), "colliders").toList().empty());
}

TEST_CASE("a static collider with a handler detects another static collider") {
  PhysicsHost host;
  Node& a = host.transform(host.scene, "a", {0, 0, 0});
  Node& b = host.transform(host.scene, "b", {0.5, 0, 0});
  auto& seen = *a.create("BoxCollider").asNode()->create("RecorderHandler").as<ICollisionRecorder>();
  b.create("BoxCollider");
  host.step();
  CHECK(seen.colliders().size() == 1);
}

TEST_CASE("a handler gets direct and symmetric contacts, and after the step the requested force") {
  Ground g;
  g.kernel.registerClass<CountingHandler>();
  auto& upper = static_cast<CountingHandler&>(g.collider().create("CountingHandler"));
  auto& lower = static_cast<CountingHandler&>(g.ground.create("CountingHandler"));
  g.step();
  CHECK(upper.direct == 4);
  CHECK(upper.symmetric == 0);
  CHECK(lower.direct == 0);
  CHECK(lower.symmetric == 4);
  CHECK(upper.force.z() > 0);
}

TEST_CASE(
    "the contacts of the last step can be read, with measureForces all have their force, and handlers get no "
    "additional calls") {
  Ground g;
  g.kernel.registerClass<CountingHandler>();
  auto& upper = static_cast<CountingHandler&>(g.collider().create("CountingHandler"));
  g.ground.create("ContactJointHandler");
  Node& other = g.box("other", {5, 0, 0.49}, {1, 1, 1});
  auto& indifferent = static_cast<CountingHandler&>(other.find("collider")->asNode()->create("CountingHandler"));
  indifferent.asks = false;
  auto& server = g.kernel.root().require<IPhysicsServer>("/sys/server/physics");
  CHECK(server.contacts().empty());
  const auto withForce = [&] {
    std::size_t n = 0;
    for (const engine::Contact& c : server.contacts()) n += c.feedback && c.forceOnA.norm() > 0;
    return n;
  };
  g.step();
  REQUIRE(server.contacts().size() == 8);
  CHECK(withForce() == 4);
  const engine::Contact& last = server.contacts().back();
  CHECK(last.depth == Approx(0.01).margin(1e-6));
  std::vector<std::string> touching;
  for (void* owner : {last.ownerA, last.ownerB}) touching.push_back(server.colliderOf(owner).leaf().path());
  CHECK(std::count(touching.begin(), touching.end(), "/usr/scene/ground") == 1);
  setProperty(*g.kernel.root().find("/sys/server/physics"), "measureForces", true);
  g.step();
  CHECK(withForce() == 8);
  CHECK(upper.solved == 8);
  CHECK(indifferent.solved == 0);
  setProperty(*g.kernel.root().find("/sys/server/physics"), "measureForces", false);
  g.step();
  CHECK(std::count_if(server.contacts().begin(), server.contacts().end(),
                      [](const engine::Contact& c) { return c.feedback; }) == 4);
  g.scene.remove(other);
  CHECK(server.contacts().empty());
}

TEST_CASE("with measureForces each contact has its force, even if no handler requests it") {
  Ground g;
  g.collider().create("ContactJointHandler");
  g.ground.create("ContactJointHandler");
  setProperty(*g.kernel.root().find("/sys/server/physics"), "measureForces", true);
  g.step();
  const auto& contacts = g.kernel.root().require<IPhysicsServer>("/sys/server/physics").contacts();
  REQUIRE(contacts.size() == 4);
  for (const engine::Contact& c : contacts) CHECK((c.feedback && c.forceOnA.norm() > 0));
}

TEST_CASE("a handler that changes the tree during a step is reported and does no harm") {
  Ground g;
  g.kernel.registerClass<CountingHandler>();
  static_cast<CountingHandler&>(g.collider().create("CountingHandler")).breaksRules = true;
  g.step(2);
  CHECK_THAT(g.text, Catch::Contains("changed the tree") && Catch::Contains("/usr/scene/box/collider"));
}

TEST_CASE(
    "a transform collider without its own handler bounces by default, or uses the inner collider's handlers if set") {
  for (const bool fallback : {true, false}) {
    PhysicsHost host;
    setProperty(*host.kernel.root().find("/sys/server/physics"), "defaultHandlerOnTransformCollider", fallback);
    host.scene.create("PlaneCollider", "ground");
    Node& t = host.thing("thing", {0, 0, 0.49});
    Node& inner = *t.create("TransformCollider", "outer").asNode()->create("BoxCollider", "inner").asNode();
    // With only the inner handler, the collider is not solid.
    auto& seen = *inner.create("RecorderHandler").as<ICollisionRecorder>();
    host.step(25);
    INFO((fallback ? "default" : "inner"));
    CHECK((host.body(t).state().position.z() > 0.4) == fallback);
    CHECK(seen.colliders().empty() == fallback);
  }
}

TEST_CASE("a contact of a transform collider reports the transform collider and not the inner one") {
  PhysicsHost host;
  auto& seen =
      *host.scene.create("PlaneCollider", "ground").asNode()->create("RecorderHandler").as<ICollisionRecorder>();
  Node& t = host.thing("thing", {0, 0, 0.49});
  Leaf& outer = t.create("TransformCollider", "outer");
  outer.asNode()->create("BoxCollider", "inner");
  host.step();
  REQUIRE(seen.colliders().size() == 1);
  CHECK(seen.colliders()[0].get() == &outer);
  CHECK(outer.as<ICollider>()->body() == t.find<IRigidBody>("body"));
}

TEST_CASE("addCollisionHandler makes a handler of the named class and refuses other classes") {
  Ground g;
  Ground::call(g.ground, "addCollisionHandler", {"oxygen/ContactJointHandler"});
  CHECK(g.ground.childOf<ContactJointHandler>() != nullptr);
  CHECK_THROWS(Ground::call(g.ground, "addCollisionHandler", {"Transform"}));
}

TEST_CASE(
    "after the step a ScriptHandler emits collide at itself with the other collider, the position and the depth") {
  Ground g;
  Leaf& handler = g.collider().create("ScriptHandler");
  std::vector<std::string> others;
  double depth = 0;
  Vec3 position;
  g.kernel.events().channel("collide").add(handler, [&](Leaf&, const Event& e) {
    others.push_back(e.data->at(std::size_t(0))->toString());
    depth = e.data->at(std::size_t(2))->toNumber();
    const List& p = e.data->at(std::size_t(1))->toList();
    position = {p[0].toNumber(), p[1].toNumber(), p[2].toNumber()};
    // A script may remove the other collider.
    if (Leaf* ground = g.scene.find("ground")) g.scene.remove(*ground);
  });
  g.step();
  // The ground was removed at the first of four contact points.
  CHECK(others == std::vector<std::string>{"/usr/scene/ground"});
  CHECK(depth == Approx(0.01).margin(1e-6));
  CHECK(std::abs(position.x()) == Approx(0.5).margin(1e-6));
  g.step(3);
  CHECK(others.size() == 1);
}

TEST_CASE("a ScriptHandler emits an event for each contact point until it is removed") {
  Ground g;
  Leaf& handler = g.collider().create("ScriptHandler");
  int events = 0, removeAt = 0;
  g.kernel.events().channel("collide").add(handler, [&](Leaf& self, const Event&) {
    if (++events == removeAt) self.parent()->remove(self);
  });
  g.step();
  CHECK(events == 4);
  removeAt = 6;
  g.step(2);
  CHECK(events == 6);
}

TEST_CASE("a Lua script can handle collisions") {
  Ground g;
  scripts(g.kernel).attachText(g.collider().create("ScriptHandler"), R"(
    self:on("collide", function(self, event)
      local other, position, depth = table.unpack(event.data)
      print(self.path, "met", other, depth > 0)
    end)
  )",
                               "test", true);
  g.step();
  CHECK_THAT(g.text,
             Catch::Contains("ScriptHandler") && Catch::Contains("met") && Catch::Contains("/usr/scene/ground"));
}

TEST_CASE("bodies that are connected by a joint do not collide") {
  PhysicsHost host;
  Node& a = host.box("a", {0, 0, 5}, {1, 1, 1});
  Node& b = host.box("b", {0.5, 0, 5}, {1, 1, 1});
  auto& seen = *a.find("collider")->asNode()->create("RecorderHandler").as<ICollisionRecorder>();
  Leaf& joint = b.create("HingeJoint");
  host.call(joint, "attach", {"../body", "../../a/body"});
  host.step();
  CHECK(seen.colliders().empty());
  b.remove(joint);
  host.step();
  CHECK(seen.colliders().size() == 1);
}

TEST_CASE("handlers of an engine that finds contacts within its step see those of one that is given them") {
  // Two boxes that fall on the ground and on each other, step by step: place, and what the handlers of one got.
  const auto fall = [](const char* engine) {
    Ground g;
    g.kernel.plugins().scan(pluginFolder().parent_path() / "tests" / "engine-plugins");
    g.kernel.plugins().use("point-masses");
    g.kernel.plugins().use("late-contacts");
    g.kernel.registerClass<CountingHandler>();
    Node& server = g.kernel.root().require<Node>("/sys/server/physics");
    setProperty(server, "measureForces", true);
    // Sleep asks for the contacts of the step before where they appear within the step.
    setProperty(*g.scene.child("world"), "autoDisableFlag", false);
    server.remove(*server.child("engine"));
    server.create(engine, "engine");
    auto& counts = static_cast<CountingHandler&>(g.collider().create("CountingHandler"));
    g.box("upper", {0.1, 0, 1.6}, {1, 1, 1});
    auto& recorder = g.scene.require<Node>("upper/collider").create("RecorderHandler");
    g.scene.require<Node>("upper/collider").create("ContactJointHandler");
    std::vector<double> out;
    for (int i = 0; i < 60; ++i) {
      g.step();
      for (const char* const name : {"box", "upper"})
        out.push_back(Ground::body(g.scene.require<Node>(name)).state().position.z());
      for (const int n : {counts.direct, counts.symmetric, counts.solved}) out.push_back(n);
      out.push_back(counts.force.z());
      out.push_back(static_cast<double>(recorder.as<ICollisionRecorder>()->colliders().size()));
      out.push_back(static_cast<double>(server.as<IPhysicsServer>()->contacts().size()));
      for (const engine::Contact& c : server.as<IPhysicsServer>()->contacts()) out.push_back(c.forceOnA.z());
    }
    return out;
  };
  const std::vector<double> given = fall("PointMassEngine");
  const std::vector<double> late = fall("LateEngine");
  CHECK(given == late);
  CHECK(given.size() > 60 * 8 + 100);
}
