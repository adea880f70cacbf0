// Sensors that measure distances with rays, in a physical world.
#include <catch2/catch.hpp>

#include "api/agents.h"
#include "api/physics.h"
#include "api/scene.h"
#include "test_support.h"

using namespace spark;
using namespace spark::test;

namespace {

/// A robot at the origin that looks along y, with a body of its own around the sensor, and walls.
struct Room : TestHost {
  Room() {
    for (const char* p : {"files", "scene", "physics", "physics-ode", "gamecontrol", "sensors"})
      kernel.plugins().use(p);
    kernel.create("SceneServer", "/sys/server/scene");
    kernel.create("Scene", "/usr/scene");
    kernel.create("PhysicsServer", "/sys/server/physics");
    kernel.create("OdeCollision", "/sys/server/physics/collision");
    kernel.create("OdeEngine", "/sys/server/physics/engine");
    kernel.create("World", "/usr/scene/world");
    robot = &kernel.create<Node>("AgentAspect", "/usr/scene/robot");
    addBox(*robot, "torso", {0, 0, 0}, {0.2, 0.2, 0.2});
    head = &robot->create<Node>("Transform", "head");
  }
  Node& addBox(Node& above, const char* name, const Vec3& at, const Vec3& lengths) {
    Node& box = above.create<Node>("Transform", name);
    setProperty(box, "localPos", Value(List{at.x(), at.y(), at.z()}));
    setProperty(box.create("BoxCollider", "collider"), "boxLengths",
                Value(List{lengths.x(), lengths.y(), lengths.z()}));
    return box;
  }
  Node& wall(const char* name, const Vec3& at, const Vec3& lengths) {
    return addBox(kernel.root().require<Node>("/usr/scene"), name, at, lengths);
  }
  /// The percept, from a sense phase like that of game control.
  std::string sense(Leaf& sensor) {
    kernel.root().require<ISceneServer>("/sys/server/scene").place();
    if (const auto shared = sensor.as<ISharedView>()) shared->share(++round);
    Predicates out;
    sensor.as<Perceptor>()->sense(out, {"sense", 0, 0.02, 1, nullptr});
    return sexpOf(out);
  }
  Node *robot, *head;
  std::uint64_t round = 0;
};

}  // namespace

TEST_CASE("a distance sensor measures to the first surface that is not its own robot's", "[senses]") {
  Room room;
  Leaf& sensor = room.head->create("DistancePerceptor", "front");
  CHECK(room.sense(sensor) == "(DST (n front) (d 10.00))");
  room.wall("far", {0, 5, 0}, {1, 1, 1});
  CHECK(room.sense(sensor) == "(DST (n front) (d 4.50))");
  Node& near = room.wall("near", {0, 2, 0}, {1, 1, 1});
  CHECK(room.sense(sensor) == "(DST (n front) (d 1.50))");
  setProperty(near, "localPos", Value(List{0.0, 3.0, 0.0}));
  CHECK(room.sense(sensor) == "(DST (n front) (d 2.50))");
  setProperty(sensor, "maxRange", 2);
  CHECK(room.sense(sensor) == "(DST (n front) (d 2.00))");
  setProperty(sensor, "minRange", 3);
  setProperty(sensor, "maxRange", 5);
  CHECK(room.sense(sensor) == "(DST (n front) (d 3.00))");
  for (const auto& [min, max] : {std::pair(-5.0, 1.0), {2.0, 1.0}, {0.0, std::nan("")}}) {
    const Value range[] = {min, max};
    CHECK_THROWS_WITH(callMethod(sensor, "setRange", range), Catch::Contains("expected 0 <= min <= max [m]"));
  }
}

TEST_CASE("a lidar measures from right to left, along the directions of its fan", "[senses]") {
  Room room;
  Leaf& sensor = room.head->create("LidarPerceptor", "scan");
  setProperty(sensor, "rays", 3);
  setProperty(sensor, "fov", 180);
  room.wall("right", {3, 0, 0}, {1, 1, 1});
  room.wall("front", {0, 4, 0}, {1, 1, 1});
  CHECK(room.sense(sensor) == "(LDR (n scan) (d 2.50 3.50 10.00))");
  setProperty(sensor, "rays", 1);
  CHECK(room.sense(sensor) == "(LDR (n scan) (d 3.50))");
  // A full circle begins behind the sensor.
  setProperty(sensor, "rays", 4);
  setProperty(sensor, "fov", 360);
  CHECK(room.sense(sensor) == "(LDR (n scan) (d 10.00 2.50 3.50 10.00))");
}

TEST_CASE("a sonar by rays hears each thing in its cone once, nearest first, hidden ones not", "[senses]") {
  Room room;
  Leaf& sensor = room.head->create("SonarPerceptor", "left");
  setProperty(sensor, "maxEchoes", 3);
  room.wall("near", {0, 2, 0}, {0.5, 0.5, 0.5});
  room.wall("hidden", {0, 4, 0}, {0.2, 0.2, 0.2});
  room.wall("beside", {1.5, 3.5, 0}, {0.8, 0.8, 0.8});
  room.wall("outside", {-3, 0, 0}, {1, 1, 1});
  CHECK(room.sense(sensor) == "(US left (5.00 5.00 5.00))");  // as in the installed base: no robots, no posts
  setProperty(sensor, "byRays", true);
  const std::string heard = room.sense(sensor);
  Predicates p;
  readSexp(heard, p);
  const Element echoes = (*p.begin()).at(2);
  INFO(heard);
  CHECK(echoes.at(0).number() == Approx(1.75));
  CHECK(echoes.at(1).number() > 3.1);
  CHECK(echoes.at(1).number() < 3.9);
  CHECK(echoes.at(2).number() == 5);
}

TEST_CASE("ray sensors report their range where there is no physics, and no world", "[senses]") {
  TestHost host;
  for (const char* p : {"scene", "gamecontrol", "sensors"}) host.kernel.plugins().use(p);
  Node& robot = host.kernel.create<Node>("Transform", "/usr/robot");
  Leaf& sensor = robot.create("DistancePerceptor", "front");
  Predicates out;
  sensor.as<ISharedView>()->share(1);
  sensor.as<Perceptor>()->sense(out, {"sense", 0, 0.02, 1, nullptr});
  CHECK(sexpOf(out) == "(DST (n front) (d 10.00))");
  host.kernel.plugins().use("physics");
  host.kernel.create("PhysicsServer", "/sys/server/physics");
  out.clear();
  sensor.as<ISharedView>()->share(2);
  sensor.as<Perceptor>()->sense(out, {"sense", 0, 0.02, 1, nullptr});
  CHECK(sexpOf(out) == "(DST (n front) (d 10.00))");
}
