#include <thread>

#include "engine_fixture.h"

using namespace spark;
using namespace spark::test;
using engine::Shape;
using physics::BodyHandle;

namespace {

/// The state of a heap of meshes and boxes after falling for a second.
std::vector<double> fall() {
  EngineHost host;
  host.setGravity(9.81, true);
  host.geom(plane(0, 0, 1, 0));
  std::vector<BodyHandle> bodies;
  for (int i = 0; i < 8; ++i) {
    bodies.push_back(host.body({0.1 * (i % 3), 0.1 * (i % 2), 0.7 + 1.1 * i}));
    host.geom(i % 2 ? mesh(1) : box(1, 1, 1), bodies.back());
  }
  for (int i = 0; i < 50; ++i) host.step();
  std::vector<double> out;
  for (const BodyHandle b : bodies) host.world.saveBody(b, out);
  return out;
}

}  // namespace

TEST_CASE("kernels that are stepped in several threads at once give the same result as one alone") {
  const auto alone = fall();
  std::vector<double> results[3];
  {
    std::vector<std::jthread> threads;
    for (auto& r : results) threads.emplace_back([&r] { r = fall(); });
  }
  for (const auto& r : results) CHECK(r == alone);
}

TEST_CASE("several threads can read states between steps") {
  EngineHost host;
  host.setGravity(9.81);
  const BodyHandle a = host.body({0, 0, 3}), b = host.body({0, 0, 2});
  const auto g = host.geom(box(1, 1, 1), a, {Vec3(0, 0, 0.1), Mat3::Identity()});
  const auto joint = host.world.createJoint(engine::JointType::hinge);
  host.world.attach(joint, a, b);
  host.world.setAnchor(joint, {0, 0, 2.5});
  for (int i = 0; i < 20; ++i) {
    host.step();
    double heights[4];
    {
      std::vector<std::jthread> threads;
      for (double& h : heights)
        threads.emplace_back([&] {
          h = host.world.state(a).position.z() + host.world.pose(g).position.z() + host.world.at(joint).angle(0);
        });
    }
    for (double h : heights) CHECK(h == heights[0]);
  }
}
