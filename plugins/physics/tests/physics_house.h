#pragma once
/// \file
/// A kernel with a scene, a world and a space. It steps the simulation by emitting the phases itself.

#include <catch2/catch.hpp>

#include "api/phases.h"
#include "api/physics.h"
#include "spark/state.h"
#include "test_support.h"

namespace spark::test {

struct PhysicsHost : TestHost {
  Node& scene;
  double dt = 0.02;
  std::int64_t cycle = 0;

  PhysicsHost() : scene(make(*this)) {}
  static Node& make(TestHost& h) {
    for (const char* plugin : {"scene", "physics", "physics-ode"}) h.kernel.plugins().use(plugin);
    h.kernel.events().define(phase::kPrepare, Order::childrenFirst, "before the step");
    h.kernel.events().define(phase::kPhysics, Order::parentsFirst, "the step");
    h.kernel.events().define(phase::kPlace, Order::parentsFirst, "after the step");
    h.kernel.create("SceneServer", "/sys/server/scene");
    h.kernel.create("PhysicsServer", "/sys/server/physics");
    h.kernel.create("OdeCollision", "/sys/server/physics/collision");
    h.kernel.create("OdeEngine", "/sys/server/physics/engine");
    Leaf& scene = h.kernel.create("Scene", "/usr/scene");
    h.kernel.create("World", "/usr/scene/world");
    h.kernel.create("Space", "/usr/scene/space");
    return *scene.asNode();
  }
  /// Emits the phases prepare, physics and place n times.
  void step(int n = 1) {
    for (int i = 0; i < n; ++i, ++cycle)
      for (const ChannelName channel : {phase::kPrepare, phase::kPhysics, phase::kPlace})
        kernel.events().channel(channel).emit(Event{channel, double(cycle) * dt, dt, cycle, nullptr});
  }
  /// A transform below `parent`.
  Node& transform(Node& parent, const std::string& name, const Vec3& at) {
    Node& t = *parent.create("Transform", name).asNode();
    call(t, "setLocalPos", {at.x(), at.y(), at.z()});
    return t;
  }
  /// A transform in the scene with a body in it.
  Node& thing(const std::string& name, const Vec3& at) {
    Node& t = transform(scene, name, at);
    t.create("RigidBody", "body");
    return t;
  }
  /// Like thing, with a box collider with the given edges.
  Node& box(const std::string& name, const Vec3& at, const Vec3& edges) {
    Node& t = thing(name, at);
    call(t.create("BoxCollider", "collider"), "setBoxLengths", {edges.x(), edges.y(), edges.z()});
    return t;
  }
  static Value call(Leaf& leaf, const char* method, const List& arguments = {}) {
    return callMethod(leaf, method, arguments);
  }
  static IRigidBody& body(Node& thing) { return thing.require<IRigidBody>("body"); }
  static Vec3f world(Node& transform) { return positionOf(transform.as<Transform>()->world()); }
};

}  // namespace spark::test
