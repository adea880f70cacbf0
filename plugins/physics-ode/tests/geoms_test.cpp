#include <Eigen/Geometry>

#include "engine_fixture.h"

using namespace spark;
using namespace spark::test;
using engine::Shape;
using engine::ShapeDescription;
using physics::BodyHandle;

namespace {

/// A shape of half height 0.5 with a flat or round top and bottom, by name.
ShapeDescription shapeOf(const std::string& name) {
  if (name == "box") return box(1, 1, 1);
  if (name == "sphere") return round(Shape::sphere, 0.5);
  if (name == "capsule") return round(Shape::capsule, 0.3, 0.4);
  if (name == "cylinder") return round(Shape::cylinder, 0.5, 1);
  if (name == "mesh") return mesh(1);
  return plane(0, 0, 1, 0.5);
}
const std::vector<std::string> kSolids{"box", "sphere", "capsule", "cylinder", "mesh"};

/// Deepest contact of the last detection.
double deepest(const engine::Contacts& contacts) {
  double d = 0;
  for (const auto& c : contacts) d = std::max(d, c.depth);
  return d;
}

}  // namespace

TEST_CASE("every pair of solids that overlap a little in z touches with a normal along z, and does not when apart") {
  for (const auto& first : kSolids)
    for (const auto& second : kSolids) {
      EngineHost house;
      house.setGravity(0);
      INFO(first << " above " << second);
      const bool meshes = first == "mesh" && second == "mesh";  // ODE finds them, with rough normals
      // Off the axis and turned a little, so that no special case of edges and corners decides.
      const BodyHandle upper = house.body({0.05, 0.03, 0.97});
      house.world.setRotation(upper, Mat3(Eigen::AngleAxisd(0.2, Vec3::UnitZ())));
      const physics::GeomHandle a = house.geom(shapeOf(first), upper);
      house.geom(shapeOf(second));
      house.detect(4);
      REQUIRE_FALSE(house.contacts.empty());
      CHECK(house.contacts.size() <= 4);
      for (const auto& c : house.contacts) {
        CHECK(c.geomA == house.world.index(a));
        if (!meshes) CHECK(c.normal.z() > 0.95);
        CHECK(c.normal.norm() == Approx(1).epsilon(1e-6));
      }
      if (!meshes) CHECK(deepest(house.contacts) == Approx(0.03).margin(0.01));
      house.contacts.clear();
      house.world.setPosition(upper, {0.05, 0.03, 1.05});
      house.detect(4);
      CHECK(house.contacts.empty());
    }
}

TEST_CASE("every solid rests on a plane and on every other solid for a second") {
  auto grounds = kSolids;
  grounds.push_back("plane");
  for (const auto& first : kSolids)
    for (const auto& second : grounds) {
      // Round on round rolls off; what is tested here is that the solver holds what lies flat.
      if ((first == "sphere" || first == "capsule") && (second == "sphere" || second == "capsule")) continue;
      EngineHost house;
      house.setGravity(9.81);
      INFO(first << " on " << second);
      const BodyHandle b = house.body({0, 0, 1.0});
      house.geom(shapeOf(first), b);
      house.geom(shapeOf(second));
      for (int i = 0; i < 50; ++i) house.step();
      CHECK(house.position(b).z() == Approx(1.0).margin(0.06));
      CHECK(house.world.repaired().empty());
    }
}

TEST_CASE("a ray meets every solid and the plane at its distance") {
  auto targets = kSolids;
  targets.push_back("plane");
  for (const auto& name : targets)
    for (const bool attached : {false, true}) {
      EngineHost house;
      INFO("ray down on " << name << (attached ? ", on a body" : ", static"));
      const BodyHandle carrier = attached ? house.body({0.05, 0.02, 1.0}) : BodyHandle::none;
      // From 2 m above the origin down: the surface is 1.5 m away.
      house.geom(ray(attached ? Vec3(0, 0, 1.0) : Vec3(0.05, 0.02, 2.0), {0, 0, -1}, 3), carrier);
      house.geom(shapeOf(name));
      house.detect(4);
      REQUIRE_FALSE(house.contacts.empty());
      CHECK(house.contacts.front().depth == Approx(1.5).margin(0.01));
      CHECK(house.contacts.front().position.z() == Approx(0.5).margin(0.01));
    }
}

TEST_CASE("rays and planes do not meet their like") {
  EngineHost house;
  house.geom(plane(0, 0, 1, 0));
  house.geom(plane(1, 0, 0, 0));
  house.geom(ray({0, 0, 2}, {1, 0, 0}, 3), house.body({0, 0, 0}));
  house.geom(ray({1, -1, 2}, {0, 1, 0}, 3), house.body({0, 0, 0}));
  house.detect(4);
  for (const auto& c : house.contacts) CHECK(c.geomA != c.geomB);
  CHECK(house.contacts.size() <= 1);  // one of the rays runs into the plane x = 0
}

TEST_CASE("a geom at an offset collides where it is, on a body and in the world, for every shape") {
  for (const auto& name : kSolids) {
    EngineHost house;
    house.setGravity(0);
    INFO(name);
    house.geom(box(1, 1, 1));
    const BodyHandle b = house.body({0, 0, 5});
    house.world.setRotation(b, Mat3(Eigen::AngleAxisd(kPi, Vec3::UnitX())));
    // Upside down, an offset up is 4 m lower than the body.
    const physics::GeomHandle g = house.geom(shapeOf(name), b, {Vec3(0, 0, 4.02), Mat3::Identity()});
    CHECK(house.world.pose(g).position.z() == Approx(0.98));
    house.detect(4);
    CHECK_FALSE(house.contacts.empty());
    house.world.destroyBody(b);
    CHECK(house.world.pose(g).position.z() == Approx(0.98));
    house.world.setPose(g, {Vec3(0, 0, 7), Mat3::Identity()});
    CHECK(house.world.pose(g).position.z() == 7);
  }
}

TEST_CASE("a plane stays where its numbers put it, whatever body it is attached to") {
  EngineHost house;
  house.setGravity(0);
  const BodyHandle carrier = house.body({0, 0, 10}), b = house.body({0, 0, 0.45});
  const auto ground = house.geom(plane(0, 0, 2, 0), carrier);  // a normal of length 2
  house.world.setPose(ground, {Vec3(0, 0, 3), Mat3::Identity()});
  house.geom(box(1, 1, 1), b);
  house.detect(4);
  REQUIRE(house.contacts.size() == 4);
  CHECK(house.contacts[0].depth == Approx(0.05));
  CHECK(house.contacts[0].geomB == house.world.index(ground));
}

TEST_CASE("a shape can change, and collide or not") {
  EngineHost house;
  house.setGravity(0);
  const BodyHandle b = house.body({0, 0, 2});
  const auto g = house.geom(round(Shape::sphere, 0.5), b);
  house.geom(plane(0, 0, 1, 0));
  house.detect(4);
  CHECK(house.contacts.empty());
  house.world.setShape(g, round(Shape::sphere, 2.5));
  house.detect(4);
  CHECK(house.contacts.size() == 1);
  house.contacts.clear();
  house.world.setCollides(g, false);
  house.world.setShape(g, box(5, 5, 5));
  house.detect(4);
  CHECK(house.contacts.empty());
  house.world.setCollides(g, true);
  house.detect(4);
  CHECK(house.contacts.size() == 4);
}

TEST_CASE("geoms of one body, and bodies with a joint, do not collide") {
  EngineHost house;
  house.setGravity(0);
  const BodyHandle a = house.body({0, 0, 0}), b = house.body({0.5, 0, 0}), c = house.body({0.9, 0, 0});
  house.geom(box(1, 1, 1), a);
  house.geom(box(1, 1, 1), a, {Vec3(0, 0, 0.1), Mat3::Identity()});
  house.geom(box(0.9, 0.9, 0.9), b);
  house.geom(box(0.9, 0.9, 0.9), c);
  const auto joint = house.world.createJoint(engine::JointType::hinge);
  house.world.attach(joint, a, b);
  house.detect(1);
  // a (two geoms) and b both still meet c.
  CHECK(house.contacts.size() == 3);
  house.contacts.clear();
  house.world.destroyJoint(joint);
  house.detect(1);
  CHECK(house.contacts.size() == 5);
}

TEST_CASE("a space collides its own geoms once, or not at all, and its geoms with those around") {
  EngineHost house;
  house.setGravity(0);
  const auto inner = house.world.createSpace(house.space);
  const auto put = [&](physics::SpaceHandle space, const Vec3& at) {
    house.world.setBody(house.world.createGeom(space, box(1, 1, 1), nullptr), house.body(at), {});
  };
  put(inner, {0, 0, 0});
  put(inner, {0.5, 0, 0});
  // Two things outside that both touch the inner space: its own pair must still come once.
  put(house.space, {0, 0.9, 0});
  put(house.space, {0, -0.9, 0});
  house.detect(1);
  CHECK(house.contacts.size() == 5);
  house.contacts.clear();
  house.world.setInnerCollision(inner, false);
  house.detect(1);
  CHECK(house.contacts.size() == 4);
}

TEST_CASE("the filter refuses pairs and is given the owners") {
  EngineHost house;
  house.setGravity(0);
  int first = 1, second = 2, third = 3;
  for (int* owner : {&first, &second, &third})
    house.world.setBody(house.world.createGeom(house.space, box(1, 1, 1), owner), house.body({0, 0, *owner * 0.1}), {});
  const auto odd = [](void* a, void* b) { return *static_cast<int*>(a) % 2 == 1 && *static_cast<int*>(b) % 2 == 1; };
  house.detect(1, odd);
  REQUIRE(house.contacts.size() == 1);
  CHECK(house.contacts[0].ownerA == &third);  // the younger first
  CHECK(house.contacts[0].ownerB == &first);
}

TEST_CASE("shapes that cannot be are refused with a sentence") {
  EngineHost house;
  CHECK_THROWS_WITH(house.geom(box(1, -1, 1)), Catch::Contains("edge of a box"));
  CHECK_THROWS_WITH(house.geom(round(Shape::sphere, std::nan(""))), Catch::Contains("radius"));
  CHECK_THROWS_WITH(house.geom(plane(0, 0, 0, 1)), Catch::Contains("normal"));
  CHECK_THROWS_WITH(house.geom(ray({0, 0, 0}, {0, 0, 0}, 1)), Catch::Contains("direction"));
  auto m = mesh(1);
  m.triangles[3] = 99;
  CHECK_THROWS_WITH(house.geom(m), Catch::Contains("vertex 99 of 8"));
  CHECK_THROWS_WITH(house.geom(ShapeDescription{.shape = Shape::mesh}), Catch::Contains("three numbers a vertex"));
}

TEST_CASE("a contact's force is the weight it carries, on whichever side the body is") {
  EngineHost house;
  house.setGravity(9.81);
  const BodyHandle b = house.body({0, 0, 0.4995});
  house.world.setMass(b, {3.0, Vec3::Zero(), Mat3::Identity() * 0.5});
  house.geom(box(1, 1, 1), b);
  house.geom(plane(0, 0, 1, 0));
  double sum = 0;
  for (int i = 0; i < 100; ++i) {
    house.contacts.clear();
    house.detect(4);
    for (auto& c : house.contacts) c.solve = c.feedback = true;
    house.world.step(house.engine, house.contacts, 0.02);
  }
  for (const auto& c : house.contacts) sum += c.forceOnA.z();
  CHECK(sum == Approx(3 * 9.81).epsilon(0.01));
}
