#include "api/solver.h"

#include <Eigen/Geometry>
#include <functional>

#include "engine_fixture.h"

using namespace spark;
using namespace spark::test;
using engine::Body;
using engine::Joint;
using engine::JointType;
using engine::SolverBody;
using engine::SolverStep;

namespace {

/// A solver whose behaviour the test sets; by default it defers everything.
class TestSolver : public Leaf, public engine::ISolver {
  SPARK_CLASS(TestSolver, Leaf)
 public:
  static void describe(Description<TestSolver>& d) {
    d.doc("Behaves as a test sets it.");
    d.implements<engine::ISolver>();
  }
  std::function<std::size_t(SolverStep&)> does;
  std::size_t steps = 0;
  std::vector<engine::World> forgotten;

  std::size_t step(SolverStep& s) override {
    ++steps;
    if (does) return does(s);
    for (SolverBody* b : s.bodies) b->deferred = true;
    return s.bodies.size();
  }
  void forget(engine::World w) override { forgotten.push_back(w); }
};

/// Things that fall on the ground, are held by a chain of all joints, and sleep.
struct Things : EngineHouse {
  std::vector<Body> bodies;
  Things() {
    setGravity(9.81, true);
    geom(plane(0, 0, 1, 0));
    for (int i = 0; i < 8; ++i) {
      bodies.push_back(body({0.1 * (i % 3), 0, 0.6 + 1.1 * i}));
      geom(box(1, 1, 1), bodies.back());
    }
    bodies.push_back(body({20, 0, 0.4995}));  // soon asleep
    geom(box(1, 1, 1), bodies.back());
    const JointType types[] = {JointType::ball,   JointType::hinge,     JointType::hinge2,
                               JointType::slider, JointType::universal, JointType::fixed};
    Body last = Body::none;
    for (int i = 0; i < 6; ++i) {
      const Body b = body({10.0 + i, 0, 5});
      geom(round(engine::Shape::sphere, 0.3), b);
      const Joint j = ode.createJoint(world, last == Body::none ? JointType::ball : types[i]);
      ode.attach(j, last, b);
      ode.setAnchor(j, {9.5 + i, 0, 5});
      for (int axis = 0; axis < 2; ++axis) ode.setAxis(j, axis, axis ? Vec3(1, 0, 0) : Vec3(0, 0, 1), 0);
      ode.setFixed(j);
      ode.setFeedback(j, true);
      bodies.push_back(last = b);
    }
  }
  TestSolver& addSolver() {
    kernel.registerClass<TestSolver>();
    return kernel.create<TestSolver>("TestSolver", "/sys/server/physics/engine/solver");
  }
  std::vector<double> saved() const {
    std::vector<double> out;
    for (const Body b : bodies) ode.saveBody(b, out);
    return out;
  }
};

/// A step without any constraint: places follow speeds.
void drift(SolverBody& b, double dt) {
  for (int i = 0; i < 3; ++i) b.position[i] += dt * b.linearVelocity[i];
  std::fill(b.force, b.force + 3, 0);
  std::fill(b.torque, b.torque + 3, 0);
  b.awake = true;
  b.deferred = false;
}

}  // namespace

TEST_CASE("a solver that defers everything changes nothing, bit for bit, through falls, joints and sleep") {
  Things alone, watched;
  const TestSolver& solver = watched.addSolver();
  for (int i = 0; i < 250; ++i) {
    alone.step();
    watched.step();
    REQUIRE((watched.saved() == alone.saved()));
  }
  CHECK((solver.steps > 50 && solver.steps < 250));  // not called while all bodies sleep
  CHECK_FALSE(watched.ode.enabled(watched.bodies[8]));
}

TEST_CASE("a solver comes and goes with the tree") {
  Things a, b;
  a.step(), b.step();
  TestSolver& solver = a.addSolver();
  a.step(), b.step();
  CHECK(solver.steps == 1);
  solver.parent()->remove(solver);
  for (int i = 0; i < 60; ++i) a.step(), b.step();
  CHECK((a.saved() == b.saved()));
}

TEST_CASE("what a solver steps is awake and collides where it went; what it defers goes on as if alone") {
  Things a, alone;
  TestSolver& solver = a.addSolver();
  const Body mine = a.body({-20, 0, 0.4995}), asleep = a.body({-30, 0, 0.4995});
  a.geom(box(1, 1, 1), mine);
  a.geom(box(1, 1, 1), asleep);
  a.ode.setLinearVelocity(mine, {-1, 0, 0});
  a.ode.setEnabled(asleep, false);
  solver.does = [&](SolverStep& s) {
    const std::size_t n = s.bodies.size();
    for (std::size_t i = 0; i < n; ++i) {
      s.bodies[i]->deferred = i < n - 2;
      CHECK(s.bodies[i]->index == i);
    }
    drift(*s.bodies[n - 2], s.dt);
    s.bodies[n - 1]->awake = true;
    return n - 2;
  };
  for (int i = 0; i < 60; ++i) a.step(), alone.step();
  CHECK((a.saved() == alone.saved()));
  CHECK(a.position(mine).x() == Approx(-20 - 60 * 0.02));
  CHECK(a.ode.enabled(asleep));
  a.contacts.clear();
  a.ode.detect(a.world, nullptr, 4, a.contacts);
  bool found = false;
  for (const auto& c : a.contacts) found = found || c.position.x() == Approx(-20 - 60 * 0.02 - 0.5);
  CHECK(found);
}

TEST_CASE("a solver is given the bodies of each contact, the world last") {
  EngineHouse house;
  house.kernel.registerClass<TestSolver>();
  auto& solver = house.kernel.create<TestSolver>("TestSolver", "/sys/server/physics/engine/solver");
  house.geom(plane(0, 0, 1, 0));
  const Body low = house.body({0, 0, 0.499}), high = house.body({0, 0, 1.497});
  house.geom(box(1, 1, 1), low);
  house.geom(box(1, 1, 1), high);
  std::size_t between = 0, ground = 0, none = 0;
  solver.does = [&](SolverStep& s) {
    REQUIRE(s.pairs.size() == s.contacts.size());
    for (std::size_t i = 0; i < s.pairs.size(); ++i) {
      const auto& p = s.pairs[i];
      if (!p.a) {
        CHECK_FALSE(s.contacts[i].solve);
        ++none;
      } else if (p.b) {
        ++between;
        CHECK_FALSE(p.reversed);
      } else {
        ++ground;
        CHECK(p.a == s.bodies[0]);
        CHECK(p.reversed == (s.contacts[i].normal.z() < 0));
      }
    }
    for (SolverBody* b : s.bodies) b->deferred = true;
    return s.bodies.size();
  };
  house.step();
  CHECK(between == 4);
  CHECK(ground == 4);
  house.contacts.clear();
  house.ode.detect(house.world, nullptr, 4, house.contacts);
  for (auto& c : house.contacts) {
    c.solve = c.ownerA != nullptr;
    std::swap(c.geomA, c.geomB);  // the world first
    c.normal = -c.normal;
  }
  house.contacts[0].solve = true;
  house.step();
  CHECK(none == 0);
}

TEST_CASE("the engine returns the feedback of the solver, with the joint's bodies in the caller's order") {
  EngineHouse house;
  house.kernel.registerClass<TestSolver>();
  auto& solver = house.kernel.create<TestSolver>("TestSolver", "/sys/server/physics/engine/solver");
  const Body b = house.body({0, 0, 1});
  const Joint wanted = house.ode.createJoint(house.world, JointType::ball),
              unwanted = house.ode.createJoint(house.world, JointType::ball);
  house.ode.attach(wanted, Body::none, b);
  house.ode.attach(unwanted, b, Body::none);
  house.ode.setFeedback(wanted, true);
  solver.does = [](SolverStep& s) {
    CHECK(s.joints[0]->reversed);
    CHECK_FALSE(s.joints[1]->reversed);
    for (auto* j : s.joints) {
      CHECK(j->a == s.bodies[0]);
      CHECK(j->b == nullptr);
      j->forceA = {1, 2, 3};
    }
    drift(*s.bodies[0], s.dt);
    return 0;
  };
  house.step();
  Vec3 f1, t1, f2, t2;
  house.ode.feedback(wanted, f1, t1, f2, t2);
  CHECK(f1.isZero(0));
  CHECK(f2 == Vec3(1, 2, 3));
  house.ode.feedback(unwanted, f1, t1, f2, t2);
  CHECK(f1.isZero(0));
}

TEST_CASE(
    "structure changes when bodies and joints are created, destroyed or attached, and only then; the solver is told "
    "when a world is destroyed") {
  EngineHouse house;
  house.kernel.registerClass<TestSolver>();
  auto& solver = house.kernel.create<TestSolver>("TestSolver", "/sys/server/physics/engine/solver");
  std::uint64_t seen = 0;
  solver.does = [&](SolverStep& s) {
    seen = s.structure;
    for (SolverBody* b : s.bodies) b->deferred = true;
    return s.bodies.size();
  };
  const auto changed = [&] {
    const std::uint64_t before = seen;
    house.step();
    return seen != before;
  };
  const Body a = house.body({0, 0, 1}), b = house.body({0, 0, 2});
  CHECK(changed());
  CHECK_FALSE(changed());
  const Joint j = house.ode.createJoint(house.world, JointType::hinge);
  CHECK(changed());
  house.ode.attach(j, a, b);
  CHECK(changed());
  house.ode.setAnchor(j, {0, 0, 1.5});
  house.ode.setMass(a, {2, Vec3::Zero(), Mat3::Identity()});
  CHECK_FALSE(changed());
  house.ode.destroyBody(b);
  CHECK(changed());
  house.ode.destroyJoint(j);
  CHECK(changed());
  house.ode.destroyWorld(house.world);
  REQUIRE(solver.forgotten.size() == 1);
  CHECK(solver.forgotten[0] == house.world);
}

TEST_CASE("a solver sees anchors, axes and parameters as ODE keeps them, whatever the order of bodies") {
  for (const auto type : {JointType::ball, JointType::hinge, JointType::universal})
    for (const int order : {0, 1, 2, 3}) {
      CAPTURE(int(type), order);
      EngineHouse house;
      house.kernel.registerClass<TestSolver>();
      auto& solver = house.kernel.create<TestSolver>("TestSolver", "/sys/server/physics/engine/solver");
      house.setGravity(9.81);
      const Body a = house.body({0, 0, 1}), b = house.body({0.3, 0.1, 2});
      const Mat3 tilt = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
      house.ode.setRotation(a, tilt);
      house.ode.setRotation(b, tilt * tilt);
      house.ode.setAngularVelocity(a, {0.4, 0.2, 0.9});
      const Joint j = house.ode.createJoint(house.world, type);
      const Body none = Body::none;
      const std::pair<Body, Body> orders[] = {{a, b}, {b, a}, {a, none}, {none, a}};
      house.ode.attach(j, orders[order].first, orders[order].second);
      house.ode.setAnchor(j, {0.1, 0.2, 1.4});
      house.ode.setAxis(j, 0, {0, 2, 1}, 0);
      house.ode.setAxis(j, 1, {1, 0, 0}, 0);
      house.ode.setParameter(j, engine::JointParameter::maxForce, 0, 7);
      house.ode.setParameter(j, engine::JointParameter::maxForce, 0, -1);  // not taken
      const engine::SolverJoint* seen = nullptr;
      solver.does = [&](SolverStep& s) {
        seen = s.joints[0];
        for (SolverBody* body : s.bodies) body->deferred = true;
        return s.bodies.size();
      };
      for (int i = 0; i < 40; ++i) house.step();
      REQUIRE(seen);
      const auto frame = [](const SolverBody* body) {
        Mat3 m = Mat3::Identity();
        for (int k = 0; body && k < 9; ++k) m(k / 3, k % 3) = body->rotation[4 * (k / 3) + k % 3];
        return m;
      };
      const auto point = [&](const SolverBody* body, const Vec3& p) {
        return Vec3(body ? frame(body) * p + Vec3(body->position[0], body->position[1], body->position[2]) : p);
      };
      const bool turned = seen->reversed;
      CHECK(turned == (order == 3));
      const Vec3 first = point(seen->a, seen->anchorA), second = point(seen->b, seen->anchorB);
      CHECK((house.ode.anchor(j) - (turned ? second : first)).norm() < 1e-12);
      CHECK((first - second).norm() < 0.05);  // it is held there
      if (type == JointType::ball) continue;
      CHECK(seen->axes[0].maxForce == 7);
      const Vec3 x = frame(seen->a) * seen->axisA[0];
      if (type == JointType::hinge) {
        CHECK((house.ode.axis(j, 0) - x).norm() < 1e-12);
        CHECK((frame(seen->b) * seen->axisB[0]).normalized().dot(x) > 0.999);
      } else {
        const Vec3 y = frame(seen->b) * seen->axisB[1];
        CHECK((house.ode.axis(j, 0) - (turned ? y : x)).norm() < 1e-12);
        CHECK((house.ode.axis(j, 1) - (turned ? x : y)).norm() < 1e-12);
      }
    }
}
