#include <Eigen/Geometry>

#include "engine_fixture.h"

using namespace spark;
using namespace spark::test;
using engine::JointParameter;
using engine::JointType;
using physics::BodyHandle;
using physics::JointHandle;

namespace {

/// Dolls that fall on the ground and on each other, with balls between them. A doll has a trunk and four motorized
/// limbs of two parts, in its own space; the balls are in the outer space. The scene is always built in the same way.
struct Crowd : EngineHost {
  std::vector<BodyHandle> bodies;
  std::vector<JointHandle> motors;
  int steps = 0;

  Crowd(bool exactReplay, int threads, int dolls = 22) : Crowd(prepared(exactReplay, threads), dolls) {}

  /// Changes the motor speeds and makes a step.
  void next() {
    ++steps;
    for (std::size_t i = 0; i < motors.size(); ++i)
      world.setParameter(motors[i], JointParameter::velocity, 0,
                         2 * std::sin(0.1 * steps + 0.7 * static_cast<double>(i)));
    engine::Surface s;
    s.softErpOn = s.slipOn = true;
    s.softErp = 0.4;
    s.slip1 = s.slip2 = 0.005;
    step(0.02, s);
  }
  /// All results of a step: the bodies, and the contacts in their order.
  std::vector<double> all() const {
    std::vector<double> out;
    for (const BodyHandle b : bodies) world.saveBody(b, out);
    for (const engine::Contact& c : contacts)
      out.insert(out.end(), {c.position.x(), c.position.y(), c.position.z(), c.depth});
    return out;
  }

 private:
  struct Prepared {
    bool exactReplay;
    int threads;
  };
  static Prepared prepared(bool exactReplay, int threads) { return {exactReplay, threads}; }

  Crowd(Prepared p, int dolls) : EngineHost(p.exactReplay) {
    kernel.jobs().setThreads(p.threads);
    setGravity(9.81, true);
    geom(plane(0, 0, 1, 0));
    for (int i = 0; i < dolls; ++i) addDoll(Vec3(0.9 * (i % 5), 0.7 * (i / 5), 0.8 + 0.11 * (i % 7)));
    for (int i = 0; i < 6; ++i) geom(round(engine::Shape::sphere, 0.12), add({0.8 * i, 0.3, 0.5}, 0.4));
  }
  BodyHandle add(const Vec3& at, double mass) {
    const BodyHandle b = body(at);
    world.setMass(b, {mass, Vec3::Zero(), Mat3::Identity() * mass * 0.01});
    bodies.push_back(b);
    return b;
  }
  BodyHandle addPart(physics::SpaceHandle inner, const Vec3& at, const Vec3& edges) {
    const BodyHandle b = add(at, 0.5);
    world.setBody(world.createGeom(inner, box(edges.x(), edges.y(), edges.z()), nullptr), b, {});
    return b;
  }
  void addDoll(const Vec3& at) {
    const physics::SpaceHandle inner = world.createSpace(space);
    const BodyHandle trunk = addPart(inner, at, {0.3, 0.2, 0.3});
    for (int limb = 0; limb < 4; ++limb) {
      const Vec3 root = at + Vec3(limb % 2 ? 0.2 : -0.2, 0, limb / 2 ? 0.1 : -0.25);
      BodyHandle above = trunk;
      for (int part = 0; part < 2; ++part) {
        const Vec3 middle = root - Vec3(0, 0, 0.22 * part);
        const BodyHandle below = addPart(inner, middle, {0.08, 0.08, 0.2});
        hinge(above, below, middle + Vec3(0, 0, 0.11), part ? Vec3::UnitX() : Vec3::UnitY());
        above = below;
      }
    }
  }
  void hinge(BodyHandle above, BodyHandle below, const Vec3& anchor, const Vec3& axis) {
    const JointHandle j = world.createJoint(JointType::hinge);
    world.attach(j, above, below);
    world.setAnchor(j, anchor);
    world.setAxis(j, 0, axis, 0);
    world.setParameter(j, JointParameter::lowStop, 0, -1);
    world.setParameter(j, JointParameter::highStop, 0, 1);
    world.setParameter(j, JointParameter::maxForce, 0, 8);
    motors.push_back(j);
  }
};

}  // namespace

TEST_CASE("several threads give the same motion and the same order of contacts as one thread, bit for bit") {
  const bool exactReplay = GENERATE(true, false);
  Crowd one(exactReplay, 1), two(exactReplay, 2), four(exactReplay, 4);
  std::size_t maxContacts = 0;
  for (int i = 0; i < 150; ++i) {
    one.next();
    two.next();
    four.next();
    REQUIRE(one.all() == two.all());
    REQUIRE(one.all() == four.all());
    maxContacts = std::max(maxContacts, one.contacts.size());
  }
  CHECK(maxContacts > 60);
}

TEST_CASE("the number of threads may change while a world runs") {
  Crowd one(true, 1), changing(true, 1);
  for (const int threads : {1, 3, 2, 1, 2}) {
    changing.kernel.jobs().setThreads(threads);
    for (int i = 0; i < 10; ++i) {
      one.next();
      changing.next();
    }
    REQUIRE(one.all() == changing.all());
  }
}

TEST_CASE("islands that are solved approximately give the same result with several threads") {
  Crowd one(true, 1), two(true, 2);
  for (Crowd* c : {&one, &two}) setProperty(c->engine.leaf(), "directRows", 60);
  for (int i = 0; i < 60; ++i) {
    one.next();
    two.next();
  }
  CHECK(getProperty(one.engine.leaf(), "approximateSteps").toInteger() > 0);
  CHECK(one.all() == two.all());
}
