#include "physics_house.h"

using namespace spark;
using namespace spark::test;

TEST_CASE("a transform moved by hand takes the bodies and static colliders below it along before the next step") {
  PhysicsHouse house;
  Node& robot = house.transform(house.scene, "robot", {0, 0, 5});
  Node& torso = house.transform(robot, "torso", {0, 0, 1});
  torso.create("RigidBody", "body");
  Node& wall = house.transform(robot, "wall", {1, 0, 0});
  Leaf& box = wall.create("BoxCollider");
  house.step(3);
  const double fallen = house.body(torso).state().position.z();
  CHECK(fallen < 6);
  robot.as<Transform>()->setLocalPos({10, 0, 5});
  house.kernel.events().channel("physics").emit(Event{"physics", 0, 0.02, 0, nullptr});
  CHECK(house.body(torso).state().position.x() == Approx(10));
  CHECK(house.body(torso).state().position.z() == Approx(fallen).margin(0.1));
  Vec3 low, high;
  box.as<ICollider>()->bounds(low, high);
  CHECK(low.x() == Approx(10.5));
  house.kernel.events().channel("place").emit(Event{"place", 0, 0.02, 0, nullptr});
  CHECK(house.world(torso).x() == Approx(10));
}

TEST_CASE("turning a transform turns the body below it") {
  PhysicsHouse house;
  Node& outer = house.transform(house.scene, "outer", {0, 0, 0});
  Node& t = house.transform(outer, "t", {1, 0, 0});
  t.create("RigidBody", "body");
  house.call(*t.find("body"), "useGravity", {false});
  house.step();
  outer.as<Transform>()->setLocalRotationDeg(0, 0, 90);
  house.step();
  CHECK(house.body(t).state().position.isApprox(Vec3(0, 1, 0), 1e-5));
  CHECK(house.body(t).state().rotation(1, 0) == Approx(1));
}

TEST_CASE("a moved body keeps its speed, and falls on from where it was put") {
  PhysicsHouse house;
  Node& t = house.thing("t", {0, 0, 5});
  house.body(t).setVelocity({2, 0, 0});
  house.step();
  t.as<Transform>()->setLocalPos({0, 3, 1});
  house.step();
  CHECK(house.body(t).state().position.x() == Approx(0.04).margin(1e-4));
  CHECK(house.body(t).state().position.y() == Approx(3));
}

TEST_CASE("a sleeping body costs no placing and its transform stays bit for bit") {
  PhysicsHouse house;
  Node& t = house.box("box", {0.1, 0.2, 0.4995}, {1, 1, 1});
  house.scene.create("PlaneCollider").asNode()->create("ContactJointHandler");
  t.find("collider")->asNode()->create("ContactJointHandler");
  for (int i = 0; i < 500 && house.body(t).enabled(); ++i) house.step();
  REQUIRE_FALSE(house.body(t).enabled());
  house.step();
  CHECK_FALSE(t.as<Transform>()->dirty());
  const Matrix before = t.as<Transform>()->local();
  house.step(5);
  CHECK(t.as<Transform>()->local() == before);
}

TEST_CASE("the server lists the bodies of a subtree in tree order") {
  PhysicsHouse house;
  Node& a = house.thing("a", {0, 0, 0});
  Node& inner = house.transform(a, "inner", {0, 0, 1});
  inner.create("RigidBody", "body");
  house.thing("b", {2, 0, 0});
  auto& server = house.kernel.root().require<IPhysicsServer>("/sys/server/physics");
  std::vector<IRigidBody*> bodies;
  server.bodies(a, bodies);
  REQUIRE(bodies.size() == 2);
  CHECK(bodies[0] == a.find<IRigidBody>("body"));
  CHECK(bodies[1] == inner.find<IRigidBody>("body"));
  bodies.clear();
  server.bodies(house.scene, bodies);
  CHECK(bodies.size() == 3);
  CHECK(server.model().bodies.size() == 3);
  CHECK(server.state().bodies.size() == 3);
  house.scene.remove(*house.scene.find("world"));
  CHECK_THROWS_WITH(server.model(), Catch::Contains("has no world"));
}

TEST_CASE("a second robot that comes and goes leaves the first as it was") {
  PhysicsHouse house;
  Node& first = house.thing("first", {0, 0, 5});
  house.step(2);
  for (int i = 0; i < 3; ++i) {
    Node& second = house.box("second", {3, 0, 5}, {1, 1, 1});
    house.step();
    house.scene.remove(second);
    house.step();
  }
  CHECK(house.world(first).z() == Approx(5 - 9.81 * 0.0004 * 8 * 9 / 2).epsilon(1e-5));
}

TEST_CASE("rays and overlaps find colliders, and nothing below the node that asks") {
  PhysicsHouse house;
  Node& near = house.box("near", {2, 0, 1}, {1, 1, 1});
  Node& far = house.box("far", {5, 0, 1}, {1, 1, 1});
  auto& server = house.kernel.root().require<IPhysicsServer>(IPhysicsServer::kPath);
  const auto hit = server.castRay({0, 0, 1}, {3, 0, 0}, 10);
  REQUIRE(hit);
  CHECK(&hit->collider->leaf() == near.find("collider"));
  CHECK(hit->distance == Approx(1.5));
  CHECK(hit->position == Vec3(1.5, 0, 1));
  CHECK(hit->normal == Vec3(-1, 0, 0));
  const auto beyond = server.castRay({0, 0, 1}, {1, 0, 0}, 10, &near);
  REQUIRE(beyond);
  CHECK(&beyond->collider->leaf() == far.find("collider"));
  CHECK_FALSE(server.castRay({0, 0, 1}, {1, 0, 0}, 1));
  CHECK_THROWS_WITH(server.castRay({0, 0, 1}, {0, 0, 0}, 1), Catch::Contains("direction longer than 0"));
  CHECK_THROWS_WITH(server.castRay({0, 0, 1}, {1, 0, 0}, std::nan("")), Catch::Contains("length of 0 or more"));
  std::vector<ICollider*> found;
  server.overlaps({3.5, 0, 1}, 1.1, found);
  CHECK(found.size() == 2);
  found.clear();
  server.overlaps({3.5, 0, 1}, 0.9, found);
  CHECK(found.empty());
}
