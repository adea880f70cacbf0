#include "../../plugins/physics/queries.h"
#include "engine_world.h"

// Worlds whose structure changes between steps.

using namespace spark;
using namespace spark::test;

namespace {

/// A world to which a test adds bodies and joints, and from which it removes them, between steps.
struct Traffic {
  EngineWorld& w;
  std::vector<BodyHandle> bodies;
  std::vector<JointHandle> joints;
  int made = 0;
  explicit Traffic(EngineWorld& world) : w(world) {
    w.setGravity(9.81, true);
    w.ground();
  }
  void add() {
    const double x = 0.35 * (made % 5), y = 0.3 * (made % 3);
    const BodyHandle a = w.block({x, y, 1.0 + 0.1 * (made % 7)}, {0.3, 0.2, 0.25});
    bodies.push_back(a);
    if (++made % 3 == 0 && bodies.size() > 1) {
      const BodyHandle other = bodies[bodies.size() - 2];
      const JointHandle j = w.joint(JointType::hinge, a, other, (w.position(a) + w.position(other)) / 2, Vec3::UnitY());
      w.motor(j, 0, 0.5, 2);
      joints.push_back(j);
    }
  }
  void removeBody(std::size_t i) {
    w.world.destroyBody(bodies[i]);  // its geom remains as a static one
    bodies.erase(bodies.begin() + static_cast<std::ptrdiff_t>(i));
  }
  bool sound() const {
    for (const BodyHandle b : bodies)
      if (!w.position(b).allFinite() || w.position(b).norm() > 100) return false;
    return true;
  }
};

}  // namespace

TEST_CASE("a destroyed space leaves the model with the next step") {
  withEngines([](EngineWorld& w) {
    const physics::SpaceHandle space = w.world.createSpace(physics::SpaceHandle::none);
    w.run(w.dt);
    const std::size_t before = w.world.model().spaces.size();
    w.world.destroySpace(space);
    w.run(w.dt);
    CHECK(w.world.model().spaces.size() == before - 1);
  });
}

TEST_CASE("bodies, geoms and joints can be created and destroyed between any two steps") {
  withEngines([](EngineWorld& w) {
    Traffic t(w);
    for (int i = 0; i < 120; ++i) {
      if (i % 4 == 0) t.add();
      if (i % 9 == 5 && t.bodies.size() > 3) t.removeBody(static_cast<std::size_t>(i) % t.bodies.size());
      if (i % 13 == 7 && !t.joints.empty()) {
        w.world.destroyJoint(t.joints.back());
        t.joints.pop_back();
      }
      if (i % 17 == 3) {  // created and destroyed before the engine sees it
        const BodyHandle b = w.block({0, 0, 9}, {1, 1, 1});
        w.world.destroyBody(b);
      }
      if (i % 11 == 2 && !t.bodies.empty()) w.world.setPosition(t.bodies[0], {0, 0, 2});
      w.run(w.dt);
      REQUIRE(t.sound());
    }
    CHECK(t.bodies.size() > 10);
  });
}

TEST_CASE("contacts can be removed between detection and step") {
  withEngines(
      [](EngineWorld& w) {
        w.ground();
        const BodyHandle resting = w.block({0, 0, 0.499}, {1, 1, 1});
        if (w.can.late) return;
        w.detect();
        REQUIRE(w.contacts.size() == 4);
        w.contacts.clear();
        w.step();
        CHECK(w.velocity(resting).z() < 0);
      },
      {&engine::Capabilities::surfaces});
}

TEST_CASE("the engine and the collision detection can be replaced at any time, and the world continues bit for bit") {
  withEngines(
      [](EngineWorld& w) {
        EngineWorld other(w.kind);
        Traffic same(other), changed(w);
        for (int i = 0; i < 60; ++i) {
          if (i % 5 == 0) same.add(), changed.add();
          if (i % 7 == 3) w.replaceEngine();
          if (i % 11 == 6) w.replaceCollision();
          other.run(other.dt);
          w.run(w.dt);
          REQUIRE(w.saved(changed.bodies) == other.saved(same.bodies));
        }
      },
      {&engine::Capabilities::stateless});
}

TEST_CASE("a world may be destroyed before its engine, and an engine before the world") {
  withEngines([](EngineWorld& w) {
    {
      physics::WorldModel second;
      physics::Stepper stepper(second);
      const BodyHandle b = second.createBody();
      engine::Contacts none;
      stepper.detect(*w.engine, w.collision, nullptr, 4, none);
      stepper.step(*w.engine, none, 0.01, &w);
      CHECK(second.state(b).position.z() < 0);
    }
    w.run(0.1);
    w.replaceCollision();
    w.replaceEngine();
    w.run(0.1);
  });
}

TEST_CASE("two worlds with the same inputs give identical results") {
  withEngines([](EngineWorld& w) {
    EngineWorld other(w.kind);
    Traffic a(w), b(other);
    for (int i = 0; i < 10; ++i) a.add();
    w.run(0.5);
    for (int i = 0; i < 10; ++i) b.add();
    other.run(0.5);
    CHECK(w.saved(a.bodies) == other.saved(b.bodies));
  });
}

TEST_CASE("engines tolerate degenerate shapes and extreme masses") {
  withEngines([](EngineWorld& w) {
    w.ground();
    const BodyHandle fine = w.block({3, 0, 2}, {0.4, 0.4, 0.4});
    const BodyHandle odd = w.body({0, 0, 2}, 1e-12, Mat3::Identity() * 1e-18);
    w.geom({.shape = Shape::box, .lengths = {0, 0, 0}}, odd);
    w.geom({.shape = Shape::sphere, .radius = 0}, odd);
    w.geom({.shape = Shape::cylinder, .radius = 1e6, .length = 0}, w.body({0, 0, 50}, 1e9, Mat3::Identity() * 1e12));
    // A mesh of one triangle, and one of points in a line.
    w.geom(meshOf({{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 2}}), w.body({5, 5, 5}));
    w.geom(meshOf({{0, 0, 0, 1, 0, 0, 2, 0, 0}, {0, 1, 2}}), w.body({-5, 5, 5}));
    w.run(0.2);
    CHECK(w.position(fine).allFinite());
    CHECK(w.position(odd).allFinite());
  });
}

TEST_CASE("contacts that are not to be solved exert no force, even if the world changes after detection") {
  withEngines([](EngineWorld& w) {
    w.setGravity(0);
    w.geom({.shape = Shape::box, .lengths = {1, 1, 1}});
    const BodyHandle ghost = w.sphere({0.1, 0, 0}, 0.3), other = w.body({5, 0, 0});
    w.solve = false;
    for (int i = 0; i < 20; ++i) {
      w.detect();
      if (i == 5) w.world.setMass(other, {2, Vec3::Zero(), Mat3::Identity()});
      if (i == 10) w.world.setPosition(other, {6, 0, 0});
      w.stepper.step(*w.engine, w.contacts, i < 15 ? w.dt : w.dt / 2, &w);
      REQUIRE_FALSE(w.contacts.empty());
    }
    CHECK(w.velocity(ghost).norm() < 1e-6);
  });
}

TEST_CASE("a ray does not hit a removed geom, even before the next step") {
  EngineWorld w(kEngines[0]);
  const GeomHandle g = w.geom({.shape = Shape::sphere, .radius = 1});
  const auto hit = [&] {
    return physics::castRay(w.world.model(), w.world.state(), {0, 0, 5}, -Vec3::UnitZ(), 10, {}).has_value();
  };
  CHECK(hit());
  w.world.destroyGeom(g);
  CHECK_FALSE(hit());
}

TEST_CASE("while MuJoCo compiles a large world in the background, only the unchanged bodies move") {
  for (const EngineKind& kind : kEngines) {
    if (std::string(kind.name) != "MujocoEngine" || !kind.built()) continue;
    std::vector<double> heights;
    for (int run = 0; run < 2; ++run) {
      EngineWorld w(kind);
      setProperty(w.engine->leaf(), "atOnce", 0);
      w.ground();
      const BodyHandle first = w.body({0, 0, 50}), removed = w.body({2, 0, 50}), third = w.body({4, 0, 50});
      const JointHandle joint = w.joint(JointType::hinge, third, first, {2, 0, 50});
      w.run(0.1);
      const double before = w.position(third).z();
      const auto compilations = [&] { return getProperty(w.engine->leaf(), "compilations").toInteger(); };
      const std::int64_t atFirst = compilations();
      // One body is removed and one is added: indices shift, and contacts of the removed body's geoms have no body.
      w.world.destroyBody(removed);
      const BodyHandle added = w.body({6, 0, 50});
      w.run(w.dt);
      CHECK(w.position(added).z() == 50);
      CHECK(w.position(third).z() < before);
      const double speed = w.velocity(third).z();
      w.world.control(joint, 0, {.force = 0.5});
      w.run(0.2);
      CHECK(w.position(added).z() < 50);
      CHECK(w.velocity(third).z() == Approx(speed - 9.81 * 0.2).epsilon(0.05));
      CHECK(compilations() == atFirst + 1);
      // A tree whose joint is removed stops until the new model is compiled.
      w.world.destroyJoint(joint);
      w.run(0.5);
      CHECK(compilations() == atFirst + 2);
      heights.push_back(w.position(third).z());
      heights.push_back(w.position(added).z());
    }
    CHECK(heights[0] == heights[2]);
    CHECK(heights[1] == heights[3]);
  }
}
