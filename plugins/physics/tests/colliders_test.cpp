#include "physics_house.h"

using namespace spark;
using namespace spark::test;

namespace {

void make(Node& at, const std::string& name) {
  const auto call = PhysicsHost::call;
  if (name == "box") call(at.create("BoxCollider", "collider"), "setBoxLengths", {1.0, 1.0, 1.0});
  if (name == "sphere") call(at.create("SphereCollider", "collider"), "setRadius", {0.5});
  if (name == "capsule") call(at.create("CapsuleCollider", "collider"), "setParams", {0.3, 0.4});
  if (name == "cylinder") call(at.create("CylinderCollider", "collider"), "setParams", {0.5, 1.0});
  if (name == "plane") call(at.create("PlaneCollider", "collider"), "setParams", {0.0, 0.0, 1.0, 0.5});
  if (name == "mesh") {
    Leaf& m = at.create("TriMeshCollider", "collider");
    const double h = 0.5;
    call(m, "setVertices", {-h, -h, -h, h, -h, -h, h, h, -h, -h, h, -h, -h, -h, h, h, -h, h, h, h, h, -h, h, h});
    call(m, "setTriangles",
         {0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4, 1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7});
  }
}
const std::vector<std::string> kSolids{"box", "sphere", "capsule", "cylinder", "mesh"};

ICollider& collider(Node& t) { return t.require<ICollider>("collider"); }

/// Adds a recorder to the collider of a transform.
ICollisionRecorder& record(Node& t) {
  return *t.find("collider")->asNode()->create("RecorderHandler").as<ICollisionRecorder>();
}

}  // namespace

TEST_CASE("each moving collider touches each static one, plain and inside a transform collider") {
  auto grounds = kSolids;
  grounds.push_back("plane");
  for (const auto& upper : kSolids)
    for (const auto& lower : grounds)
      for (const bool inside : {false, true}) {
        PhysicsHost host;
        INFO(upper << (inside ? " in a transform collider" : "") << " on " << lower);
        Node& t = host.thing("upper", {0.02, 0.03, 0.98});
        if (inside) {
          Node& outer = *t.create("TransformCollider", "collider").asNode();
          make(outer, upper);
          host.call(*outer.find("collider"), "setLocalPosition", {0.0, 0.0, 1.0});
          t.as<Transform>()->setLocalPos({0.02f, 0.03f, -0.02f});
        } else {
          make(t, upper);
        }
        Node& ground = host.transform(host.scene, "lower", {0, 0, 0});
        make(ground, lower);
        auto& seen = record(t);
        host.step();
        REQUIRE(seen.colliders().size() == 1);
        CHECK(seen.colliders()[0].get() == ground.find("collider"));
      }
}

TEST_CASE("a collider returns its shape and its pose relative to its transform, also after the body has moved") {
  PhysicsHost host;
  Node& t = host.thing("thing", {1, 2, 3});
  Node& outer = *t.create("TransformCollider", "outer").asNode();
  Leaf& inner = outer.create("SphereCollider", "inner");
  host.call(inner, "setRadius", {0.25});
  host.call(inner, "setLocalPosition", {0.0, 0.0, 1.0});
  host.call(outer, "setLocalPosition", {0.5, 0.0, 0.0});
  host.step(5);
  const auto& sphere = *inner.as<ICollider>();
  REQUIRE(sphere.shape());
  CHECK(sphere.shape()->shape == engine::Shape::sphere);
  CHECK(sphere.shape()->radius == 0.25);
  CHECK((sphere.poseInTransform().position - Vec3(0.5, 0, 1)).norm() < 1e-9);
  CHECK_FALSE(outer.as<ICollider>()->shape());
}

TEST_CASE("bounds enclose the shape at its current pose") {
  PhysicsHost host;
  Vec3 low, high;
  for (const auto& name : kSolids) {
    INFO(name);
    Node& t = host.thing(name, {1, 2, 3});
    make(t, name);
    collider(t).bounds(low, high);
    CHECK(high.z() == Approx(3.5));
    CHECK(low.z() == Approx(2.5));
    CHECK(high.x() == Approx(name == "capsule" ? 1.3 : 1.5));
    t.as<Transform>()->setLocalRotationDeg(0, 90, 0);
    host.body(t).setPose(toPose(t.as<Transform>()->worldNow()));
    collider(t).bounds(low, high);
    CHECK(high.x() == Approx(1.5).epsilon(1e-5));
    CHECK(high.z() == Approx(name == "capsule" ? 3.3 : 3.5).epsilon(1e-5));
  }
  Node& ground = host.transform(host.scene, "plane", {0, 0, 0});
  make(ground, "plane");
  collider(ground).bounds(low, high);
  CHECK(high.z() == HUGE_VAL);
  CHECK(low.x() == -HUGE_VAL);
  Node& probe = host.transform(host.scene, "probe", {0, 0, 5});
  host.call(probe.create("RayCollider", "collider"), "setParams", {0.0, 0.0, 0.0, 0.0, 0.0, -2.0, 3.0});
  collider(probe).bounds(low, high);
  CHECK(low.z() == Approx(2));
  CHECK(high.z() == Approx(5));
}

TEST_CASE("point depths are positive inside and negative outside, in the transform's frame") {
  PhysicsHost host;
  for (const auto& name : kSolids) {
    if (name == "mesh") continue;
    INFO(name);
    Node& t = host.transform(host.scene, name, {5, 0, 0});
    make(t, name);
    Leaf& c = *t.find("collider");
    CHECK(host.call(c, "getPointDepth", {0.0, 0.0, 0.0}).toNumber() == Approx(name == "capsule" ? 0.3 : 0.5));
    CHECK(host.call(c, "getPointDepth", {0.0, 0.0, 0.4}).toNumber() == Approx(0.1));
    CHECK(host.call(c, "getPointDepth", {0.0, 0.0, 2.0}).toNumber() == Approx(-1.5));
  }
  Node& ground = host.transform(host.scene, "plane", {0, 0, 1});
  make(ground, "plane");
  CHECK(host.call(*ground.find("collider"), "getPointDepth", {0.0, 0.0, 0.0}).toNumber() == Approx(-0.5));
}

TEST_CASE("a collider returns the shape that was set, and keeps it if a new one is refused") {
  PhysicsHost host;
  Node& t = host.thing("t", {0, 0, 0});
  Leaf& box = t.create("BoxCollider");
  host.call(box, "setBoxLengths", {1.0, 2.0, 3.0});
  CHECK(host.call(box, "getBoxLength", {1}).toNumber() == 2);
  CHECK_THROWS_WITH(host.call(box, "getBoxLength", {3}), Catch::Contains("axis 0, 1 or 2"));
  CHECK_THROWS(host.call(box, "setBoxLengths", {1.0, std::nan(""), 3.0}));
  CHECK(host.call(box, "getBoxLength", {1}).toNumber() == 2);
  host.call(box, "addSCFreezeJointEffName", {"rae1"});
  CHECK(getProperty(box, "freezeJointEffectors").toList().size() == 1);
  Leaf& capsule = t.create("CapsuleCollider");
  host.call(capsule, "setRadius", {0.4});
  host.call(capsule, "setLength", {0.7});
  CHECK(host.call(capsule, "getRadius").toNumber() == 0.4);
  CHECK(host.call(capsule, "getLength").toNumber() == 0.7);
  CHECK_THROWS_WITH(host.call(capsule, "setParams", {0.4}), Catch::Contains("setParams"));
  Leaf& plane = t.create("PlaneCollider");
  host.call(plane, "setParams", {0.0, 0.0, 2.0, 0.0, 0.0, 3.0});
  CHECK_THROWS_WITH(host.call(plane, "setParams", {0.0, 0.0, 2.0}), Catch::Contains("4 numbers"));
  CHECK_THROWS_WITH(host.call(plane, "setParams", {0.0, 0.0, 0.0, 1.0}), Catch::Contains("normal"));
  Leaf& mesh = t.create("TriMeshCollider");
  CHECK_THROWS_WITH(host.call(mesh, "setTriangles", {0, 1, 2}), Catch::Contains("Set the vertices first"));
}

TEST_CASE("a plane can be given as a point and a normal") {
  PhysicsHost host;
  host.call(host.scene.create("PlaneCollider"), "setParams", {0.0, 0.0, 2.0, 0.0, 0.0, 3.0});
  Node& t = host.box("box", {0, 0, 2.4}, {1, 1, 1});
  auto& seen = record(t);
  host.step();
  CHECK(seen.colliders().size() == 1);
}

TEST_CASE("colliders of classes without geometry can be created and touch nothing") {
  PhysicsHost host;
  auto& seen = record(host.box("box", {0, 0, 1}, {1, 1, 1}));
  for (const char* name : {"ConvexCollider", "ConcaveCollider", "CompoundCollider", "EmptyCollider", "ConeCollider"}) {
    Node& c = *host.scene.create(name).asNode();
    host.call(c, "setPosition", {0.0, 0.0, 1.0});
    host.call(c, "addNotCollideWithColliderName", {"x", true});
    auto& own = c.create<ICollisionRecorder>("RecorderHandler", "");
    host.step();
    INFO(name);
    CHECK(seen.colliders().empty());
    CHECK(own.colliders().empty());
  }
  // A collider with a shape at the same position does.
  host.call(host.scene.create("SphereCollider"), "setPosition", {0.0, 0.0, 1.0});
  host.step();
  CHECK(seen.colliders().size() == 1);
}

TEST_CASE("a collider belongs to the sibling body before it, not to one after it") {
  PhysicsHost host;
  Node& t = host.transform(host.scene, "t", {0, 0, 5});
  Leaf& before = t.create("BoxCollider", "before");
  t.create("RigidBody", "body");
  Leaf& after = t.create("BoxCollider", "after");
  CHECK(before.as<ICollider>()->body() == nullptr);
  CHECK(after.as<ICollider>()->body() == t.find<IRigidBody>("body"));
}

TEST_CASE(
    "setPosition and setRotation are relative to the transform, and setLocalPosition of a static collider is in the "
    "world frame") {
  PhysicsHost host;
  Node& t = host.transform(host.scene, "t", {1, 0, 0});
  Leaf& c = t.create("SphereCollider", "collider");
  Vec3 low, high;
  const auto center = [&](Leaf& leaf) -> Vec3 {
    leaf.as<ICollider>()->bounds(low, high);
    return (low + high) / 2;
  };
  host.call(c, "setPosition", {0.0, 2.0, 0.0});
  CHECK(center(c).isApprox(Vec3(1, 2, 0), 1e-6));
  host.call(c, "setLocalPosition", {0.0, 2.0, 0.0});
  CHECK(center(c).isApprox(Vec3(0, 2, 0), 1e-6));
  t.as<Transform>()->setLocalPos({4, 0, 0});
  host.step();
  CHECK(center(c).isApprox(Vec3(3, 2, 0), 1e-6));
  Leaf& box = t.create("BoxCollider");
  host.call(box, "setBoxLengths", {2.0, 1.0, 1.0});
  host.call(box, "setRotation", {0.0, 0.0, 0.0, 0.0, 0.0, 90.0});
  center(box);
  CHECK(high.y() == Approx(1).epsilon(1e-5));
  CHECK_THROWS_WITH(host.call(box, "setRotation", {45, 0, 0}), Catch::Contains("6 numbers"));
}

TEST_CASE("a collider joins the nearest space above, otherwise the scene's first one, otherwise the world's own") {
  for (const bool nested : {true, false}) {
    PhysicsHost host;
    Node& group =
        nested ? *host.scene.create("Space", "group").asNode() : host.transform(host.scene, "group", {0, 0, 0});
    if (nested) host.call(group, "disableInnerCollision", {true});
    for (const char* name : {"a", "b"}) {
      Node& t = host.transform(group, name, {0, 0, 0});
      t.create("RigidBody", "body");
      make(t, "box");
    }
    auto& a = record(*group.find("a")->asNode());
    Node& other = host.box("other", {0.5, 0, 0}, {1, 1, 1});
    auto& o = record(other);
    host.step();
    CHECK(a.colliders().size() == (nested ? 1 : 2));
    CHECK(o.colliders().size() == 2);
  }
  PhysicsHost host;
  host.scene.remove(*host.scene.find("space"));
  Node& a = host.box("a", {0, 0, 0}, {1, 1, 1});
  host.box("b", {0, 0, 0.5}, {1, 1, 1});
  auto& seen = record(a);
  host.step();
  CHECK(seen.colliders().size() == 1);
}

TEST_CASE("an excluded pair does not collide until it is allowed again, by either of its colliders") {
  PhysicsHost host;
  Node& a = host.box("a", {0, 0, 0}, {1, 1, 1});
  Node& b = host.box("b", {0, 0, 0.5}, {1, 1, 1});
  b.find("collider")->setName("torso");
  auto& seen = record(a);
  for (int round = 0; round < 2; ++round) {
    Leaf& excluding = round == 0 ? *a.find("collider") : *b.find("torso");
    const char* named = round == 0 ? "torso" : "collider";
    host.call(excluding, "addNotCollideWithColliderName", {named, true});
    seen.clear();
    host.step();
    CHECK(seen.colliders().empty());
    host.call(excluding, "addNotCollideWithColliderName", {named, false});
    seen.clear();
    host.step();
    CHECK(seen.colliders().size() == 1);
  }
}

TEST_CASE("a ray calls its handlers and exerts no force") {
  PhysicsHost host;
  Node& carrier = host.thing("carrier", {0, 0, 3});
  host.call(*carrier.find("body"), "useGravity", {false});
  host.call(carrier.create("RayCollider", "collider"), "setParams", {0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 5.0});
  auto& seen = record(carrier);
  host.scene.create("PlaneCollider", "ground");
  host.step(5);
  CHECK(seen.colliders().size() == 1);
  CHECK(host.body(carrier).state().position.isApprox(Vec3(0, 0, 3), 1e-9));
}

namespace {
/// A node with a collision group and `n` overlapping unit boxes that fall.
struct Crowd {
  Crowd(PhysicsHost& host, const std::string& name, int n) : node(host.transform(host.scene, name, {0, 0, 0})) {
    group = &node.create("CollisionGroup", "group");
    for (int i = 0; i < n; ++i) {
      Node& t = host.transform(node, "box" + std::to_string(i), {0, 0, 0.6});
      t.create("RigidBody", "body");
      make(t, "box");
      boxes.push_back(&t);
    }
  }
  Node& node;
  Leaf* group;
  std::vector<Node*> boxes;
};
}  // namespace

TEST_CASE("a detached group collides only with itself and with static colliders") {
  PhysicsHost host;
  Node& ground = host.transform(host.scene, "ground", {0, 0, 0});
  host.call(ground.create("PlaneCollider", "collider"), "setParams", {0.0, 0.0, 1.0, 0.0});
  Crowd a(host, "a", 1), b(host, "b", 2);
  std::vector<ICollisionRecorder*> seen;
  for (Node* box : {a.boxes[0], b.boxes[0], b.boxes[1]}) {
    seen.push_back(&record(*box));
    box->find("collider")->asNode()->create("ContactJointHandler");
  }
  const auto touched = [&](std::size_t i) {
    std::vector<std::string> names;
    for (const auto& c : seen[i]->colliders()) names.push_back(c->parent()->name());
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return names;
  };
  using Names = std::vector<std::string>;
  for (Node* box : {a.boxes[0], b.boxes[0], b.boxes[1]}) box->as<Transform>()->setLocalPos({0, 0, 0.49f});

  SECTION("without a detached group all collide with each other") {
    host.step();
    CHECK(touched(0) == Names{"box0", "box1", "ground"});
    CHECK(touched(1) == Names{"box0", "box1", "ground"});
  }
  SECTION("the other group does not collide with a detached one either") {
    setProperty(*b.group, "detached", true);
    host.step();
    CHECK(touched(0) == Names{"ground"});
    CHECK(touched(1) == Names{"box1", "ground"});
    CHECK(touched(2) == Names{"box0", "ground"});
    for (auto* s : seen) s->clear();
    setProperty(*b.group, "detached", false);
    for (Node* box : {a.boxes[0], b.boxes[0], b.boxes[1]}) host.body(*box).setPose({{0, 0, 0.49}, Mat3::Identity()});
    host.step();
    CHECK(touched(0) == Names{"box0", "box1", "ground"});
  }
}

TEST_CASE("a detached group alone on the ground moves as without a group, bit for bit") {
  const auto fall = [](bool grouped) {
    PhysicsHost host;
    Node& ground = host.transform(host.scene, "ground", {0, 0, 0});
    host.call(ground.create("PlaneCollider", "collider"), "setParams", {0.0, 0.0, 1.0, 0.0});
    Crowd c(host, "c", 2);
    if (grouped)
      setProperty(*c.group, "detached", true);
    else
      c.node.remove(*c.group);
    host.step(100);
    const engine::BodyState s = host.body(*c.boxes[1]).state();
    return std::vector<double>{s.position.x(),   s.position.y(),   s.position.z(),
                               s.rotation(0, 1), s.rotation(1, 2), s.linearVelocity.z()};
  };
  CHECK(fall(true) == fall(false));
}
