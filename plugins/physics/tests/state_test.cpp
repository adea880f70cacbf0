#include "physics_house.h"

using namespace spark;
using namespace spark::test;

namespace {

/// Boxes and spheres that fall on each other and on the ground, a walker, and a pendulum with a motor.
struct Heap : PhysicsHost {
  Heap() {
    Node& ground = *scene.create("PlaneCollider", "ground").asNode();
    call(ground.create("ContactJointHandler"), "setContactBounceMode", {false});
    for (int i = 0; i < 12; ++i) {
      Node& t = thing("thing" + std::to_string(i), {0.11 * (i % 3), 0.13 * (i % 2), 0.5 + 0.6 * i});
      call(*t.find("body"), "setBoxTotal", {1.0, 0.5, 0.4, 0.3});
      Node& c = *t.create(i % 2 ? "SphereCollider" : "BoxCollider", "collider").asNode();
      if (i % 2)
        call(c, "setRadius", {0.25});
      else
        call(c, "setBoxLengths", {0.5, 0.4, 0.3});
      if (i % 3) call(c.create("ContactJointHandler"), "setContactBounceMode", {false});
      call(t.find("body")->asNode()->create("DragController"), "setLinearDrag", {0.05});
    }
    Node& walker = thing("walker", {-5, 0, 3});
    call(walker.find("body")->asNode()->create("FPSController"), "setHAngle", {30.0});
    body(walker).setAngularVelocity({0, 0, 1});
    Leaf& hinge = thing("pendulum", {5, 0, 5}).create("HingeJoint", "hinge");
    call(hinge, "attach", {"../body"});
    call(hinge, "setAnchor", {0.0, 0.0, 1.0});
    call(hinge, "setMaxMotorForce", {0, 2.0});
    call(hinge, "setAngularMotorVelocity", {0, 30.0});
    thing("last", {9, 0, 9});  // its state follows the joint's
  }
  std::uint64_t hash() const { return stateHash(scene); }
  std::string saved() const {
    StateWriter out(true);
    saveTree(scene, out);
    return out.bytes();
  }
  void load(const std::string& bytes) {
    StateReader in(bytes);
    loadTree(scene, in);
  }
};

}  // namespace

TEST_CASE("two equal scenes have the same hash, and the hash changes with the state") {
  Heap a, b;
  CHECK(a.hash() == b.hash());
  const auto first = a.hash();
  a.step(100);
  b.step(100);
  CHECK(a.hash() == b.hash());
  CHECK(a.hash() != first);
  Heap::body(*a.scene.find("thing3")->asNode()).setVelocity({1e-9, 0, 0});
  CHECK(a.hash() != b.hash());
}

TEST_CASE("a motor's speed and a body's mass are part of the state") {
  Heap a;
  const auto h0 = a.hash();
  a.call(*a.scene.find("pendulum/hinge"), "setAngularMotorVelocity", {0, 31.0});
  const auto h1 = a.hash();
  CHECK(h1 != h0);
  a.call(*a.scene.find("thing1/body"), "setMass", {2.0});
  CHECK(a.hash() != h1);
}

TEST_CASE("a restored scene continues bit for bit with any history") {
  Heap a;
  a.step(60);
  const std::string middle = a.saved();
  a.step(200);
  const auto end = a.hash();
  Heap b;
  b.call(*b.scene.find("walker/body/FPSController"), "setHAngle", {-40.0});
  b.call(*b.scene.find("pendulum/hinge"), "setAngularMotorVelocity", {0, -70.0});
  b.step(17);
  b.load(middle);
  CHECK(b.saved() == middle);
  b.step(200);
  CHECK(b.hash() == end);
  a.load(middle);
  a.step(200);
  CHECK(a.hash() == end);
}

TEST_CASE("a joint keeps its turns in the saved state, and goes on as its twin does") {
  const auto turning = [](PhysicsHost& h) -> Leaf& {
    Leaf& hinge = h.thing("wheel", {0, 0, 5}).create("HingeJoint", "hinge");
    h.call(hinge, "attach", {"../body"});
    h.call(hinge, "setMaxMotorForce", {0, 50.0});
    h.call(hinge, "setAngularMotorVelocity", {0, 600.0});
    return hinge;
  };
  const auto angle = [](Leaf& hinge) { return PhysicsHost::call(hinge, "getAngle").toNumber(); };
  PhysicsHost a, b;
  Leaf &one = turning(a), &other = turning(b);
  a.step(100);
  REQUIRE(std::abs(angle(one)) > 720);
  StateWriter out(true);
  saveTree(a.scene, out);
  StateReader in(out.bytes());
  loadTree(b.scene, in);
  CHECK(angle(other) == angle(one));
  // A stop at the sum of all turns holds where it holds the twin.
  for (PhysicsHost* h : {&a, &b}) {
    Leaf& hinge = h == &a ? one : other;
    h->call(hinge, "setLowStopDeg", {0, -1500.0}), h->call(hinge, "setHighStopDeg", {0, 1500.0});
    h->step(60);
  }
  CHECK(angle(other) == angle(one));
  CHECK(std::abs(angle(one)) < 1510);
}
