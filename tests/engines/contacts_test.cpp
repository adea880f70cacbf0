#include <map>
#include <set>

#include "../../plugins/physics-mujoco/mujoco_nodes.h"
#include "engine_world.h"

// Contacts, in each engine.

using namespace spark;
using namespace spark::test;

TEST_CASE("two colliders have at most contactsPerPair contacts, and a box rests on two of them") {
  withEngines([](EngineWorld& w) {
    w.ground();
    w.block({0, 0, 0.499}, {1, 1, 1});
    w.block({0, 0, 1.497}, {1, 1, 1});
    for (const int most : {1, 2, 4, 16}) {
      w.most = most;
      w.touch();
      std::map<std::pair<engine::Index, engine::Index>, int> count;
      for (const engine::Contact& c : w.contacts) ++count[{c.geomA, c.geomB}];
      REQUIRE(count.size() == 2);
      for (const auto& [pair, n] : count) CHECK((most < 4 ? n == most : n >= 4 && n <= most));
    }
  });
}

TEST_CASE("contacts beyond contactsPerPair have no effect") {
  withEngines([](EngineWorld& w) {
    if (!w.can.rotation) return;
    w.ground();
    const BodyHandle b = w.block({0, 0, 0.499}, {1, 1, 1});
    w.most = 1;
    w.run(5 * w.dt);
    CHECK(w.spin(b).norm() > 0.01);  // it stands on one corner, and tips over
  });
}

TEST_CASE("friction decelerates a sliding box until it stops") {
  withEngines(
      [](EngineWorld& w) {
        w.ground();
        w.surface.pyramid = true;
        w.surface.mu = 0.4;
        const BodyHandle b = w.block({0, 0, 0.1}, {0.6, 0.6, 0.2}, 2);
        w.world.setLinearVelocity(b, {3, 0, 0});
        w.run(0.4);
        CHECK(w.velocity(b).x() == Approx(3 - 0.4 * 9.81 * 0.4).epsilon(0.03));
        w.run(1);
        CHECK(w.velocity(b).norm() < 0.01);
        CHECK(w.position(b).x() == Approx(9 / (2 * 0.4 * 9.81)).epsilon(0.03));
      },
      {&engine::Capabilities::surfaces});
}

TEST_CASE("a stack of boxes is stable, and its contacts carry the weight above them") {
  withEngines([](EngineWorld& w) {
    w.ground();
    std::vector<BodyHandle> stack;
    for (int i = 0; i < 5; ++i) stack.push_back(w.block({0, 0, 0.2 + 0.4 * i}, {0.4, 0.4, 0.4}, 1 + i));
    w.run(3);
    for (int i = 0; i < 5; ++i) CHECK((w.position(stack[i]) - Vec3(0, 0, 0.2 + 0.4 * i)).norm() < 0.02);
    std::vector<double> carried(5, 0);
    for (const engine::Contact& c : w.contacts) {
      const engine::Index lower = c.bodyB == engine::kNone ? c.bodyA : std::min(c.bodyA, c.bodyB);
      const engine::Index upper = c.bodyB == engine::kNone ? c.bodyA : std::max(c.bodyA, c.bodyB);
      carried[upper] += std::abs(c.forceOnA.z());
      CHECK(lower <= upper);
    }
    double above = 0;
    for (int i = 5; i-- > 0;) {
      above += (1 + i) * 9.81;
      CHECK(carried[i] == Approx(above).epsilon(0.02));
    }
  });
}

TEST_CASE("a ball bounces to the height that its restitution gives") {
  withEngines(
      [](EngineWorld& w) {
        for (const double bounce : {0.0, 0.5, 0.8}) {
          INFO(bounce);
          EngineWorld own(w.kind);
          own.ground();
          own.dt = 0.002;
          own.surface.bounceOn = bounce > 0;
          own.surface.bounce = bounce;
          own.surface.bounceVelocity = 0.1;
          const BodyHandle b = own.sphere({0, 0, 1.1}, 0.1);
          double highest = 0;
          own.run(0.46);  // it falls 1 m in 0.45 s
          for (int i = 0; i < 400; ++i) {
            own.run(own.dt);
            highest = std::max(highest, own.position(b).z());
          }
          CHECK(highest - 0.1 == Approx(bounce * bounce).margin(0.03));
        }
      },
      {&engine::Capabilities::surfaces});
}

TEST_CASE("the parts of a body do not collide with each other, and fall as one") {
  // The body's centre of mass counts, also where that of the parts is beside it.
  const double beside = GENERATE(0, 0.4);
  withEngines([beside](EngineWorld& w) {
    CAPTURE(beside);
    const BodyHandle b = w.body({0, 0, 5});
    const Mat3 inertia = Mat3::Identity() * 0.01;
    w.world.setParts(b, {{0.5, {beside - 0.1, 0, 0}, inertia}, {0.5, {beside + 0.1, 0, 0}, inertia}});
    for (const int part : {0, 1}) {
      const GeomHandle g =
          w.geom({.shape = Shape::sphere, .radius = 0.2}, b, {Vec3(part ? 0.1 : -0.1, 0, 0), Mat3::Identity()});
      w.world.setPart(g, part);
    }
    w.run(0.1);
    CHECK(w.contacts.empty());
    CHECK(w.velocity(b).z() == Approx(-0.981));
    CHECK(std::abs(w.position(b).x()) < 1e-12);
    w.sphere(w.position(b), 0.2);  // another body does collide
    w.run(w.dt);
    CHECK_FALSE(w.contacts.empty());
  });
}

TEST_CASE("a contact knows its geoms, bodies and owners, and its normal points into A") {
  withEngines([](EngineWorld& w) {
    int groundOwner = 0, ballOwner = 0;
    const GeomHandle floor = w.geom({.shape = Shape::plane}, BodyHandle::none, {}, &groundOwner);
    const BodyHandle b = w.body({0, 0, 0.09});
    const GeomHandle round = w.geom({.shape = Shape::sphere, .radius = 0.1}, b, {}, &ballOwner);
    w.touch();
    REQUIRE(w.contacts.size() == 1);
    const engine::Contact& c = w.contacts[0];
    const bool first = c.geomA == w.world.index(round);
    CHECK((first ? c.geomB : c.geomA) == w.world.index(floor));
    CHECK((first ? c.bodyA : c.bodyB) == w.world.index(b));
    CHECK((first ? c.bodyB : c.bodyA) == engine::kNone);
    CHECK((first ? c.ownerA : c.ownerB) == &ballOwner);
    CHECK((first ? c.ownerB : c.ownerA) == &groundOwner);
    CHECK(c.normal.z() == Approx(first ? 1 : -1));
    CHECK(c.depth == Approx(0.01));
  });
}

TEST_CASE("MuJoCo uses the friction and restitution parameters of the colliders") {
  for (const EngineKind& kind : kEngines) {
    if (std::string(kind.name) != "MujocoEngine" || !kind.built()) continue;
    EngineWorld w(kind);
    w.dt = 0.0025;
    const GeomHandle ground = w.geom({.shape = Shape::plane});
    const auto surface = [&w](GeomHandle geom, const mujoco::SurfaceNumbers& numbers) {
      engine::Blocks blocks;
      blocks.set(engine::Block::of(numbers));
      w.world.setBlocks(geom, blocks);
    };
    surface(ground, {.friction = {0.4, 0.005, 0.0001}});
    const BodyHandle b = w.body({0, 0, 0.1}, 2);
    surface(w.geom({.shape = Shape::box, .lengths = {0.6, 0.6, 0.2}}, b), {.friction = {0.2, 0.005, 0.0001}});
    w.world.setLinearVelocity(b, {3, 0, 0});
    w.run(0.4);
    CHECK(w.velocity(b).x() == Approx(3 - 0.4 * 9.81 * 0.4).epsilon(0.05));  // the larger friction of the two

    const BodyHandle ball = w.body({5, 0, 1.1});
    surface(w.geom({.shape = Shape::sphere, .radius = 0.1}, ball), {.priority = 1, .solref = {-2000, 0}});
    double highest = 0;
    w.run(0.6);
    for (int i = 0; i < 240; ++i) {
      w.run(w.dt);
      highest = std::max(highest, w.position(ball).z());
    }
    CHECK(highest > 0.6);
  }
}

TEST_CASE("contact forces are measured also if the state of a body was set before the step") {
  withEngines([](EngineWorld& w) {
    w.ground();
    const BodyHandle b = w.block({0, 0, 0.199}, {0.4, 0.4, 0.4}, 3), other = w.body({9, 0, 9});
    w.run(1);
    for (int i = 0; i < 20; ++i) {
      w.world.setLinearVelocity(other, {0, 0, 1});
      w.run(w.dt);
    }
    double sum = 0;
    for (const engine::Contact& c : w.contacts) sum += std::abs(c.forceOnA.z());
    CHECK(sum == Approx(3 * 9.81).epsilon(0.02));
    CHECK(w.position(b).z() == Approx(0.2).margin(0.01));
  });
}

TEST_CASE(
    "bodies that a joint connects do not collide, through connectors neither, but with the static world they do") {
  // Spheres of radius 0.2 that overlap: a at the origin, b beside it, a connector between them, and a static one.
  const auto pairs = [](EngineWorld& w) {
    w.detect();
    std::set<std::pair<bool, bool>> found;
    for (const engine::Contact& c : w.contacts) found.insert({c.bodyA != engine::kNone, c.bodyB != engine::kNone});
    return std::pair{found.count({true, true}) > 0, found.count({true, false}) > 0};
  };
  for (const bool between : {false, true})
    withEngines(
        [&](EngineWorld& w) {
          CAPTURE(between);
          w.setGravity(0);
          const BodyHandle a = w.sphere({0, 0, 0}, 0.2), b = w.sphere({0.3, 0, 0}, 0.2);
          w.geom({.shape = Shape::sphere, .radius = 0.2}, BodyHandle::none, {{0, 0.3, 0}, Mat3::Identity()});
          CHECK(pairs(w) == std::pair{true, true});
          JointHandle last;
          if (between) {
            const BodyHandle c = w.body({0.3, 0, 0}, 0.01, Mat3::Identity() * 1e-4);
            w.world.setConnector(c, true);
            w.joint(JointType::hinge, c, a, {0.15, 0, 0}, Vec3::UnitY());
            last = w.joint(JointType::hinge, b, c, {0.15, 0, 0}, Vec3::UnitZ());
          } else {
            last = w.joint(JointType::hinge, b, a, {0.15, 0, 0});
          }
          w.joint(JointType::hinge, a, BodyHandle::none, {0, 0, 0});
          CHECK(pairs(w) == std::pair{false, true});
          engine::WorldParameters p = w.world.model().parameters;
          p.joinedCollide = true;
          w.world.setParameters(p);
          CHECK(pairs(w) == std::pair{true, true});
          p.joinedCollide = false;
          w.world.setParameters(p);
          w.world.destroyJoint(last);
          CHECK(pairs(w) == std::pair{true, true});
        },
        {&engine::Capabilities::joints});
}
