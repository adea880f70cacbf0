#include "absence.h"
#include "physics_house.h"

using namespace spark;
using namespace spark::test;

TEST_CASE("a body starts at the pose of its transform and moves it, also below rotated and shifted transforms") {
  PhysicsHost host;
  Node& outer = host.transform(host.scene, "outer", {1, 2, 3});
  host.call(outer, "setLocalRotation", {0, 0, 90});
  Node& inner = host.transform(outer, "inner", {1, 0, 0});
  inner.create("RigidBody", "body");
  IRigidBody& body = host.body(inner);
  CHECK(body.state().position.isApprox(Vec3(1, 3, 3), 1e-6));
  CHECK(body.bodyTransform() == inner.as<Transform>());
  host.step(50);
  const double z = 3 - 9.81 * 0.02 * 0.02 * 50 * 51 / 2;
  CHECK(body.state().position.z() == Approx(z).epsilon(1e-6));
  CHECK(host.world(inner).z() == Approx(z).epsilon(1e-5));
  CHECK(host.world(inner).y() == Approx(3).epsilon(1e-5));
  CHECK(inner.as<Transform>()->localPos().x() == Approx(1).epsilon(1e-5));
}

TEST_CASE("setPosition keeps the rotation of a body bit for bit") {
  PhysicsHost host;
  Node& thing = host.thing("thing", {0, 0, 5});
  host.body(thing).setAngularVelocity({1, 2, 3});
  host.step(7);
  const auto state = [&] {
    StateWriter out(true);
    saveTree(*thing.find("body"), out);
    return out.bytes();
  };
  IRigidBody& body = host.body(thing);
  const Vec3 position = body.state().position;
  const auto before = state();
  body.setPosition({1, 2, 3});
  CHECK(body.state().position == Vec3(1, 2, 3));
  CHECK(state() != before);
  body.setPosition(position);
  CHECK(state() == before);
}

TEST_CASE("the transform of a body below another body follows its own body") {
  PhysicsHost host;
  Node& lower = host.thing("lower", {0, 0, 5});
  Node& upper = host.transform(lower, "upper", {0, 0, 1});
  upper.create("RigidBody", "body");
  host.body(upper).setVelocity({1, 0, 0});
  host.step(10);
  CHECK(host.world(upper).x() == Approx(0.2).epsilon(1e-4));
  CHECK(host.world(upper).z() == Approx(host.body(upper).state().position.z()).epsilon(1e-5));
  CHECK(host.world(lower).z() == Approx(host.body(lower).state().position.z()).epsilon(1e-5));
}

TEST_CASE("each mass method sets the mass of its solid, and a new body has 1 kg and unit inertia") {
  PhysicsHost host;
  Node& t = host.thing("thing", {0, 0, 0});
  Leaf& body = *t.find("body");
  const auto mass = [&] { return getProperty(body, "mass").toNumber(); };
  CHECK(mass() == 1);
  host.body(t).addTorque({0, 0, 1});
  host.step();
  CHECK(host.body(t).state().angularVelocity.z() == Approx(0.02));
  host.call(body, "setBox", {10.0, 0.5, 1.0, 2.0});
  CHECK(mass() == Approx(10));
  host.call(body, "setBoxTotal", {3.0, 0.5, 1.0, 2.0});
  CHECK(mass() == Approx(3));
  host.call(body, "setSphere", {1000.0, 0.1});
  CHECK(mass() == Approx(1000 * 4.0 / 3 * kPi * 0.001));
  host.call(body, "setSphereTotal", {0.026, 0.042});
  CHECK(mass() == Approx(0.026));
  host.call(body, "setCylinder", {100.0, 0.1, 0.5});
  CHECK(mass() == Approx(100 * kPi * 0.01 * 0.5));
  host.call(body, "setCylinderTotal", {4.0, 0.1, 0.5});
  CHECK(mass() == Approx(4));
  host.call(body, "setCapsule", {100.0, 0.1, 0.5});
  CHECK(mass() == Approx(100 * (kPi * 0.01 * 0.5 + 4.0 / 3 * kPi * 0.001)));
  host.call(body, "setCapsuleTotal", {5.0, 0.1, 0.5});
  CHECK(mass() == Approx(5));
  host.call(body, "setMass", {2.5});
  CHECK(host.call(body, "getMass").toNumber() == Approx(2.5));
  host.call(body, "setMassParameters", {1.5, 0, 0, 0, 0.1, 0.2, 0.25, 0.01, 0.02, 0.03});
  CHECK(mass() == Approx(1.5));
  host.call(body, "setMassParameters", {1.5, 0.1, 0, 0, 0.1, 0.2, 0.25, 0, 0, 0});
  CHECK_THAT(host.text, Catch::Contains("centre of mass is its origin"));
  CHECK_THROWS_WITH(host.call(body, "setSphere", {1.0}), Catch::Contains("setSphere"));
  CHECK_THROWS_WITH(host.call(body, "setMass", {-1.0}),
                    Catch::Contains("thing") && Catch::Contains("expected 1e-15 to 1e+15 kg"));
  CHECK(mass() == Approx(1.5));
}

TEST_CASE("setBox gives a body the inertia of a box") {
  PhysicsHost host;
  Node& t = host.thing("thing", {0, 0, 0});
  host.call(*t.find("body"), "setBoxTotal", {12.0, 1.0, 2.0, 3.0});
  host.body(t).addTorque({1, 0, 0});
  host.step();
  CHECK(host.body(t).state().angularVelocity.x() == Approx(0.02 / 13));
}

TEST_CASE("adding masses moves the body's origin to the common center of mass but no visuals or colliders") {
  PhysicsHost host;
  Node& t = host.thing("thing", {0, 0, 10});
  Leaf& body = *t.find("body");
  host.call(body, "useGravity", {false});
  host.call(body, "setBoxTotal", {1.0, 0.2, 0.2, 0.2});
  host.call(body, "addBoxTotal", {3.0, 0.2, 0.2, 0.2, 0.4, 0.0, 0.0, 0.0, 0.0, 0.0});
  CHECK(getProperty(body, "mass").toNumber() == Approx(4));
  CHECK(host.body(t).state().position.isApprox(Vec3(0.3, 0, 10), 1e-9));
  Node& visible = host.transform(t, "visible", {0, 0, 0});
  Node& outer = *t.create("TransformCollider", "outer").asNode();
  Leaf& box = outer.create("BoxCollider");
  host.call(box, "setBoxLengths", {0.2, 0.2, 0.2});
  host.call(box, "setLocalPosition", {0.4, 0.0, 0.0});
  host.step();
  CHECK(host.world(t).x() == Approx(0.3).epsilon(1e-5));
  CHECK(host.world(visible).x() == Approx(0).margin(1e-6));
  Vec3 low, high;
  outer.as<ICollider>()->bounds(low, high);
  CHECK(low.x() == Approx(0.3).margin(1e-6));
  CHECK(high.x() == Approx(0.5).margin(1e-6));
  // The pose of the second part is in the same frame as that of the first.
  host.call(body, "addSphereTotal", {4.0, 0.1, 0.8, 0.0, 0.0, 0.0, 0.0, 0.0});
  CHECK(host.body(t).state().position.x() == Approx(0.55).epsilon(1e-6));
  host.step();
  CHECK(host.world(visible).x() == Approx(0).margin(1e-6));
  // Inertia of two boxes and a sphere about x = 0.55, by the parallel axis theorem.
  const double expected =
      1 * (2 * 0.04 / 12 + 0.55 * 0.55) + 3 * (2 * 0.04 / 12 + 0.15 * 0.15) + 4 * (0.4 * 0.01 + 0.25 * 0.25);
  host.body(t).addTorque({0, 1, 0});
  host.step();
  CHECK(host.body(t).state().angularVelocity.y() == Approx(0.02 / expected).epsilon(1e-6));
  CHECK_THROWS_WITH(host.call(body, "addBoxTotal", {1.0, 1.0, 1.0, 1.0, 2.0}), Catch::Contains("6 numbers"));
  CHECK_THROWS_WITH(host.call(body, "addCapsuleTotal", {1.0, 1.0, 1.0, 0, 0, 0, 0, 0, 0}),
                    Catch::Contains("addCapsuleTotal"));
}

TEST_CASE("drag decelerates a body by k v / m and its rotation by k w / I") {
  PhysicsHost host;
  Node& t = host.thing("thing", {0, 0, 0});
  Leaf& body = *t.find("body");
  host.call(body, "useGravity", {false});
  host.call(body, "setMass", {2.0});
  Leaf& drag = body.asNode()->create("DragController");
  CHECK(host.call(drag, "getLinearDrag").toNumber() == 0.1);
  CHECK(host.call(drag, "getAngularDrag").toNumber() == 0.1);
  host.call(drag, "setLinearDrag", {0.5});
  host.call(drag, "setAngularDrag", {0.2});
  host.call(body, "setVelocity", {1.0, 0.0, 0.0});
  host.call(body, "setAngularVelocity", {0.0, 0.0, 2.0});
  host.step(100);
  CHECK(host.body(t).state().linearVelocity.x() == Approx(std::pow(1 - 0.02 * 0.5 / 2, 100)).epsilon(1e-9));
  CHECK(host.body(t).state().angularVelocity.z() == Approx(2 * std::pow(1 - 0.02 * 0.2 / 2, 100)).epsilon(1e-6));
}

TEST_CASE("a velocity controller limits the speed, and 0 means no limit") {
  PhysicsHost host;
  Node& t = host.thing("thing", {0, 0, 0});
  Leaf& body = *t.find("body");
  host.call(body, "useGravity", {false});
  Leaf& limit = body.asNode()->create("VelocityController");
  host.call(body, "setVelocity", {3.0, 4.0, 0.0});
  host.step();
  CHECK(host.body(t).state().linearVelocity.norm() == Approx(5));
  host.call(limit, "setMaxVelocity", {2.5});
  host.step();
  CHECK(host.body(t).state().linearVelocity.isApprox(Vec3(1.5, 2, 0), 1e-9));
}

TEST_CASE("an FPSController moves its body in the direction of its heading") {
  PhysicsHost host;
  Node& t = host.thing("thing", {0, 0, 0});
  host.call(*t.find("body"), "useGravity", {false});
  Leaf& walker = t.find("body")->asNode()->create("FPSController");
  host.call(walker, "setHAngle", {90.0});
  host.call(walker, "setAcceleration", {10.0});
  setProperty(walker, "forward", 1.0);
  host.step(10);
  CHECK(host.world(t).x() < -0.1);
  CHECK(std::abs(host.world(t).y()) < 1e-3);
}

TEST_CASE("a battery returns the capacity and the power that were set") {
  PhysicsHost host;
  Leaf& battery = host.scene.create("Battery");
  host.call(battery, "setCapacity", {167184.0});
  host.call(battery, "setPower", {1000.0});
  CHECK(getProperty(battery, "capacity").toNumber() == 167184);
  CHECK(getProperty(battery, "power").toNumber() == 1000);
}

TEST_CASE("the world's parameters have an effect and return the values that were set") {
  PhysicsHost host;
  Leaf& world = *host.scene.find("world");
  Node& t = host.thing("thing", {0, 0, 10});
  host.call(world, "setGravity", {1.0, 0.0, 0.0});
  for (const auto& [set, get, value] : {std::tuple{"setERP", "getERP", 0.3},
                                        {"setCFM", "getCFM", 1e-4},
                                        {"setContactSurfaceLayer", "getContactSurfaceLayer", 0.002}}) {
    host.call(world, set, {value});
    CHECK(host.call(world, get).toNumber() == value);
  }
  host.call(world, "setAutoDisableFlag", {false});
  CHECK_FALSE(host.call(world, "getAutoDisableFlag").toBool());
  host.step();
  CHECK(host.body(t).state().linearVelocity.isApprox(Vec3(0.02, 0, 0), 1e-9));
}

TEST_CASE("forces, velocities, poses and enable wake a sleeping body, but zero forces and velocities do not") {
  PhysicsHost host;
  Node& t = host.box("box", {0, 0, 0.4995}, {1, 1, 1});
  host.scene.create("PlaneCollider").asNode()->create("ContactJointHandler");
  t.find("collider")->asNode()->create("ContactJointHandler");
  IRigidBody& body = host.body(t);
  const auto sleep = [&] {
    for (int i = 0; i < 500 && body.enabled(); ++i) host.step();
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
  host.step();
  CHECK(host.world(t).z() == Approx(3).margin(0.01));
  host.call(body.leaf(), "disable");
  CHECK_FALSE(host.call(body.leaf(), "isEnabled").toBool());
  const double z = body.state().position.z();
  host.step(3);
  CHECK(body.state().position.z() == z);
  host.call(body.leaf(), "enable");
  host.step();
  CHECK(body.state().position.z() < z);
}

TEST_CASE("a body that diverges is reported in the log and continues") {
  PhysicsHost host;
  Node& t = host.thing("wild", {0, 0, 2});
  host.body(t).addForce({1e307, 0, 0});
  host.body(t).addForce({1e308, 0, 0});
  host.step();
  CHECK_THAT(host.text, Catch::Contains("/usr/scene/wild/body") && Catch::Contains("no number"));
  host.step();
  CHECK(host.world(t).allFinite());
  CHECK(host.world(t).z() == Approx(2).margin(0.01));
}

TEST_CASE("bodies without a world and worlds without a server or an engine are refused with an explanation") {
  TestHost host;
  for (const char* plugin : {"scene", "physics", "physics-ode"}) host.kernel.plugins().use(plugin);
  Node& scene = *host.kernel.create("Scene", "/usr/scene").asNode();
  CHECK_THROWS_WITH(scene.create("RigidBody"), Catch::Contains("expected a World") && Catch::Contains("new(\"World\""));
  CHECK_THROWS_WITH(scene.create("World", "world"), Catch::Contains("/sys/server/physics"));
  host.kernel.create("PhysicsServer", "/sys/server/physics");
  CHECK_THROWS_WITH(scene.create("World", "world"), Catch::Contains("OdeEngine"));
}

TEST_CASE("the nodes of a scene may be removed in any order") {
  for (const std::string first :
       {"/usr/scene/world", "/usr/scene/space", "/sys/server/physics/engine", "/sys/server/physics/collision",
        "/sys/server/physics", "/usr/scene/box", "/usr/scene/box/body"}) {
    PhysicsHost host;
    INFO(first);
    Node& t = host.box("box", {0, 0, 0.4}, {1, 1, 1});
    host.scene.create("PlaneCollider", "ground");
    Leaf& joint = t.create("BallJoint", "joint");
    host.call(joint, "attach", {"../body"});
    host.step();
    Leaf& gone = *host.kernel.root().find(first);
    gone.parent()->remove(gone);
    host.step(2);
    for (const auto& child : host.scene.children())
      if (auto* body = child->find<IRigidBody>("body")) CHECK(body->state().position.allFinite());
    host.scene.removeChildren();
    host.step();
  }
}

TEST_CASE("replacing the engine, the collision detection or the server does not change the result, bit for bit") {
  struct Heap : PhysicsHost {
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

  // Without an engine nothing moves, and the log reports it once.
  Leaf& engine = changed.kernel.root().require<Leaf>("/sys/server/physics/engine");
  engine.parent()->remove(engine);
  const auto before = changed.state();
  changed.step(3);
  CHECK(changed.state() == before);
  CHECK(count(changed.text, "has no engine below it") == 1);
  changed.kernel.create("OdeEngine", "/sys/server/physics/engine");
  changed.step(1);
  CHECK(changed.state() != before);
}

TEST_CASE("the plugin cannot be unloaded while its nodes exist, but can be afterwards") {
  PhysicsHost host;
  CHECK_THROWS_WITH(host.kernel.plugins().unload("physics"), Catch::Contains("/usr/scene/world"));
  host.scene.removeChildren();
  Leaf& server = *host.kernel.root().find("/sys/server/physics");
  server.parent()->remove(server);
  host.kernel.plugins().unload("physics");
  CHECK(host.kernel.findClass("RigidBody") == nullptr);
}

TEST_CASE("with several engine steps per cycle, forces act in all of them, and sleep works as with one step") {
  for (const double timestep : {0.0, 0.005, 0.001}) {
    CAPTURE(timestep);
    PhysicsHost host;
    setProperty(*host.kernel.root().find("/usr/scene/world"), "timestep", timestep);
    Leaf& ground = host.scene.create("PlaneCollider", "ground");
    setProperty(ground.asNode()->create("ContactJointHandler"), "contactBounceMode", false);
    Node& box = host.box("box", {0, 0, 0.199}, {0.4, 0.4, 0.4});
    setProperty(box.child("collider")->asNode()->create("ContactJointHandler"), "contactBounceMode", false);
    IRigidBody& body = host.body(box);
    // A force in each cycle that friction resists. Forces must not accumulate while the body sleeps.
    for (int i = 0; i < 50; ++i) {
      body.addForce({3, 0, 0});
      host.step();
    }
    CHECK(std::abs(body.state().position.x()) < 2e-3);
    host.step(15);
    CHECK_FALSE(body.enabled());
    // A force acts in all steps of a cycle.
    IRigidBody& flying = host.body(host.thing("flying", {5, 0, 50}));
    flying.addForce({2, 0, 0});
    host.step();
    CHECK(flying.state().linearVelocity.x() == Approx(2 * 0.02).epsilon(1e-6));
    host.step();
    CHECK(flying.state().linearVelocity.x() == Approx(2 * 0.02).epsilon(1e-6));
    CHECK(flying.state().linearVelocity.z() == Approx(-9.81 * 0.04).epsilon(1e-6));
  }
}

TEST_CASE("a part that no body can have is refused") {
  PhysicsHost host;
  Leaf& body = *host.thing("thing", {0, 0, 1}).child("body");
  const auto add = [&](double mass, double x, double moment, double w) {
    PhysicsHost::call(body, "addPart", {mass, x, 0.0, 0.0, moment, 1.0, 1.0, 0.0, 0.0, 0.0, List{w, 0.0, 0.0, 0.0}});
  };
  for (const double bad : {-1.0, HUGE_VAL, std::nan("")}) {
    CAPTURE(bad);
    CHECK_THROWS_AS(add(bad, 0, 1, 1), Error);
    CHECK_THROWS_AS(add(1, 0, bad, 1), Error);
    if (!std::isfinite(bad)) CHECK_THROWS_AS(add(1, bad, 1, 1), Error);
  }
  CHECK_THROWS_AS(add(1, 0, 1, 2), Error);
  CHECK_NOTHROW(add(1, 0, 1, 1));
}
