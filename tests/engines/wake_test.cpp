#include <functional>

#include "engine_world.h"

// What sleeps wakes when something changes that its rest depends on, in each engine. Engines without sleep pass the
// same tests: what counts is where the bodies go.

using namespace spark;
using namespace spark::test;

namespace {

/// A change of the world, and what it is.
template <class Scene>
struct Change {
  const char* name;
  std::function<void(Scene&)> make;
};

/// A world with sleep, and bodies that come to rest in it.
struct Resting : EngineWorld {
  std::vector<BodyHandle> bodies;
  explicit Resting(const EngineKind& k, bool exactReplay = false) : EngineWorld(k, exactReplay) {
    setGravity(9.81, true);
  }
  bool asleep() const {
    return std::none_of(bodies.begin(), bodies.end(), [&](BodyHandle b) { return world.enabled(b); });
  }
  /// Runs until all bodies sleep, or for the same time without sleep.
  void settle() {
    for (int i = 0; i < 300 && !asleep(); ++i) run(dt);
    run(dt);
    if (can.sleeps) REQUIRE(asleep());
  }
  /// A geom at rest in the world.
  GeomHandle board(const Vec3& at,
                   const engine::ShapeDescription& shape = {.shape = Shape::box, .lengths = {2, 2, 0.1}}) {
    const GeomHandle g = geom(shape);
    world.setPose(g, {at, Mat3::Identity()});
    return g;
  }
};

/// Two crates on each other, on a shelf of 2 m over the ground.
struct Shelf : Resting {
  GeomHandle shelf;
  BodyHandle lower, upper;
  explicit Shelf(const EngineKind& k, bool exactReplay = false) : Resting(k, exactReplay) {
    ground();
    shelf = board({0.9, 0, 1.95});
    lower = block({0, 0, 2.1995}, {0.4, 0.4, 0.4});
    upper = block({0, 0, 2.599}, {0.4, 0.4, 0.4});
    bodies = {lower, upper};
  }
};

/// A body on a slider along z, held 2 m over the ground by its lower stop.
struct Slider : Resting {
  BodyHandle load;
  JointHandle slider;
  explicit Slider(const EngineKind& k, bool reversed = false) : Resting(k) {
    load = body({0, 0, 2}, 1, Mat3::Identity() * 0.1);
    slider = world.createJoint(JointType::slider);
    reversed ? world.attach(slider, BodyHandle::none, load) : world.attach(slider, load, BodyHandle::none);
    world.setAxis(slider, 0, Vec3::UnitZ());
    stops(slider, 0, reversed ? -HUGE_VAL : 0, reversed ? 0 : HUGE_VAL);
    bodies = {load};
  }
  double height() const { return position(load).z(); }
};

/// Runs a test with each engine that has the capabilities `needs` and each change.
template <class Scene, class F>
void afterEach(const std::vector<Change<Scene>>& changes, F&& f,
               std::initializer_list<bool engine::Capabilities::*> needs = {}) {
  for (const EngineKind& kind : kEngines) {
    if (!kind.built()) continue;
    INFO(kind.name);
    for (const Change<Scene>& change : changes) {
      INFO(change.name);
      Scene scene(kind);
      if (!std::all_of(needs.begin(), needs.end(), [&](auto need) { return scene.can.*need; })) continue;
      scene.settle();
      change.make(scene);
      f(scene);
    }
  }
}

const engine::ShapeDescription kSmall{.shape = Shape::box, .lengths = {0.1, 0.1, 0.1}};

engine::ShapeDescription hills(float height) {
  engine::HeightField field{.columns = 2, .rows = 2, .heights = std::vector<float>(4, height)};
  field.width = field.depth = 4;
  field.low = field.high = height;
  return {.shape = Shape::heightField, .heightField = std::make_shared<const engine::HeightField>(std::move(field))};
}

}  // namespace

TEST_CASE("crates fall when what they rest on is removed, moved, resized, or does not collide any more") {
  afterEach<Shelf>(
      {{"removed", [](Shelf& s) { s.world.destroyGeom(s.shelf); }},
       {"moved",
        [](Shelf& s) {
          s.world.setPose(s.shelf, {{9, 0, 1.95}, Mat3::Identity()});
        }},
       {"lowered",
        [](Shelf& s) {
          s.world.setPose(s.shelf, {{0.9, 0, 0.5}, Mat3::Identity()});
        }},
       {"resized",
        [](Shelf& s) {
          s.world.setShape(s.shelf, {.shape = Shape::box, .lengths = {1, 2, 0.1}});
        }},
       {"collides with nothing", [](Shelf& s) { s.world.setCollides(s.shelf, false); }},
       {"collides with nothing inside its space", [](Shelf& s) { s.world.setInnerCollision(s.space, false); }},
       {"only listens", [](Shelf& s) { s.solve = false; }},
       {"another solver and then removed",
        [](Shelf& s) {
          s.replaceEngine();
          s.run(0.05);
          s.world.destroyGeom(s.shelf);
        }}},
      [](Shelf& s) {
        s.run(0.4);
        CHECK(s.position(s.lower).z() < 1.8);
        CHECK(s.position(s.upper).z() < 2.2);
      });
}

TEST_CASE("a crate falls when the one below it goes") {
  afterEach<Shelf>({{"moved by hand",
                     [](Shelf& s) {
                       s.world.setPosition(s.lower, {9, 0, 2.2});
                       s.world.setEnabled(s.lower, true);
                     }},
                    {"moved by hand, and still asleep",
                     [](Shelf& s) {
                       s.world.setPosition(s.lower, {9, 0, 2.2});
                     }}},
                   [](Shelf& s) {
                     s.run(0.2);
                     CHECK(s.position(s.upper).z() < 2.5);
                   });
}

TEST_CASE("a pile falls when its lowest crate is destroyed") {
  withEngines([](EngineWorld& any) {
    Resting s(any.kind);
    s.ground();
    std::vector<GeomHandle> crates;
    for (int i = 0; i < 4; ++i) {
      s.bodies.push_back(s.body({0, 0, 0.1995 + 0.399 * i}, 1, Mat3::Identity() * 0.03));
      crates.push_back(s.geom({.shape = Shape::box, .lengths = {0.4, 0.4, 0.4}}, s.bodies.back()));
    }
    s.settle();
    s.world.destroyGeom(crates.front());
    s.world.destroyBody(s.bodies.front());
    s.bodies.erase(s.bodies.begin());
    s.run(1);
    for (int i = 0; i < 3; ++i) CHECK(s.position(s.bodies[i]).z() == Approx(0.2 + 0.4 * i).margin(0.03));
  });
}

TEST_CASE("sleeping bodies move with a shelf that moves under them, step by step") {
  for (const double speed : {0.5, -0.5, 0.02, -0.02})
    withEngines([&](EngineWorld& any) {
      INFO(speed << " m/s");
      Shelf s(any.kind);
      s.settle();
      const double before = s.position(s.upper).z();
      double z = 1.95;
      for (int i = 0; i < 100; ++i) {
        s.world.setPose(s.shelf, {{0.9, 0, z += speed * s.dt}, Mat3::Identity()});
        s.run(s.dt);
      }
      CHECK(s.position(s.upper).z() == Approx(before + speed).margin(0.05));
    });
}

TEST_CASE("what appears inside of sleeping bodies pushes them out") {
  afterEach<Shelf>({{"a board that is made",
                     [](Shelf& s) {
                       s.board({0.3, 0, 2.2}, {.shape = Shape::sphere, .radius = 0.15});
                     }}},
                   [](Shelf& s) {
                     s.run(0.5);
                     CHECK(s.position(s.lower).x() < -0.03);
                   });
}

TEST_CASE("a ground of heights or triangles that is replaced lets bodies down") {
  const auto triangles = [](double height) {
    return meshOf(
        {.vertices = {-2, -2, height, 2, -2, height, 2, 2, height, -2, 2, height}, .triangles = {0, 1, 2, 0, 2, 3}});
  };
  for (const bool field : {true, false})
    withEngines(
        [&](EngineWorld& any) {
          INFO((field ? "heights" : "triangles"));
          Resting s(any.kind);
          s.ground();
          const GeomHandle floor = s.geom(field ? hills(1) : triangles(1));
          s.world.setPose(floor, {});
          s.bodies = {s.block({0.1, 0.2, 1.1995}, {0.4, 0.4, 0.4})};
          s.settle();
          s.world.setShape(floor, field ? hills(0.5) : triangles(0.5));
          s.run(1);
          CHECK(s.position(s.bodies[0]).z() == Approx(0.7).margin(0.03));
        },
        {&engine::Capabilities::meshes, &engine::Capabilities::heightFields});
}

TEST_CASE("sleeping bodies follow gravity, and their own switch of it") {
  afterEach<Shelf>({{"up", [](Shelf& s) { s.setGravity(-9.81, true); }},
                    {"to the side",
                     [](Shelf& s) {
                       engine::WorldParameters p = s.world.model().parameters;
                       p.gravity = {30, 0, 9.81};
                       s.world.setParameters(p);
                     }},
                    {"none, and a wind",
                     [](Shelf& s) {
                       for (const BodyHandle b : s.bodies) {
                         s.world.setGravityMode(b, false);
                         s.world.setLinearVelocity(b, {0, 0, 5});
                       }
                     }}},
                   [](Shelf& s) {
                     s.run(0.5);
                     CHECK(s.position(s.lower).z() > 2.3);
                     CHECK(s.position(s.upper).z() > 2.8);
                   });
}

TEST_CASE("a sleeping body slides when its surface loses friction") {
  withEngines(
      [](EngineWorld& any) {
        Shelf s(any.kind);
        engine::WorldParameters p = s.world.model().parameters;
        p.gravity = {2, 0, -9.81};
        s.world.setParameters(p);
        s.settle();
        const double before = s.position(s.upper).x();
        s.surface.mu = 0;
        s.run(0.5);
        CHECK(s.position(s.upper).x() > before + 0.1);
      },
      {&engine::Capabilities::surfaces});
}

TEST_CASE("bodies wake with mass, parameters and automatic sleep") {
  afterEach<Shelf>({{"mass",
                     [](Shelf& s) {
                       s.world.setMass(s.lower, {2, Vec3::Zero(), Mat3::Identity()});
                     }},
                    {"gravity", [](Shelf& s) { s.world.setGravityMode(s.lower, false); }},
                    {"no sleep", [](Shelf& s) { s.setGravity(9.81, false); }},
                    {"by hand", [](Shelf& s) { s.world.setEnabled(s.lower, true); }}},
                   [](Shelf& s) { CHECK(s.world.enabled(s.lower)); }, {&engine::Capabilities::sleeps});
}

TEST_CASE("a body falls when the joint that holds it is detached, destroyed or opened") {
  const std::vector<Change<Slider>> changes{
      {"destroyed", [](Slider& s) { s.world.destroyJoint(s.slider); }},
      {"detached", [](Slider& s) { s.world.attach(s.slider, BodyHandle::none, BodyHandle::none); }},
      {"other stops", [](Slider& s) { s.world.setParameter(s.slider, JointParameter::lowStop, 0, -5); }},
      {"another axis", [](Slider& s) {
         s.world.setAxis(s.slider, 0, Vec3(0, 1, -1));
         s.world.setParameter(s.slider, JointParameter::lowStop, 0, -5);
       }}};
  afterEach(changes,
            [](Slider& s) {
              s.run(0.5);
              CHECK(s.height() < 1.8);
            },
            {&engine::Capabilities::joints});
}

TEST_CASE("a sleeping body rises when its joint is driven") {
  for (const bool reversed : {false, true}) {
    const auto motor = [](Slider& s, double speed, double force) {
      s.world.setParameter(s.slider, JointParameter::maxForce, 0, force);
      s.world.setParameter(s.slider, JointParameter::velocity, 0, speed);
    };
    const double up = reversed ? -1 : 1;
    const std::vector<Change<Slider>> changes{
        {"a motor", [=](Slider& s) { motor(s, up, 100); }},
        {"drive",
         [=](Slider& s) {
           s.world.setParameter(s.slider, JointParameter::maxForce, 0, 100);
           s.world.drive(s.slider, 0, up);
         }},
        {"a controller",
         [=](Slider& s) { s.world.control(s.slider, 0, {.stiffness = 200, .damping = 20, .position = 0.5 * up}); }},
        {"a spring", [=](Slider& s) { s.world.setSpring(s.slider, 0, 200, 0.5 * up); }}};
    for (const EngineKind& kind : kEngines) {
      if (!kind.built()) continue;
      for (const Change<Slider>& change : changes) {
        INFO(kind.name << ": " << change.name << (reversed ? ", reversed" : ""));
        Slider s(kind, reversed);
        if (!s.can.joints) continue;
        s.settle();
        change.make(s);
        s.run(0.25);
        CHECK(s.height() > 2.15);
      }
    }
  }
}

TEST_CASE("a sleeping body sinks when its motor, controller or spring lets go") {
  const auto motor = [](Slider& s, double speed, double force) {
    s.world.setParameter(s.slider, JointParameter::lowStop, 0, -HUGE_VAL);
    s.world.setParameter(s.slider, JointParameter::maxForce, 0, force);
    s.world.setParameter(s.slider, JointParameter::velocity, 0, speed);
  };
  const auto hold = [](Slider& s, double position) {
    s.world.setParameter(s.slider, JointParameter::lowStop, 0, -HUGE_VAL);
    s.world.control(s.slider, 0, {.stiffness = 500, .damping = 40, .position = position});
  };
  const std::vector<Change<Slider>> changes{{"a motor that is weaker",
                                             [=](Slider& s) {
                                               motor(s, 0, 100);
                                               s.settle();
                                               s.world.setParameter(s.slider, JointParameter::maxForce, 0, 1);
                                             }},
                                            {"a controller with another target",
                                             [=](Slider& s) {
                                               hold(s, 0);
                                               s.settle();
                                               hold(s, -0.5);
                                             }},
                                            {"a controller that ends",
                                             [=](Slider& s) {
                                               hold(s, 0);
                                               s.settle();
                                               s.world.setParameter(s.slider, JointParameter::maxForce, 0, 0);
                                             }},
                                            {"a spring that is gone", [=](Slider& s) {
                                               s.world.setParameter(s.slider, JointParameter::lowStop, 0, -HUGE_VAL);
                                               s.world.setSpring(s.slider, 0, 300, 0);
                                               s.world.setParameter(s.slider, JointParameter::damping, 0, 20);
                                               s.run(2);
                                               s.settle();
                                               s.world.setSpring(s.slider, 0, 0, 0);
                                               s.world.setParameter(s.slider, JointParameter::damping, 0, 0);
                                             }}};
  afterEach(changes,
            [](Slider& s) {
              s.run(0.6);
              CHECK(s.height() < 1.8);
            },
            {&engine::Capabilities::joints});
}

TEST_CASE("what is joined to a body that wakes, wakes with it, and counts its idle time anew") {
  withEngines(
      [](EngineWorld& any) {
        Resting s(any.kind);
        const BodyHandle top = s.body({0, 0, 3}), bottom = s.body({0, 0, 2});
        const JointHandle hook = s.joint(JointType::ball, top, BodyHandle::none, {0, 0, 4});
        s.joint(JointType::ball, bottom, top, {0, 0, 2.5});
        s.bodies = {top, bottom};
        s.settle();
        s.dt = 0.0005;  // after one step the bodies are slow enough to sleep
        s.world.destroyJoint(hook);
        s.run(0.5);
        CHECK(s.position(top).z() == Approx(3 - 9.81 / 8).margin(0.01));
        CHECK(s.position(bottom).z() == Approx(2 - 9.81 / 8).margin(0.01));
      },
      {&engine::Capabilities::joints});
}

TEST_CASE("changes that a body does not rest on let it sleep") {
  afterEach<Shelf>({{"the same numbers",
                     [](Shelf& s) {
                       s.world.setParameters(s.world.model().parameters);
                       s.world.setPose(s.shelf, {{0.9, 0, 1.95}, Mat3::Identity()});
                       s.world.setShape(s.shelf, {.shape = Shape::box, .lengths = {2, 2, 0.1}});
                       s.world.setGravityMode(s.lower, true);
                     }},
                    {"a shelf that is made anew",
                     [](Shelf& s) {
                       s.world.destroyGeom(s.shelf);
                       s.board({0.9, 0, 1.95});
                     }},
                    {"others elsewhere",
                     [](Shelf& s) {
                       const GeomHandle far = s.board({9, 9, 2}, kSmall);
                       s.run(s.dt);
                       s.world.setPose(far, {{8, 8, 2}, Mat3::Identity()});
                       s.run(s.dt);
                       s.world.destroyGeom(far);
                       const BodyHandle other = s.block({-5, 0, 3}, {0.4, 0.4, 0.4});
                       s.world.setMass(other, {3, Vec3::Zero(), Mat3::Identity()});
                     }}},
                   [](Shelf& s) {
                     const Vec3 before = s.position(s.upper);
                     s.run(0.1);
                     CHECK(s.asleep());
                     CHECK(s.position(s.upper) == before);
                   },
                   {&engine::Capabilities::sleeps});
}

TEST_CASE("a joint that is given the numbers that it has lets its bodies sleep") {
  withEngines(
      [](EngineWorld& any) {
        Slider s(any.kind);
        s.settle();
        s.world.setParameter(s.slider, JointParameter::lowStop, 0, 0);
        s.world.setParameter(s.slider, JointParameter::maxForce, 0, 0);
        s.world.setParameter(s.slider, JointParameter::velocity, 0, 0);
        s.world.drive(s.slider, 0, 0);
        s.world.setSpring(s.slider, 0, 0, 0);
        s.world.setFeedback(s.slider, true);
        CHECK(s.asleep());
      },
      {&engine::Capabilities::joints, &engine::Capabilities::sleeps});
}

TEST_CASE("a body that was put to sleep by hand sleeps in the air, until what touches it changes") {
  withEngines(
      [](EngineWorld& any) {
        Resting s(any.kind);
        const BodyHandle b = s.block({0, 0, 2}, {0.4, 0.4, 0.4});
        s.world.setEnabled(b, false);
        s.run(0.2);
        CHECK_FALSE(s.world.enabled(b));
        s.board({0, 0, 1.77});
        s.run(0.05);
        CHECK(s.world.enabled(b));
      },
      {&engine::Capabilities::sleeps});
}

TEST_CASE("a body at rest in the air inside of a collider that only listens stays awake") {
  withEngines(
      [](EngineWorld& any) {
        Resting s(any.kind);
        s.setGravity(0, true);
        s.solve = false;
        const BodyHandle b = s.block({0, 0, 2}, {0.4, 0.4, 0.4});
        s.board({0, 0, 2});
        s.run(0.5);
        CHECK_FALSE(s.contacts.empty());
        CHECK(s.world.enabled(b));
      },
      {&engine::Capabilities::sleeps});
}

TEST_CASE("restored bodies sleep on, and wake when what they rest on changes before the first step") {
  for (const bool change : {false, true})
    withEngines(
        [&](EngineWorld& any) {
          Shelf a(any.kind), b(any.kind);
          a.settle();
          for (std::size_t i = 0; i < a.bodies.size(); ++i) {
            std::vector<double> numbers;
            a.world.saveBody(a.bodies[i], numbers);
            b.world.loadBody(b.bodies[i], numbers);
            b.world.loadSupport(b.bodies[i], a.world.saveSupport(a.bodies[i]));
          }
          b.setGravity(9.81, false);  // what is loaded behind the bodies does not wake them
          b.setGravity(9.81, true);
          b.stepper.settle(*b.engine, b.collision);
          CHECK(b.asleep());
          if (change) b.world.destroyGeom(b.shelf);
          b.run(0.3);
          CHECK(b.asleep() != change);
          CHECK((b.position(b.upper).z() < 2.3) == change);
        },
        {&engine::Capabilities::sleeps});
}

TEST_CASE("in exact replay sleeping bodies do not notice the world, as in the installed base") {
  withEngines(
      [](EngineWorld& any) {
        Shelf s(any.kind, true);
        s.settle();
        const Vec3 before = s.position(s.upper);
        s.world.destroyGeom(s.shelf);
        s.world.setMass(s.lower, {2, Vec3::Zero(), Mat3::Identity()});
        s.setGravity(-9.81, true);
        s.run(0.5);
        CHECK(s.asleep());
        CHECK(s.position(s.upper) == before);
      },
      {&engine::Capabilities::sleeps});
}
