#include "physics_house.h"

using namespace spark;
using namespace spark::test;

namespace {

/// A scene with a world that an engine steps, and a box that falls on a plane and rolls over.
struct Falling {
  Node& scene;
  Falling(TestHost& h, const std::string& scene, const std::string& server, const char* engine)
      : scene(*h.kernel.create("Scene", scene).asNode()) {
    Leaf& physics = h.kernel.create("PhysicsServer", server);
    if (scene != "/usr/scene") setProperty(physics, "scene", scene);
    h.kernel.create("OdeCollision", server + "/collision");
    h.kernel.create(engine, server + "/engine");
    h.kernel.create("World", scene + "/world");
    h.kernel.create("PlaneCollider", scene + "/ground");
    Node& t = *this->scene.create("Transform", "box").asNode();
    callMethod(t, "setLocalPos", List{0.1, 0.2, 1.0});
    callMethod(t, "setLocalRotation", List{20.0, 30.0, 10.0});
    t.create("RigidBody", "body");
    callMethod(t.create("BoxCollider", "collider"), "setBoxLengths", List{0.3, 0.2, 0.1});
  }
  Matrix pose() const { return scene.child("box")->as<Transform>()->world(); }
};

struct Scenes : TestHost {
  std::int64_t cycle = 0;
  Scenes() {
    for (const char* plugin : {"scene", "physics", "physics-ode", "physics-bullet"}) kernel.plugins().use(plugin);
    kernel.events().define(phase::kPrepare, Order::childrenFirst, "before the step");
    kernel.events().define(phase::kPhysics, Order::parentsFirst, "the step");
    kernel.events().define(phase::kPlace, Order::parentsFirst, "after the step");
    kernel.create("SceneServer", "/sys/server/scene");
  }
  void step(int n) {
    for (int i = 0; i < n; ++i, ++cycle)
      for (const ChannelName channel : {phase::kPrepare, phase::kPhysics, phase::kPlace})
        kernel.events().channel(channel).emit(Event{channel, double(cycle) * 0.02, 0.02, cycle, nullptr});
  }
};

Matrix alone(const char* engine) {
  Scenes h;
  const Falling one(h, "/usr/scene", "/sys/server/physics", engine);
  h.step(60);
  return one.pose();
}

}  // namespace

TEST_CASE("Two scenes with two worlds are stepped side by side, each by its own engine, as if it were alone") {
  Scenes h;
  const Falling first(h, "/usr/scene", "/sys/server/physics", "OdeEngine");
  const Falling second(h, "/usr/other", "/sys/server/physics2", "BulletEngine");
  h.step(60);
  CHECK(first.pose() == alone("OdeEngine"));
  CHECK(second.pose() == alone("BulletEngine"));
  CHECK(first.pose() != second.pose());
  CHECK(first.pose()(2, 3) < 0.5f);
  // The scene that is not the active one takes what is moved by hand.
  callMethod(*second.scene.child("box"), "setLocalPos", List{0.0, 0.0, 5.0});
  h.step(1);
  CHECK(second.pose()(2, 3) == Approx(5).margin(0.1));
}

TEST_CASE("A server of a scene that is not there waits for it") {
  Scenes h;
  const Falling first(h, "/usr/scene", "/sys/server/physics", "OdeEngine");
  Leaf& waiting = h.kernel.create("PhysicsServer", "/sys/server/physics2");
  setProperty(waiting, "scene", "/usr/later");
  h.kernel.create("OdeCollision", "/sys/server/physics2/collision");
  h.kernel.create("OdeEngine", "/sys/server/physics2/engine");
  h.step(5);
  CHECK(h.text.empty());
  CHECK_FALSE(waiting.as<IPhysicsServer>()->hasWorld());
  h.kernel.create("Scene", "/usr/later");
  h.kernel.create("World", "/usr/later/world");
  h.step(1);
  CHECK(waiting.as<IPhysicsServer>()->hasWorld());
}
