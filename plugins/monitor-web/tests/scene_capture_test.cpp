#include "stream/scene_capture.h"

#include <catch2/catch.hpp>

#include "fake_physics.h"
#include "stream/messages.h"
#include "test_support.h"

using namespace spark;
using namespace spark::test;
using namespace spark::web;

namespace {
/// Bodies of a scene, and a frame of them.
struct Bodies : TestHost {
  Bodies() { registerFakePhysics(kernel); }
  /// Adds a transform at `x`, `depth` levels below the top of the frame. Returns its body.
  FakeBody& add(const std::string& path, double x, int depth = 0) {
    auto& transform = kernel.create<Transform>("Transform", path);
    transform.setLocalPos(Vec3f(static_cast<float>(x), 0, 0));
    transform.updateWorld(true);
    FrameNode node;
    node.depth = depth;
    node.transform = &transform;
    node.local = transform.local();
    frame.nodes.push_back(node);
    return transform.create<FakeBody>("FakeBody", "body");
  }
  FakeJoint& join(FakeBody& child, IRigidBody* parent, double x) {
    auto& joint = child.transform()->create<FakeJoint>("FakeJoint", "joint" + std::to_string(joints++));
    joint.bodies = {&child, parent};
    joint.point = Vec3(x, 0, 0);
    return joint;
  }
  std::vector<Mount> mounts() { return describeScene(frame)->mounts; }
  MonitorFrame frame;
  int joints = 0;
};
}  // namespace

TEST_CASE("A transform is mounted on the one to which a joint links its body, at the joint's point") {
  Bodies b;
  FakeBody &torso = b.add("/usr/torso", 1), &arm = b.add("/usr/arm", 3), &hand = b.add("/usr/hand", 4);
  b.join(arm, &torso, 2);
  b.join(hand, &arm, 3.50004);
  const auto mounts = b.mounts();
  REQUIRE(mounts.size() == 3);
  CHECK(mounts[0].on == -1);
  CHECK(mounts[1].on == 0);
  CHECK(mounts[1].pin == Vec3f(-1, 0, 0));
  CHECK(mounts[2].on == 1);
  CHECK(mounts[2].pin == Vec3f(-0.5f, 0, 0));  // tenths of a millimetre
  Snapshot snapshot;
  snapshot.scene = describeScene(b.frame);
  snapshot.visible.assign(3, 1);
  CHECK_THAT(sceneMessage(snapshot, 1), Catch::Contains(R"("on":0,"pin":[-1,0,0],"path":"/usr/arm")"));
}

TEST_CASE("The later transform is mounted on the earlier one, whichever body is the joint's first, and once") {
  Bodies b;
  FakeBody &first = b.add("/usr/a", 1), &second = b.add("/usr/b", 2), &third = b.add("/usr/c", 3);
  b.join(first, &third, 2);
  b.join(second, &third, 2.5);
  b.join(third, &second, 0);
  const auto mounts = b.mounts();
  CHECK(mounts[0].on == -1);
  CHECK(mounts[1].on == -1);
  CHECK(mounts[2].on == 0);
  CHECK(mounts[2].pin == Vec3f(-1, 0, 0));
}

TEST_CASE("Joints without a point mount at the origin; motors, static bodies and other parents do not") {
  Bodies b;
  FakeBody &a = b.add("/usr/a", 1), &slider = b.add("/usr/slider", 2), &motor = b.add("/usr/motor", 2);
  FakeBody &fixed = b.add("/usr/fixed", 2), &inner = b.add("/usr/fixed/inner", 1, 1), &free = b.add("/usr/free", 0);
  b.join(slider, &a, 7).type = engine::JointType::slider;
  b.join(motor, &a, 7).type = engine::JointType::angularMotor;
  b.join(fixed, nullptr, 7);
  b.join(inner, &a, 7);
  b.join(free, &free, 7);
  FakeBody unlinked;
  b.join(free, &unlinked, 7);
  const auto mounts = b.mounts();
  CHECK(mounts[1].on == 0);
  CHECK(mounts[1].pin.isZero(0));
  for (const std::size_t i : {0u, 2u, 3u, 4u, 5u}) CHECK(mounts[i].on == -1);
}
