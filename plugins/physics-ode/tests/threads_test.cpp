#include <thread>

#include "engine_fixture.h"

using namespace spark;
using namespace spark::test;
using engine::Body;
using engine::Shape;

namespace {

/// Meshes and boxes in a heap; their places after a second.
std::vector<double> fall() {
  EngineHouse house;
  house.setGravity(9.81, true);
  house.geom(plane(0, 0, 1, 0));
  std::vector<Body> bodies;
  for (int i = 0; i < 8; ++i) {
    bodies.push_back(house.body({0.1 * (i % 3), 0.1 * (i % 2), 0.7 + 1.1 * i}));
    house.geom(i % 2 ? mesh(1) : box(1, 1, 1), bodies.back());
  }
  for (int i = 0; i < 50; ++i) house.step();
  std::vector<double> out;
  for (const Body b : bodies) house.ode.saveBody(b, out);
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
  EngineHouse house;
  house.setGravity(9.81);
  const Body a = house.body({0, 0, 3}), b = house.body({0, 0, 2});
  const auto g = house.geom(box(1, 1, 1), a, {Vec3(0, 0, 0.1), Mat3::Identity()});
  const auto joint = house.ode.createJoint(house.world, engine::JointType::hinge);
  house.ode.attach(joint, a, b);
  house.ode.setAnchor(joint, {0, 0, 2.5});
  for (int i = 0; i < 20; ++i) {
    house.step();
    double heights[4];
    {
      std::vector<std::jthread> threads;
      for (double& h : heights)
        threads.emplace_back(
            [&] { h = house.ode.state(a).position.z() + house.ode.pose(g).position.z() + house.ode.angle(joint, 0); });
    }
    for (double h : heights) CHECK(h == heights[0]);
  }
}
