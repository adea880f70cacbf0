#include <Eigen/Geometry>

#include "../ode_collision.h"
#include "engine_fixture.h"

using namespace spark;
using namespace spark::test;
using engine::Shape;
using engine::ShapeDescription;
using physics::BodyHandle;

namespace {

/// The shape with this name. Its top is at z = 0.5.
ShapeDescription shapeOf(const std::string& name) {
  if (name == "box") return box(1, 1, 1);
  if (name == "sphere") return round(Shape::sphere, 0.5);
  if (name == "capsule") return round(Shape::capsule, 0.3, 0.4);
  if (name == "cylinder") return round(Shape::cylinder, 0.5, 1);
  if (name == "mesh") return mesh(1);
  if (name == "convex") return {.shape = Shape::convex, .mesh = mesh(1).mesh};
  return plane(0, 0, 1, 0.5);
}
const std::vector<std::string> kSolids{"box", "sphere", "capsule", "cylinder", "mesh", "convex"};

/// Depth of the deepest contact of the last detection.
double deepest(const engine::Contacts& contacts) {
  double d = 0;
  for (const auto& c : contacts) d = std::max(d, c.depth);
  return d;
}

}  // namespace

TEST_CASE("each pair of solids has contacts with normals along z if they overlap in z, and none if they are apart") {
  for (const auto& first : kSolids)
    for (const auto& second : kSolids) {
      EngineHost host;
      host.setGravity(0);
      INFO(first << " above " << second);
      // ODE's normals are inaccurate for two meshes, and for a mesh that lies on a hull.
      const bool meshes = first == "mesh" && (second == "mesh" || second == "convex");
      // Slightly shifted and rotated to avoid special cases of edges and corners.
      const BodyHandle upper = host.body({0.05, 0.03, 0.97});
      host.world.setRotation(upper, Mat3(Eigen::AngleAxisd(0.2, Vec3::UnitZ())));
      const physics::GeomHandle a = host.geom(shapeOf(first), upper);
      host.geom(shapeOf(second));
      host.detect(4);
      REQUIRE_FALSE(host.contacts.empty());
      CHECK(host.contacts.size() <= 4);
      for (const auto& c : host.contacts) {
        CHECK(c.geomA == host.world.index(a));
        if (!meshes) CHECK(c.normal.z() > 0.95);
        CHECK(c.normal.norm() == Approx(1).epsilon(1e-6));
      }
      if (!meshes) CHECK(deepest(host.contacts) == Approx(0.03).margin(0.01));
      host.contacts.clear();
      host.world.setPosition(upper, {0.05, 0.03, 1.05});
      host.detect(4);
      CHECK(host.contacts.empty());
    }
}

TEST_CASE("each solid rests on a plane and on each other solid for a second") {
  auto grounds = kSolids;
  grounds.push_back("plane");
  for (const auto& first : kSolids)
    for (const auto& second : grounds) {
      // A round body rolls off another one. This test is only about stable contacts.
      if ((first == "sphere" || first == "capsule") && (second == "sphere" || second == "capsule")) continue;
      EngineHost host;
      host.setGravity(9.81);
      INFO(first << " on " << second);
      const BodyHandle b = host.body({0, 0, 1.0});
      host.geom(shapeOf(first), b);
      host.geom(shapeOf(second));
      for (int i = 0; i < 50; ++i) host.step();
      CHECK(host.position(b).z() == Approx(1.0).margin(0.06));
      CHECK(host.stepper.repaired().empty());
    }
}

TEST_CASE("a ray hits each solid and the plane at the right distance") {
  auto targets = kSolids;
  targets.push_back("plane");
  for (const auto& name : targets)
    for (const bool attached : {false, true}) {
      EngineHost host;
      INFO("ray down on " << name << (attached ? ", on a body" : ", static"));
      const BodyHandle carrier = attached ? host.body({0.05, 0.02, 1.0}) : BodyHandle::none;
      // The ray starts 2 m above the origin and points down. The surface is 1.5 m away.
      host.geom(ray(attached ? Vec3(0, 0, 1.0) : Vec3(0.05, 0.02, 2.0), {0, 0, -1}, 3), carrier);
      host.geom(shapeOf(name));
      host.detect(4);
      REQUIRE_FALSE(host.contacts.empty());
      CHECK(host.contacts.front().depth == Approx(1.5).margin(0.01));
      CHECK(host.contacts.front().position.z() == Approx(0.5).margin(0.01));
    }
}

TEST_CASE("rays do not hit rays, and planes do not touch planes") {
  EngineHost host;
  host.geom(plane(0, 0, 1, 0));
  host.geom(plane(1, 0, 0, 0));
  host.geom(ray({0, 0, 2}, {1, 0, 0}, 3), host.body({0, 0, 0}));
  host.geom(ray({1, -1, 2}, {0, 1, 0}, 3), host.body({0, 0, 0}));
  host.detect(4);
  for (const auto& c : host.contacts) CHECK(c.geomA != c.geomB);
  CHECK(host.contacts.size() <= 1);  // one of the rays hits the plane x = 0
}

TEST_CASE("a geom of each shape collides at its offset, on a body and in the world") {
  for (const auto& name : kSolids) {
    EngineHost host;
    host.setGravity(0);
    INFO(name);
    host.geom(box(1, 1, 1));
    const BodyHandle b = host.body({0, 0, 5});
    host.world.setRotation(b, Mat3(Eigen::AngleAxisd(kPi, Vec3::UnitX())));
    // The body is upside down, so the geom is 4.02 m below it.
    const physics::GeomHandle g = host.geom(shapeOf(name), b, {Vec3(0, 0, 4.02), Mat3::Identity()});
    CHECK(host.world.pose(g).position.z() == Approx(0.98));
    host.detect(4);
    CHECK_FALSE(host.contacts.empty());
    host.world.destroyBody(b);
    CHECK(host.world.pose(g).position.z() == Approx(0.98));
    host.world.setPose(g, {Vec3(0, 0, 7), Mat3::Identity()});
    CHECK(host.world.pose(g).position.z() == 7);
  }
}

TEST_CASE("a plane is where its parameters say, even if it is attached to a body") {
  EngineHost host;
  host.setGravity(0);
  const BodyHandle carrier = host.body({0, 0, 10}), b = host.body({0, 0, 0.45});
  const auto ground = host.geom(plane(0, 0, 2, 0), carrier);  // a normal of length 2
  host.world.setPose(ground, {Vec3(0, 0, 3), Mat3::Identity()});
  host.geom(box(1, 1, 1), b);
  host.detect(4);
  REQUIRE(host.contacts.size() == 4);
  CHECK(host.contacts[0].depth == Approx(0.05));
  CHECK(host.contacts[0].geomB == host.world.index(ground));
}

TEST_CASE("the shape of a geom can be changed, and its collisions can be switched off and on") {
  EngineHost host;
  host.setGravity(0);
  const BodyHandle b = host.body({0, 0, 2});
  const auto g = host.geom(round(Shape::sphere, 0.5), b);
  host.geom(plane(0, 0, 1, 0));
  host.detect(4);
  CHECK(host.contacts.empty());
  host.world.setShape(g, round(Shape::sphere, 2.5));
  host.detect(4);
  CHECK(host.contacts.size() == 1);
  host.contacts.clear();
  host.world.setCollides(g, false);
  host.world.setShape(g, box(5, 5, 5));
  host.detect(4);
  CHECK(host.contacts.empty());
  host.world.setCollides(g, true);
  host.detect(4);
  CHECK(host.contacts.size() == 4);
}

TEST_CASE("geoms of one body do not collide, nor do bodies that share a joint") {
  EngineHost host;
  host.setGravity(0);
  const BodyHandle a = host.body({0, 0, 0}), b = host.body({0.5, 0, 0}), c = host.body({0.9, 0, 0});
  host.geom(box(1, 1, 1), a);
  host.geom(box(1, 1, 1), a, {Vec3(0, 0, 0.1), Mat3::Identity()});
  host.geom(box(0.9, 0.9, 0.9), b);
  host.geom(box(0.9, 0.9, 0.9), c);
  const auto joint = host.world.createJoint(engine::JointType::hinge);
  host.world.attach(joint, a, b);
  host.detect(1);
  // a (two geoms) and b still touch c.
  CHECK(host.contacts.size() == 3);
  host.contacts.clear();
  host.world.destroyJoint(joint);
  host.detect(1);
  CHECK(host.contacts.size() == 5);
}

TEST_CASE("geoms of a space collide once or not at all with each other, and with geoms outside of it") {
  EngineHost host;
  host.setGravity(0);
  const auto inner = host.world.createSpace(host.space);
  const auto put = [&](physics::SpaceHandle space, const Vec3& at) {
    host.world.setBody(host.world.createGeom(space, box(1, 1, 1), nullptr), host.body(at), {});
  };
  put(inner, {0, 0, 0});
  put(inner, {0.5, 0, 0});
  // Two geoms outside touch the inner space. The inner pair must still be reported only once.
  put(host.space, {0, 0.9, 0});
  put(host.space, {0, -0.9, 0});
  host.detect(1);
  CHECK(host.contacts.size() == 5);
  host.contacts.clear();
  host.world.setInnerCollision(inner, false);
  host.detect(1);
  CHECK(host.contacts.size() == 4);
}

TEST_CASE("the filter gets the owners of a pair and can refuse it") {
  EngineHost host;
  host.setGravity(0);
  int first = 1, second = 2, third = 3;
  for (int* owner : {&first, &second, &third})
    host.world.setBody(host.world.createGeom(host.space, box(1, 1, 1), owner), host.body({0, 0, *owner * 0.1}), {});
  const auto odd = [](void* a, void* b) { return *static_cast<int*>(a) % 2 == 1 && *static_cast<int*>(b) % 2 == 1; };
  host.detect(1, odd);
  REQUIRE(host.contacts.size() == 1);
  CHECK(host.contacts[0].ownerA == &third);  // the newer geom first
  CHECK(host.contacts[0].ownerB == &first);
}

TEST_CASE("invalid shapes are refused with an explanation") {
  EngineHost host;
  CHECK_THROWS_WITH(host.geom(box(1, -1, 1)), Catch::Contains("edge of a box"));
  CHECK_THROWS_WITH(host.geom(round(Shape::sphere, std::nan(""))), Catch::Contains("radius"));
  CHECK_THROWS_WITH(host.geom(plane(0, 0, 0, 1)), Catch::Contains("normal"));
  CHECK_THROWS_WITH(host.geom(ray({0, 0, 0}, {0, 0, 0}, 1)), Catch::Contains("direction"));
  engine::Mesh m = *mesh(1).mesh;
  const auto withMesh = [](engine::Mesh of) {
    return ShapeDescription{.shape = Shape::mesh, .mesh = std::make_shared<const engine::Mesh>(std::move(of))};
  };
  m.triangles[3] = 99;
  CHECK_THROWS_WITH(host.geom(withMesh(m)), Catch::Contains("vertex 99 of 8"));
  CHECK_THROWS_WITH(host.geom(withMesh({})), Catch::Contains("three numbers a vertex"));
  CHECK_THROWS_WITH(host.geom(ShapeDescription{.shape = Shape::mesh}), Catch::Contains("expected a mesh"));
}

TEST_CASE("the contact forces of a resting body add up to its weight") {
  EngineHost host;
  host.setGravity(9.81);
  const BodyHandle b = host.body({0, 0, 0.4995});
  host.world.setMass(b, {3.0, Vec3::Zero(), Mat3::Identity() * 0.5});
  host.geom(box(1, 1, 1), b);
  host.geom(plane(0, 0, 1, 0));
  double sum = 0;
  for (int i = 0; i < 100; ++i) {
    host.contacts.clear();
    host.detect(4);
    for (auto& c : host.contacts) c.solve = c.feedback = true;
    host.stepper.step(host.engine, host.contacts, 0.02);
  }
  for (const auto& c : host.contacts) sum += c.forceOnA.z();
  CHECK(sum == Approx(3 * 9.81).epsilon(0.01));
}

TEST_CASE("what lies flat on a convex hull has points at its corners, and ODE's single point does not tip it") {
  for (const std::string first : {"box", "convex", "cylinder"})
    for (const std::string second : {"box", "convex"}) {
      if (first != "convex" && second != "convex") continue;
      EngineHost host;
      INFO(first << " on " << second);
      host.geom(shapeOf(first), host.body({0.1, 0.2, 0.99}));
      host.geom(shapeOf(second));
      host.detect(4);
      REQUIRE(host.contacts.size() == 4);
      // They surround the middle of the upper one.
      Vec3 low = Vec3::Constant(9), high = -low;
      for (const auto& c : host.contacts) {
        low = low.cwiseMin(c.position), high = high.cwiseMax(c.position);
        CHECK(c.normal == Vec3::UnitZ());
        CHECK(c.depth == Approx(0.01));
      }
      CHECK(low.x() < -0.1);
      CHECK(high.x() > 0.35);
      CHECK(low.y() < 0);
      CHECK(high.y() > 0.35);
    }
}

TEST_CASE("a tilted hull touches with its lowest corner or edge alone") {
  EngineHost host;
  const BodyHandle b = host.body({0, 0, 0.5 + std::sqrt(0.5) - 0.01});
  host.world.setRotation(b, Mat3(Eigen::AngleAxisd(kPi / 4, Vec3::UnitX())));
  host.geom(shapeOf("convex"), b);
  host.geom(shapeOf("convex"));
  host.detect(8);
  REQUIRE(host.contacts.size() == 2);
  for (const auto& c : host.contacts) {
    CHECK(c.depth == Approx(0.01).margin(1e-4));
    CHECK(std::abs(c.position.x()) == Approx(0.5).margin(1e-6));
    CHECK(c.normal.z() == Approx(1));
  }
}

TEST_CASE("a height field has contacts with each solid, and none with another one or a plane") {
  engine::HeightField f{11, 7, 10, 6, std::vector<float>(77, 0.5f), 0.5f, 0.5f};
  const ShapeDescription field{.shape = Shape::heightField,
                               .heightField = std::make_shared<const engine::HeightField>(f)};
  for (const auto& name : kSolids) {
    EngineHost host;
    INFO(name);
    host.geom(shapeOf(name), host.body({0.3, 0.2, 0.98}));
    host.geom(field);
    host.detect(4);
    REQUIRE_FALSE(host.contacts.empty());
    for (const auto& c : host.contacts) CHECK(c.normal.z() == Approx(1));
    CHECK(deepest(host.contacts) == Approx(0.02).margin(1e-3));
  }
  EngineHost host;
  host.geom(field);
  host.geom(field);
  host.geom(plane(0, 0, 1, 0.6));
  host.detect(4);
  CHECK(host.contacts.empty());
  CHECK_THROWS_WITH(host.geom(field, host.body({0, 0, 0})), Catch::Contains("a height field has no body"));
}

TEST_CASE("a thousand geoms share ODE's data of one mesh, of one hull and of one height field") {
  EngineHost host;
  auto& detector = static_cast<ode::OdeDetector&>(host.collision.start(host.world.model()));
  const ShapeDescription shared = mesh(1), convex{.shape = Shape::convex, .mesh = shared.mesh};
  for (int i = 0; i < 500; ++i) {
    host.geom(shared, host.body({2.0 * i, 0, 0}));
    host.geom(convex, host.body({2.0 * i, 3, 0}));
  }
  detector.compile(host.world.model(), host.world.state(), {});
  CHECK(detector.world().geoms.size() == 1000);
  CHECK(detector.world().made.meshes.count() == 1);
  CHECK(detector.world().made.hulls.count() == 1);
  host.geom(mesh(1));  // equal numbers, but another object: WorldModel::meshes() shares those
  detector.compile(host.world.model(), host.world.state(), {});
  CHECK(detector.world().made.meshes.count() == 2);
}

TEST_CASE("triangles in one place, of both sides, are as one of each, however many there are") {
  // Comparing each of 300,000 with all others takes more than a minute.
  const auto contactsOn = [](int copies) {
    EngineHost host;
    engine::Mesh sheet{.vertices = {-2, -2, 0, 3, -2, 0, 0, 3, 0}, .triangles = {}};
    for (int i = 0; i < copies; ++i) sheet.triangles.insert(sheet.triangles.end(), {0, 1, 2, 0, 2, 1});
    host.geom({.shape = Shape::mesh, .mesh = std::make_shared<const engine::Mesh>(std::move(sheet))});
    host.geom(box(1, 1, 1), host.body({0, 0, 0.499}));
    host.detect();
    return host.contacts;
  };
  const engine::Contacts one = contactsOn(1), many = contactsOn(150'000);
  REQUIRE(one.size() == 4);
  REQUIRE(many.size() == 4);
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(many[i].position == one[i].position);
    CHECK(many[i].normal == Vec3(0, 0, 1));
    CHECK(many[i].depth == one[i].depth);
  }
}
