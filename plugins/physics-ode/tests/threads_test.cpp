#include <thread>

#include "engine_fixture.h"

using namespace spark;
using namespace spark::test;
using engine::Shape;
using physics::BodyHandle;

namespace {

/// Meshes and boxes in a heap; their places after a second.
std::vector<double> fall() {
  EngineHost house;
  house.setGravity(9.81, true);
  house.geom(plane(0, 0, 1, 0));
  std::vector<BodyHandle> bodies;
  for (int i = 0; i < 8; ++i) {
    bodies.push_back(house.body({0.1 * (i % 3), 0.1 * (i % 2), 0.7 + 1.1 * i}));
    house.geom(i % 2 ? mesh(1) : box(1, 1, 1), bodies.back());
  }
  for (int i = 0; i < 50; ++i) house.step();
  std::vector<double> out;
  for (const BodyHandle b : bodies) house.world.saveBody(b, out);
  return out;
}

}  // namespace

TEST_CASE("houses in several threads step at once and give what one alone gives") {
  const auto alone = fall();
  std::vector<double> results[3];
  {
    std::vector<std::jthread> threads;
    for (auto& r : results) threads.emplace_back([&r] { r = fall(); });
  }
  for (const auto& r : results) CHECK(r == alone);
}

TEST_CASE("states are read by several threads between steps") {
  EngineHost house;
  house.setGravity(9.81);
  const BodyHandle a = house.body({0, 0, 3}), b = house.body({0, 0, 2});
  const auto g = house.geom(box(1, 1, 1), a, {Vec3(0, 0, 0.1), Mat3::Identity()});
  const auto joint = house.world.createJoint(engine::JointType::hinge);
  house.world.attach(joint, a, b);
  house.world.setAnchor(joint, {0, 0, 2.5});
  for (int i = 0; i < 20; ++i) {
    house.step();
    double heights[4];
    {
      std::vector<std::jthread> threads;
      for (double& h : heights)
        threads.emplace_back([&] {
          h = house.world.state(a).position.z() + house.world.pose(g).position.z() + house.world.angle(joint, 0);
        });
    }
    for (double h : heights) CHECK(h == heights[0]);
  }
}
