#include "physics_house.h"

using namespace spark;
using namespace spark::test;

namespace {

void make(Node& at, const std::string& name) {
  const auto call = PhysicsHouse::call;
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

/// A recorder at the thing's collider.
ICollisionRecorder& record(Node& t) {
  return *t.find("collider")->asNode()->create("RecorderHandler").as<ICollisionRecorder>();
}

}  // namespace

TEST_CASE("every pair of colliders touches, plain and inside a transform collider, moving on static") {
  auto grounds = kSolids;
  grounds.push_back("plane");
  for (const auto& upper : kSolids)
    for (const auto& lower : grounds)
      for (const bool inside : {false, true}) {
        PhysicsHouse house;
        INFO(upper << (inside ? " in a transform collider" : "") << " on " << lower);
        Node& t = house.thing("upper", {0.02, 0.03, 0.98});
        if (inside) {
          Node& outer = *t.create("TransformCollider", "collider").asNode();
          make(outer, upper);
          house.call(*outer.find("collider"), "setLocalPosition", {0.0, 0.0, 1.0});
          t.as<Transform>()->setLocalPos({0.02f, 0.03f, -0.02f});
        } else {
          make(t, upper);
        }
        Node& ground = house.transform(house.scene, "lower", {0, 0, 0});
        make(ground, lower);
        auto& seen = record(t);
        house.step();
        REQUIRE(seen.colliders().size() == 1);
        CHECK(seen.colliders()[0].get() == ground.find("collider"));
      }
}

TEST_CASE("a collider returns its shape and the pose below its transform, wherever the body is") {
  PhysicsHouse house;
  Node& t = house.thing("thing", {1, 2, 3});
  Node& outer = *t.create("TransformCollider", "outer").asNode();
  Leaf& inner = outer.create("SphereCollider", "inner");
  house.call(inner, "setRadius", {0.25});
  house.call(inner, "setLocalPosition", {0.0, 0.0, 1.0});
  house.call(outer, "setLocalPosition", {0.5, 0.0, 0.0});
  house.step(5);
  const auto& sphere = *inner.as<ICollider>();
  REQUIRE(sphere.shape());
  CHECK(sphere.shape()->shape == engine::Shape::sphere);
  CHECK(sphere.shape()->radius == 0.25);
  CHECK((sphere.poseInTransform().position - Vec3(0.5, 0, 1)).norm() < 1e-9);
  CHECK_FALSE(outer.as<ICollider>()->shape());
}

TEST_CASE("bounds are where the shape is") {
  PhysicsHouse house;
  Vec3 low, high;
  for (const auto& name : kSolids) {
    INFO(name);
    Node& t = house.thing(name, {1, 2, 3});
    make(t, name);
    collider(t).bounds(low, high);
    CHECK(high.z() == Approx(3.5));
    CHECK(low.z() == Approx(2.5));
    CHECK(high.x() == Approx(name == "capsule" ? 1.3 : 1.5));
    t.as<Transform>()->setLocalRotationDeg(0, 90, 0);
    house.body(t).setPose(toPose(t.as<Transform>()->worldNow()));
    collider(t).bounds(low, high);
    CHECK(high.x() == Approx(1.5).epsilon(1e-5));
    CHECK(high.z() == Approx(name == "capsule" ? 3.3 : 3.5).epsilon(1e-5));
  }
  Node& ground = house.transform(house.scene, "plane", {0, 0, 0});
  make(ground, "plane");
  collider(ground).bounds(low, high);
  CHECK(high.z() == HUGE_VAL);
  CHECK(low.x() == -HUGE_VAL);
  Node& probe = house.transform(house.scene, "probe", {0, 0, 5});
  house.call(probe.create("RayCollider", "collider"), "setParams", {0.0, 0.0, 0.0, 0.0, 0.0, -2.0, 3.0});
  collider(probe).bounds(low, high);
  CHECK(low.z() == Approx(2));
  CHECK(high.z() == Approx(5));
}

TEST_CASE("point depths are above 0 inside and below 0 outside, in the transform's frame") {
  PhysicsHouse house;
  for (const auto& name : kSolids) {
    if (name == "mesh") continue;
    INFO(name);
    Node& t = house.transform(house.scene, name, {5, 0, 0});
    make(t, name);
    Leaf& c = *t.find("collider");
    CHECK(house.call(c, "getPointDepth", {0.0, 0.0, 0.0}).toNumber() == Approx(name == "capsule" ? 0.3 : 0.5));
    CHECK(house.call(c, "getPointDepth", {0.0, 0.0, 0.4}).toNumber() == Approx(0.1));
    CHECK(house.call(c, "getPointDepth", {0.0, 0.0, 2.0}).toNumber() == Approx(-1.5));
  }
  Node& ground = house.transform(house.scene, "plane", {0, 0, 1});
  make(ground, "plane");
  CHECK(house.call(*ground.find("collider"), "getPointDepth", {0.0, 0.0, 0.0}).toNumber() == Approx(-0.5));
}

TEST_CASE("shapes read back what was set and keep it when the new one is refused") {
  PhysicsHouse house;
  Node& t = house.thing("t", {0, 0, 0});
  Leaf& box = t.create("BoxCollider");
  house.call(box, "setBoxLengths", {1.0, 2.0, 3.0});
  CHECK(house.call(box, "getBoxLength", {1}).toNumber() == 2);
  CHECK_THROWS_WITH(house.call(box, "getBoxLength", {3}), Catch::Contains("axis 0, 1 or 2"));
  CHECK_THROWS(house.call(box, "setBoxLengths", {1.0, std::nan(""), 3.0}));
  CHECK(house.call(box, "getBoxLength", {1}).toNumber() == 2);
  house.call(box, "addSCFreezeJointEffName", {"rae1"});
  CHECK(getProperty(box, "freezeJointEffectors").toList().size() == 1);
  Leaf& capsule = t.create("CapsuleCollider");
  house.call(capsule, "setRadius", {0.4});
  house.call(capsule, "setLength", {0.7});
  CHECK(house.call(capsule, "getRadius").toNumber() == 0.4);
  CHECK(house.call(capsule, "getLength").toNumber() == 0.7);
  CHECK_THROWS_WITH(house.call(capsule, "setParams", {0.4}), Catch::Contains("setParams"));
  Leaf& plane = t.create("PlaneCollider");
  house.call(plane, "setParams", {0.0, 0.0, 2.0, 0.0, 0.0, 3.0});
  CHECK_THROWS_WITH(house.call(plane, "setParams", {0.0, 0.0, 2.0}), Catch::Contains("4 numbers"));
  CHECK_THROWS_WITH(house.call(plane, "setParams", {0.0, 0.0, 0.0, 1.0}), Catch::Contains("normal"));
  Leaf& mesh = t.create("TriMeshCollider");
  CHECK_THROWS_WITH(house.call(mesh, "setTriangles", {0, 1, 2}), Catch::Contains("Set the vertices first"));
}

TEST_CASE("a plane as point and normal is the plane") {
  PhysicsHouse house;
  house.call(house.scene.create("PlaneCollider"), "setParams", {0.0, 0.0, 2.0, 0.0, 0.0, 3.0});
  Node& t = house.box("box", {0, 0, 2.4}, {1, 1, 1});
  auto& seen = record(t);
  house.step();
  CHECK(seen.colliders().size() == 1);
}

TEST_CASE("accepted classes without geometry are made and touch nothing") {
  PhysicsHouse house;
  auto& seen = record(house.box("box", {0, 0, 1}, {1, 1, 1}));
  for (const char* name : {"ConvexCollider", "ConcaveCollider", "CompoundCollider", "EmptyCollider", "ConeCollider"}) {
    Node& c = *house.scene.create(name).asNode();
    house.call(c, "setPosition", {0.0, 0.0, 1.0});
    house.call(c, "addNotCollideWithColliderName", {"x", true});
    auto& own = c.create<ICollisionRecorder>("RecorderHandler", "");
    house.step();
    INFO(name);
    CHECK(seen.colliders().empty());
    CHECK(own.colliders().empty());
  }
  // One with a shape in the same place does.
  house.call(house.scene.create("SphereCollider"), "setPosition", {0.0, 0.0, 1.0});
  house.step();
  CHECK(seen.colliders().size() == 1);
}

TEST_CASE("a collider belongs to the body before it, not to one after it") {
  PhysicsHouse house;
  Node& t = house.transform(house.scene, "t", {0, 0, 5});
  Leaf& before = t.create("BoxCollider", "before");
  t.create("RigidBody", "body");
  Leaf& after = t.create("BoxCollider", "after");
  CHECK(before.as<ICollider>()->body() == nullptr);
  CHECK(after.as<ICollider>()->body() == t.find<IRigidBody>("body"));
}

TEST_CASE(
    "positions: in the transform's frame, in the world for a static collider's local position, offsets on bodies") {
  PhysicsHouse house;
  Node& t = house.transform(house.scene, "t", {1, 0, 0});
  Leaf& c = t.create("SphereCollider", "collider");
  Vec3 low, high;
  const auto center = [&](Leaf& leaf) -> Vec3 {
    leaf.as<ICollider>()->bounds(low, high);
    return (low + high) / 2;
  };
  house.call(c, "setPosition", {0.0, 2.0, 0.0});
  CHECK(center(c).isApprox(Vec3(1, 2, 0), 1e-6));
  house.call(c, "setLocalPosition", {0.0, 2.0, 0.0});
  CHECK(center(c).isApprox(Vec3(0, 2, 0), 1e-6));
  t.as<Transform>()->setLocalPos({4, 0, 0});
  house.step();
  CHECK(center(c).isApprox(Vec3(3, 2, 0), 1e-6));
  Leaf& box = t.create("BoxCollider");
  house.call(box, "setBoxLengths", {2.0, 1.0, 1.0});
  house.call(box, "setRotation", {0.0, 0.0, 0.0, 0.0, 0.0, 90.0});
  center(box);
  CHECK(high.y() == Approx(1).epsilon(1e-5));
  CHECK_THROWS_WITH(house.call(box, "setRotation", {45, 0, 0}), Catch::Contains("6 numbers"));
}

TEST_CASE("colliders join the nearest space above, else the scene's first, else the world's own") {
  for (const bool nested : {true, false}) {
    PhysicsHouse house;
    Node& group =
        nested ? *house.scene.create("Space", "group").asNode() : house.transform(house.scene, "group", {0, 0, 0});
    if (nested) house.call(group, "disableInnerCollision", {true});
    for (const char* name : {"a", "b"}) {
      Node& t = house.transform(group, name, {0, 0, 0});
      t.create("RigidBody", "body");
      make(t, "box");
    }
    auto& a = record(*group.find("a")->asNode());
    Node& other = house.box("other", {0.5, 0, 0}, {1, 1, 1});
    auto& o = record(other);
    house.step();
    CHECK(a.colliders().size() == (nested ? 1 : 2));
    CHECK(o.colliders().size() == 2);
  }
  PhysicsHouse house;
  house.scene.remove(*house.scene.find("space"));
  Node& a = house.box("a", {0, 0, 0}, {1, 1, 1});
  house.box("b", {0, 0, 0.5}, {1, 1, 1});
  auto& seen = record(a);
  house.step();
  CHECK(seen.colliders().size() == 1);
}

TEST_CASE("excluded colliders do not collide, from either side, until they are allowed again") {
  PhysicsHouse house;
  Node& a = house.box("a", {0, 0, 0}, {1, 1, 1});
  Node& b = house.box("b", {0, 0, 0.5}, {1, 1, 1});
  b.find("collider")->setName("torso");
  auto& seen = record(a);
  for (int round = 0; round < 2; ++round) {
    Leaf& speaker = round == 0 ? *a.find("collider") : *b.find("torso");
    const char* named = round == 0 ? "torso" : "collider";
    house.call(speaker, "addNotCollideWithColliderName", {named, true});
    seen.clear();
    house.step();
    CHECK(seen.colliders().empty());
    house.call(speaker, "addNotCollideWithColliderName", {named, false});
    seen.clear();
    house.step();
    CHECK(seen.colliders().size() == 1);
  }
}

TEST_CASE("a ray calls its handlers and pushes nothing") {
  PhysicsHouse house;
  Node& carrier = house.thing("carrier", {0, 0, 3});
  house.call(*carrier.find("body"), "useGravity", {false});
  house.call(carrier.create("RayCollider", "collider"), "setParams", {0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 5.0});
  auto& seen = record(carrier);
  house.scene.create("PlaneCollider", "ground");
  house.step(5);
  CHECK(seen.colliders().size() == 1);
  CHECK(house.body(carrier).state().position.isApprox(Vec3(0, 0, 3), 1e-9));
}

namespace {
/// A node with a group, and `n` unit boxes that fall, one inside the other, made in it.
struct Crowd {
  Crowd(PhysicsHouse& house, const std::string& name, int n) : node(house.transform(house.scene, name, {0, 0, 0})) {
    group = &node.create("CollisionGroup", "group");
    for (int i = 0; i < n; ++i) {
      Node& t = house.transform(node, "box" + std::to_string(i), {0, 0, 0.6});
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

TEST_CASE("a detached group touches itself and what does not move, nothing else") {
  PhysicsHouse house;
  Node& ground = house.transform(house.scene, "ground", {0, 0, 0});
  house.call(ground.create("PlaneCollider", "collider"), "setParams", {0.0, 0.0, 1.0, 0.0});
  Crowd a(house, "a", 1), b(house, "b", 2);
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

  SECTION("attached: all collide with each other") {
    house.step();
    CHECK(touched(0) == Names{"box0", "box1", "ground"});
    CHECK(touched(1) == Names{"box0", "box1", "ground"});
  }
  SECTION("one detached: the other goes without it, too") {
    setProperty(*b.group, "detached", true);
    house.step();
    CHECK(touched(0) == Names{"ground"});
    CHECK(touched(1) == Names{"box1", "ground"});
    CHECK(touched(2) == Names{"box0", "ground"});
    for (auto* s : seen) s->clear();
    setProperty(*b.group, "detached", false);
    for (Node* box : {a.boxes[0], b.boxes[0], b.boxes[1]}) house.body(*box).setPose({{0, 0, 0.49}, Mat3::Identity()});
    house.step();
    CHECK(touched(0) == Names{"box0", "box1", "ground"});
  }
}

TEST_CASE("a detached group alone on the ground moves as it would without one, to the bit") {
  const auto fall = [](bool grouped) {
    PhysicsHouse house;
    Node& ground = house.transform(house.scene, "ground", {0, 0, 0});
    house.call(ground.create("PlaneCollider", "collider"), "setParams", {0.0, 0.0, 1.0, 0.0});
    Crowd c(house, "c", 2);
    if (grouped)
      setProperty(*c.group, "detached", true);
    else
      c.node.remove(*c.group);
    house.step(100);
    const engine::BodyState s = house.body(*c.boxes[1]).state();
    return std::vector<double>{s.position.x(),   s.position.y(),   s.position.z(),
                               s.rotation(0, 1), s.rotation(1, 2), s.linearVelocity.z()};
  };
  CHECK(fall(true) == fall(false));
}
