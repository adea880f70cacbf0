#include "physics_house.h"

using namespace spark;
using namespace spark::test;

TEST_CASE("a body takes its pose from its transform and moves it, also below turned and moved transforms") {
  PhysicsHouse house;
  Node& outer = house.transform(house.scene, "outer", {1, 2, 3});
  house.call(outer, "setLocalRotation", {0, 0, 90});
  Node& inner = house.transform(outer, "inner", {1, 0, 0});
  inner.create("RigidBody", "body");
  IRigidBody& body = house.body(inner);
  CHECK(body.state().position.isApprox(Vec3(1, 3, 3), 1e-6));
  CHECK(body.bodyTransform() == inner.as<Transform>());
  house.step(50);
  const double z = 3 - 9.81 * 0.02 * 0.02 * 50 * 51 / 2;
  CHECK(body.state().position.z() == Approx(z).epsilon(1e-6));
  CHECK(house.world(inner).z() == Approx(z).epsilon(1e-5));
  CHECK(house.world(inner).y() == Approx(3).epsilon(1e-5));
  CHECK(inner.as<Transform>()->localPos().x() == Approx(1).epsilon(1e-5));
}

TEST_CASE("a body that is put elsewhere keeps its rotation to the last bit") {
  PhysicsHouse house;
  Node& thing = house.thing("thing", {0, 0, 5});
  house.body(thing).setAngularVelocity({1, 2, 3});
  house.step(7);
  const auto state = [&] {
    StateWriter out(true);
    saveTree(*thing.find("body"), out);
    return out.bytes();
  };
  IRigidBody& body = house.body(thing);
  const Vec3 place = body.state().position;
  const auto before = state();
  body.setPosition({1, 2, 3});
  CHECK(body.state().position == Vec3(1, 2, 3));
  CHECK(state() != before);
  body.setPosition(place);
  CHECK(state() == before);
}

TEST_CASE("a body in a body's subtree is placed where it is") {
  PhysicsHouse house;
  Node& lower = house.thing("lower", {0, 0, 5});
  Node& upper = house.transform(lower, "upper", {0, 0, 1});
  upper.create("RigidBody", "body");
  house.body(upper).setVelocity({1, 0, 0});
  house.step(10);
  CHECK(house.world(upper).x() == Approx(0.2).epsilon(1e-4));
  CHECK(house.world(upper).z() == Approx(house.body(upper).state().position.z()).epsilon(1e-5));
  CHECK(house.world(lower).z() == Approx(house.body(lower).state().position.z()).epsilon(1e-5));
}

TEST_CASE("masses: every command sets the mass it names; a new body has 1 kg and unit inertia") {
  PhysicsHouse house;
  Node& t = house.thing("thing", {0, 0, 0});
  Leaf& body = *t.find("body");
  const auto mass = [&] { return getProperty(body, "mass").toNumber(); };
  CHECK(mass() == 1);
  house.body(t).addTorque({0, 0, 1});
  house.step();
  CHECK(house.body(t).state().angularVelocity.z() == Approx(0.02));
  house.call(body, "setBox", {10.0, 0.5, 1.0, 2.0});
  CHECK(mass() == Approx(10));
  house.call(body, "setBoxTotal", {3.0, 0.5, 1.0, 2.0});
  CHECK(mass() == Approx(3));
  house.call(body, "setSphere", {1000.0, 0.1});
  CHECK(mass() == Approx(1000 * 4.0 / 3 * kPi * 0.001));
  house.call(body, "setSphereTotal", {0.026, 0.042});
  CHECK(mass() == Approx(0.026));
  house.call(body, "setCylinder", {100.0, 0.1, 0.5});
  CHECK(mass() == Approx(100 * kPi * 0.01 * 0.5));
  house.call(body, "setCylinderTotal", {4.0, 0.1, 0.5});
  CHECK(mass() == Approx(4));
  house.call(body, "setCapsule", {100.0, 0.1, 0.5});
  CHECK(mass() == Approx(100 * (kPi * 0.01 * 0.5 + 4.0 / 3 * kPi * 0.001)));
  house.call(body, "setCapsuleTotal", {5.0, 0.1, 0.5});
  CHECK(mass() == Approx(5));
  house.call(body, "setMass", {2.5});
  CHECK(house.call(body, "getMass").toNumber() == Approx(2.5));
  house.call(body, "setMassParameters", {1.5, 0, 0, 0, 0.1, 0.2, 0.25, 0.01, 0.02, 0.03});
  CHECK(mass() == Approx(1.5));
  house.call(body, "setMassParameters", {1.5, 0.1, 0, 0, 0.1, 0.2, 0.25, 0, 0, 0});
  CHECK_THAT(house.text, Catch::Contains("centre of mass is its origin"));
  CHECK_THROWS_WITH(house.call(body, "setSphere", {1.0}), Catch::Contains("setSphere"));
  CHECK_THROWS_WITH(house.call(body, "setMass", {-1.0}), Catch::Contains("thing") && Catch::Contains("above 0 kg"));
  CHECK(mass() == Approx(1.5));
}

TEST_CASE("setBox gives a body the inertia of a box") {
  PhysicsHouse house;
  Node& t = house.thing("thing", {0, 0, 0});
  house.call(*t.find("body"), "setBoxTotal", {12.0, 1.0, 2.0, 3.0});
  house.body(t).addTorque({1, 0, 0});
  house.step();
  CHECK(house.body(t).state().angularVelocity.x() == Approx(0.02 / 13));
}

TEST_CASE("added masses move the body's origin to the common centre, and what is around stays where it was") {
  PhysicsHouse house;
  Node& t = house.thing("thing", {0, 0, 10});
  Leaf& body = *t.find("body");
  house.call(body, "useGravity", {false});
  house.call(body, "setBoxTotal", {1.0, 0.2, 0.2, 0.2});
  house.call(body, "addBoxTotal", {3.0, 0.2, 0.2, 0.2, 0.4, 0.0, 0.0, 0.0, 0.0, 0.0});
  CHECK(getProperty(body, "mass").toNumber() == Approx(4));
  CHECK(house.body(t).state().position.isApprox(Vec3(0.3, 0, 10), 1e-9));
  Node& visible = house.transform(t, "visible", {0, 0, 0});
  Node& outer = *t.create("TransformCollider", "outer").asNode();
  Leaf& box = outer.create("BoxCollider");
  house.call(box, "setBoxLengths", {0.2, 0.2, 0.2});
  house.call(box, "setLocalPosition", {0.4, 0.0, 0.0});
  house.step();
  CHECK(house.world(t).x() == Approx(0.3).epsilon(1e-5));
  CHECK(house.world(visible).x() == Approx(0).margin(1e-6));
  Vec3 low, high;
  outer.as<ICollider>()->bounds(low, high);
  CHECK(low.x() == Approx(0.3).margin(1e-6));
  CHECK(high.x() == Approx(0.5).margin(1e-6));
  // The pose of a second part is in the same frame as that of the first.
  house.call(body, "addSphereTotal", {4.0, 0.1, 0.8, 0.0, 0.0, 0.0, 0.0, 0.0});
  CHECK(house.body(t).state().position.x() == Approx(0.55).epsilon(1e-6));
  house.step();
  CHECK(house.world(visible).x() == Approx(0).margin(1e-6));
  // Inertia: two boxes and a sphere, by Steiner's rule about 0.55.
  const double expected =
      1 * (2 * 0.04 / 12 + 0.55 * 0.55) + 3 * (2 * 0.04 / 12 + 0.15 * 0.15) + 4 * (0.4 * 0.01 + 0.25 * 0.25);
  house.body(t).addTorque({0, 1, 0});
  house.step();
  CHECK(house.body(t).state().angularVelocity.y() == Approx(0.02 / expected).epsilon(1e-6));
  CHECK_THROWS_WITH(house.call(body, "addBoxTotal", {1.0, 1.0, 1.0, 1.0, 2.0}), Catch::Contains("6 numbers"));
  CHECK_THROWS_WITH(house.call(body, "addCapsuleTotal", {1.0, 1.0, 1.0, 0, 0, 0, 0, 0, 0}),
                    Catch::Contains("addCapsuleTotal"));
}

TEST_CASE("drag: a body slows by k v over m in each step, and turns slower by k w over I") {
  PhysicsHouse house;
  Node& t = house.thing("thing", {0, 0, 0});
  Leaf& body = *t.find("body");
  house.call(body, "useGravity", {false});
  house.call(body, "setMass", {2.0});
  Leaf& drag = body.asNode()->create("DragController");
  CHECK(house.call(drag, "getLinearDrag").toNumber() == 0.1);
  CHECK(house.call(drag, "getAngularDrag").toNumber() == 0.1);
  house.call(drag, "setLinearDrag", {0.5});
  house.call(drag, "setAngularDrag", {0.2});
  house.call(body, "setVelocity", {1.0, 0.0, 0.0});
  house.call(body, "setAngularVelocity", {0.0, 0.0, 2.0});
  house.step(100);
  CHECK(house.body(t).state().linearVelocity.x() == Approx(std::pow(1 - 0.02 * 0.5 / 2, 100)).epsilon(1e-9));
  CHECK(house.body(t).state().angularVelocity.z() == Approx(2 * std::pow(1 - 0.02 * 0.2 / 2, 100)).epsilon(1e-6));
}

TEST_CASE("a velocity controller clamps speed, 0 lets it be") {
  PhysicsHouse house;
  Node& t = house.thing("thing", {0, 0, 0});
  Leaf& body = *t.find("body");
  house.call(body, "useGravity", {false});
  Leaf& limit = body.asNode()->create("VelocityController");
  house.call(body, "setVelocity", {3.0, 4.0, 0.0});
  house.step();
  CHECK(house.body(t).state().linearVelocity.norm() == Approx(5));
  house.call(limit, "setMaxVelocity", {2.5});
  house.step();
  CHECK(house.body(t).state().linearVelocity.isApprox(Vec3(1.5, 2, 0), 1e-9));
}

TEST_CASE("a walker goes where it looks") {
  PhysicsHouse house;
  Node& t = house.thing("thing", {0, 0, 0});
  house.call(*t.find("body"), "useGravity", {false});
  Leaf& walker = t.find("body")->asNode()->create("FPSController");
  house.call(walker, "setHAngle", {90.0});
  house.call(walker, "setAcceleration", {10.0});
  setProperty(walker, "forward", 1.0);
  house.step(10);
  CHECK(house.world(t).x() < -0.1);
  CHECK(std::abs(house.world(t).y()) < 1e-3);
}

TEST_CASE("a battery holds what it is given") {
  PhysicsHouse house;
  Leaf& battery = house.scene.create("Battery");
  house.call(battery, "setCapacity", {167184.0});
  house.call(battery, "setPower", {1000.0});
  CHECK(getProperty(battery, "capacity").toNumber() == 167184);
  CHECK(getProperty(battery, "power").toNumber() == 1000);
}

TEST_CASE("the world's parameters are in effect, and read back") {
  PhysicsHouse house;
  Leaf& world = *house.scene.find("world");
  Node& t = house.thing("thing", {0, 0, 10});
  house.call(world, "setGravity", {1.0, 0.0, 0.0});
  for (const auto& [set, get, value] : {std::tuple{"setERP", "getERP", 0.3},
                                        {"setCFM", "getCFM", 1e-4},
                                        {"setContactSurfaceLayer", "getContactSurfaceLayer", 0.002}}) {
    house.call(world, set, {value});
    CHECK(house.call(world, get).toNumber() == value);
  }
  house.call(world, "setAutoDisableFlag", {false});
  CHECK_FALSE(house.call(world, "getAutoDisableFlag").toBool());
  house.step();
  CHECK(house.body(t).state().linearVelocity.isApprox(Vec3(0.02, 0, 0), 1e-9));
}

TEST_CASE("a sleeping body wakes when it is pushed, moved or enabled, and not by a zero force") {
  PhysicsHouse house;
  Node& t = house.box("box", {0, 0, 0.4995}, {1, 1, 1});
  house.scene.create("PlaneCollider").asNode()->create("ContactJointHandler");
  t.find("collider")->asNode()->create("ContactJointHandler");
  IRigidBody& body = house.body(t);
  const auto sleep = [&] {
    for (int i = 0; i < 500 && body.enabled(); ++i) house.step();
    return !body.enabled();
  };
  REQUIRE(sleep());
  body.addForce({0, 0, 0});
  body.addTorque({0, 0, 0});
  body.setVelocity({0, 0, 0});
  body.setAngularVelocity({0, 0, 0});
  CHECK_FALSE(body.enabled());
  body.addForce({1, 0, 0});
  CHECK(body.enabled());
  REQUIRE(sleep());
  body.addTorque({0, 0, 1});
  CHECK(body.enabled());
  REQUIRE(sleep());
  body.setAngularVelocity({0, 0, 1});
  CHECK(body.enabled());
  REQUIRE(sleep());
  body.setVelocity({0, 0, 1});
  CHECK(body.enabled());
  REQUIRE(sleep());
  body.setPose({Vec3(0, 0, 3), Mat3::Identity()});
  CHECK(body.enabled());
  house.step();
  CHECK(house.world(t).z() == Approx(3).margin(0.01));
  house.call(body.leaf(), "disable");
  CHECK_FALSE(house.call(body.leaf(), "isEnabled").toBool());
  const double z = body.state().position.z();
  house.step(3);
  CHECK(body.state().position.z() == z);
  house.call(body.leaf(), "enable");
  house.step();
  CHECK(body.state().position.z() < z);
}

TEST_CASE("a body that flies apart is named in the log and goes on") {
  PhysicsHouse house;
  Node& t = house.thing("wild", {0, 0, 2});
  house.body(t).addForce({1e307, 0, 0});
  house.body(t).addForce({1e308, 0, 0});
  house.step();
  CHECK_THAT(house.text, Catch::Contains("/usr/scene/wild/body") && Catch::Contains("no number"));
  house.step();
  CHECK(house.world(t).allFinite());
  CHECK(house.world(t).z() == Approx(2).margin(0.01));
}

TEST_CASE("without a world, bodies are refused with a sentence; without an engine, worlds") {
  House house;
  for (const char* plugin : {"scene", "physics", "physics-ode"}) house.kernel.plugins().use(plugin);
  Node& scene = *house.kernel.create("Scene", "/usr/scene").asNode();
  CHECK_THROWS_WITH(scene.create("RigidBody"), Catch::Contains("expected a World") && Catch::Contains("new(\"World\""));
  CHECK_THROWS_WITH(scene.create("World", "world"), Catch::Contains("/sys/server/physics"));
  house.kernel.create("PhysicsServer", "/sys/server/physics");
  CHECK_THROWS_WITH(scene.create("World", "world"), Catch::Contains("OdeEngine"));
}

TEST_CASE("the tree may be torn down in any order") {
  for (const std::string first :
       {"/usr/scene/world", "/usr/scene/space", "/sys/server/physics/engine", "/sys/server/physics/collision",
        "/sys/server/physics", "/usr/scene/box", "/usr/scene/box/body"}) {
    PhysicsHouse house;
    INFO(first);
    Node& t = house.box("box", {0, 0, 0.4}, {1, 1, 1});
    house.scene.create("PlaneCollider", "ground");
    Leaf& joint = t.create("BallJoint", "joint");
    house.call(joint, "attach", {"../body"});
    house.step();
    Leaf& gone = *house.kernel.root().find(first);
    gone.parent()->remove(gone);
    house.step(2);
    for (const auto& child : house.scene.children())
      if (auto* body = child->find<IRigidBody>("body")) CHECK(body->state().position.allFinite());
    house.scene.removeChildren();
    house.step();
  }
}

TEST_CASE("engine, collision detection and server can be replaced while a house runs: nothing changes, bit for bit") {
  struct Heap : PhysicsHouse {
    Heap() {
      scene.create("PlaneCollider", "ground");
      for (int i = 0; i < 6; ++i) box("box" + std::to_string(i), {0.1 * i, 0, 0.7 + 1.1 * i}, {1, 1, 1});
      Node& wheel = thing("wheel", {-4, 0, 2});
      Leaf& hinge = wheel.create("HingeJoint", "hinge");
      call(hinge, "attach", {"../body"});
      call(hinge, "setAnchor", {0.1, 0.2, 0.5});
      call(hinge, "setAxis", {0.3, 1.0, 0.2});
      call(hinge, "setMaxMotorForce", {0, 2.0});
      call(hinge, "setAngularMotorVelocity", {0, 40.0});
    }
    std::vector<double> state() {
      std::vector<double> out;
      for (const engine::DynamicState& s : kernel.root().require<IPhysicsServer>(IPhysicsServer::kPath).state().bodies)
        out.insert(out.end(), s.position.begin(), s.position.end());
      return out;
    }
    void replace(const char* path, const char* className) {
      Leaf& old = kernel.root().require<Leaf>(path);
      old.parent()->remove(old);
      kernel.create(className, path);
    }
  };
  Heap same, changed;
  same.step(40), changed.step(40);
  changed.replace("/sys/server/physics/engine", "OdeEngine");
  same.step(20), changed.step(20);
  CHECK(same.state() == changed.state());
  changed.replace("/sys/server/physics/collision", "OdeCollision");
  same.step(20), changed.step(20);
  CHECK(same.state() == changed.state());
  changed.replace("/sys/server/physics", "PhysicsServer");
  changed.kernel.create("OdeCollision", "/sys/server/physics/collision");
  changed.kernel.create("OdeEngine", "/sys/server/physics/engine");
  same.step(40), changed.step(40);
  CHECK(same.state() == changed.state());

  // Without an engine nothing moves, and the log says once what to do.
  Leaf& engine = changed.kernel.root().require<Leaf>("/sys/server/physics/engine");
  engine.parent()->remove(engine);
  const auto before = changed.state();
  changed.step(3);
  CHECK(changed.state() == before);
  const std::size_t said = changed.text.find("has no engine below it");
  REQUIRE(said != std::string::npos);
  CHECK(changed.text.find("has no engine below it", said + 1) == std::string::npos);
  changed.kernel.create("OdeEngine", "/sys/server/physics/engine");
  changed.step(1);
  CHECK(changed.state() != before);
}

TEST_CASE("the plugin stays while its nodes live, and goes afterwards with the scene's") {
  PhysicsHouse house;
  CHECK_THROWS_WITH(house.kernel.plugins().unload("physics"), Catch::Contains("/usr/scene/world"));
  house.scene.removeChildren();
  Leaf& server = *house.kernel.root().find("/sys/server/physics");
  server.parent()->remove(server);
  house.kernel.plugins().unload("physics");
  CHECK(house.kernel.findClass("RigidBody") == nullptr);
}

TEST_CASE("several steps of the engine in one of the simulation: forces last, sleep and falls are the same") {
  for (const double timestep : {0.0, 0.005, 0.001}) {
    CAPTURE(timestep);
    PhysicsHouse house;
    setProperty(*house.kernel.root().find("/usr/scene/world"), "timestep", timestep);
    Leaf& ground = house.scene.create("PlaneCollider", "ground");
    setProperty(ground.asNode()->create("ContactJointHandler"), "contactBounceMode", false);
    Node& box = house.box("box", {0, 0, 0.199}, {0.4, 0.4, 0.4});
    setProperty(box.child("collider")->asNode()->create("ContactJointHandler"), "contactBounceMode", false);
    IRigidBody& body = house.body(box);
    // Pushed in each cycle against friction that holds it: no force may pile up while it sleeps.
    for (int i = 0; i < 50; ++i) {
      body.addForce({3, 0, 0});
      house.step();
    }
    CHECK(std::abs(body.state().position.x()) < 2e-3);
    house.step(15);
    CHECK_FALSE(body.enabled());
    // A force lasts for all steps of a cycle.
    IRigidBody& flying = house.body(house.thing("flying", {5, 0, 50}));
    flying.addForce({2, 0, 0});
    house.step();
    CHECK(flying.state().linearVelocity.x() == Approx(2 * 0.02).epsilon(1e-6));
    house.step();
    CHECK(flying.state().linearVelocity.x() == Approx(2 * 0.02).epsilon(1e-6));
    CHECK(flying.state().linearVelocity.z() == Approx(-9.81 * 0.04).epsilon(1e-6));
  }
}
