#include <atomic>
#include <thread>

#include "physics_house.h"

using namespace spark;
using namespace spark::test;

TEST_CASE("a transform that is set moves the bodies and static colliders below it before the next step") {
  PhysicsHost host;
  Node& robot = host.transform(host.scene, "robot", {0, 0, 5});
  Node& torso = host.transform(robot, "torso", {0, 0, 1});
  torso.create("RigidBody", "body");
  Node& wall = host.transform(robot, "wall", {1, 0, 0});
  Leaf& box = wall.create("BoxCollider");
  host.step(3);
  const double fallen = host.body(torso).state().position.z();
  CHECK(fallen < 6);
  robot.as<Transform>()->setLocalPos({10, 0, 5});
  host.kernel.events().channel("physics").emit(Event{"physics", 0, 0.02, 0, nullptr});
  CHECK(host.body(torso).state().position.x() == Approx(10));
  CHECK(host.body(torso).state().position.z() == Approx(fallen).margin(0.1));
  Vec3 low, high;
  box.as<ICollider>()->bounds(low, high);
  CHECK(low.x() == Approx(10.5));
  host.kernel.events().channel("place").emit(Event{"place", 0, 0.02, 0, nullptr});
  CHECK(host.world(torso).x() == Approx(10));
}

TEST_CASE("rotating a transform rotates the body below it") {
  PhysicsHost host;
  Node& outer = host.transform(host.scene, "outer", {0, 0, 0});
  Node& t = host.transform(outer, "t", {1, 0, 0});
  t.create("RigidBody", "body");
  host.call(*t.find("body"), "useGravity", {false});
  host.step();
  outer.as<Transform>()->setLocalRotationDeg(0, 0, 90);
  host.step();
  CHECK(host.body(t).state().position.isApprox(Vec3(0, 1, 0), 1e-5));
  CHECK(host.body(t).state().rotation(1, 0) == Approx(1));
}

TEST_CASE("a body whose transform is moved keeps its velocity and continues from the new position") {
  PhysicsHost host;
  Node& t = host.thing("t", {0, 0, 5});
  host.body(t).setVelocity({2, 0, 0});
  host.step();
  t.as<Transform>()->setLocalPos({0, 3, 1});
  host.step();
  CHECK(host.body(t).state().position.x() == Approx(0.04).margin(1e-4));
  CHECK(host.body(t).state().position.y() == Approx(3));
}

TEST_CASE("the transform of a sleeping body is not updated and stays the same bit for bit") {
  PhysicsHost host;
  Node& t = host.box("box", {0.1, 0.2, 0.4995}, {1, 1, 1});
  host.scene.create("PlaneCollider").asNode()->create("ContactJointHandler");
  t.find("collider")->asNode()->create("ContactJointHandler");
  for (int i = 0; i < 500 && host.body(t).enabled(); ++i) host.step();
  REQUIRE_FALSE(host.body(t).enabled());
  host.step();
  CHECK_FALSE(t.as<Transform>()->dirty());
  const Matrix before = t.as<Transform>()->local();
  host.step(5);
  CHECK(t.as<Transform>()->local() == before);
}

TEST_CASE("the server lists the bodies of a subtree in tree order") {
  PhysicsHost host;
  Node& a = host.thing("a", {0, 0, 0});
  Node& inner = host.transform(a, "inner", {0, 0, 1});
  inner.create("RigidBody", "body");
  host.thing("b", {2, 0, 0});
  auto& server = host.kernel.root().require<IPhysicsServer>("/sys/server/physics");
  std::vector<IRigidBody*> bodies;
  server.bodies(a, bodies);
  REQUIRE(bodies.size() == 2);
  CHECK(bodies[0] == a.find<IRigidBody>("body"));
  CHECK(bodies[1] == inner.find<IRigidBody>("body"));
  bodies.clear();
  server.bodies(host.scene, bodies);
  CHECK(bodies.size() == 3);
  CHECK(server.model().bodies.size() == 3);
  CHECK(server.state().bodies.size() == 3);
  host.scene.remove(*host.scene.find("world"));
  CHECK_THROWS_WITH(server.model(), Catch::Contains("has no world"));
}

TEST_CASE("adding and removing a second robot does not affect the first") {
  PhysicsHost host;
  Node& first = host.thing("first", {0, 0, 5});
  host.step(2);
  for (int i = 0; i < 3; ++i) {
    Node& second = host.box("second", {3, 0, 5}, {1, 1, 1});
    host.step();
    host.scene.remove(second);
    host.step();
  }
  CHECK(host.world(first).z() == Approx(5 - 9.81 * 0.0004 * 8 * 9 / 2).epsilon(1e-5));
}

TEST_CASE("rays and overlaps find colliders, and a ray ignores those below a given node") {
  PhysicsHost host;
  Node& near = host.box("near", {2, 0, 1}, {1, 1, 1});
  Node& far = host.box("far", {5, 0, 1}, {1, 1, 1});
  auto& server = host.kernel.root().require<IPhysicsServer>(IPhysicsServer::kPath);
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

TEST_CASE("rays and overlaps are the same for the first query at some poses and for many, in several threads") {
  PhysicsHost host;
  std::vector<Node*> boxes;
  for (int i = 0; i < 30; ++i) boxes.push_back(&host.box("box" + std::to_string(i), {2.0 + i, 0, 1}, {1, 1, 1}));
  auto& server = host.kernel.root().require<IPhysicsServer>(IPhysicsServer::kPath);
  std::vector<IRigidBody*> bodies;
  server.bodies(*boxes.front(), bodies);
  REQUIRE(bodies.size() == 1);
  std::atomic<int> wrong = 0;
  for (int move = 0; move < 20; ++move) {
    bodies[0]->setPosition({2, move % 2 == 0 ? 0.0 : 5.0, 1});
    const double expected = move % 2 == 0 ? 1.5 : 2.5;
    const std::size_t touched = move % 2 == 0 ? 2 : 1;
    std::vector<std::jthread> threads;
    for (int i = 0; i < 4; ++i)
      threads.emplace_back([&] {
        for (int query = 0; query < 50; ++query) {
          const auto hit = server.castRay({0, 0, 1}, {1, 0, 0}, 10);
          std::vector<ICollider*> found;
          server.overlaps({2.5, 0, 1}, 0.1, found);
          wrong += !hit || hit->distance != expected || found.size() != touched;
          wrong += !server.isHidden({0, 0, 1}, {9.25, 0, 1}, nullptr, nullptr);
        }
      });
  }
  CHECK(wrong == 0);
}
