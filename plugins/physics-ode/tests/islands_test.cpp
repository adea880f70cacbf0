#include "engine_fixture.h"

using namespace spark;
using namespace spark::test;
using physics::BodyHandle;

namespace {

/// A pile of overlapping boxes, and a box that rests far away from it.
struct Pile : EngineHost {
  std::vector<BodyHandle> bodies;
  BodyHandle calm;
  Leaf& leaf;
  explicit Pile(int n) : leaf(*kernel.root().find("/sys/server/physics/engine")) {
    setGravity(9.81, true);
    geom(plane(0, 0, 1, 0));
    for (int i = 0; i < n; ++i) {
      bodies.push_back(body({0.001 * i, 0.0015 * (i * 7 % 11), 0.3 + 0.0007 * (i * 5 % 13)}));
      world.setMass(bodies.back(), {1, Vec3::Zero(), Mat3::Identity() * 0.03});
      geom(box(0.4, 0.4, 0.4), bodies.back());
    }
    calm = body({50, 0, 0.1995});
    geom(box(0.4, 0.4, 0.4), calm);
  }
  std::vector<double> saved() const {
    std::vector<double> out;
    for (const BodyHandle b : bodies) world.saveBody(b, out);
    world.saveBody(calm, out);
    return out;
  }
};

std::int64_t approximate(const Pile& p) { return getProperty(p.leaf, "approximateSteps").toInteger(); }

}  // namespace

TEST_CASE("an island too large for the direct solver is solved approximately, repeatably, and logged once") {
  Pile a(40), b(40);
  for (int i = 0; i < 20; ++i) a.step(), b.step();
  CHECK(approximate(a) > 0);
  CHECK(a.saved() == b.saved());
  CHECK_THAT(a.text, Catch::Contains("directRows"));
  CHECK(a.text.find("directRows") == a.text.rfind("directRows"));
  double farthest = 0;
  for (const BodyHandle body : a.bodies) farthest = std::max(farthest, a.position(body).norm());
  CHECK(farthest > 0.6);
  CHECK(farthest < 50);
}

TEST_CASE("a large island does not affect bodies outside of it") {
  Pile a(40), alone(0);
  for (int i = 0; i < 30; ++i) a.step(), alone.step();
  REQUIRE(approximate(a) > 0);
  CHECK(approximate(alone) == 0);
  std::vector<double> beside, single;
  a.world.saveBody(a.calm, beside);
  alone.world.saveBody(alone.calm, single);
  CHECK(beside == single);
  CHECK_FALSE(a.world.enabled(a.calm));
}

TEST_CASE("any number of small islands is solved by the direct solver") {
  EngineHost host;
  host.setGravity(9.81, true);
  host.geom(plane(0, 0, 1, 0));
  for (int i = 0; i < 200; ++i) host.geom(box(1, 1, 1), host.body({3.0 * i, 0, 0.4995}));
  host.step();
  CHECK(host.contacts.size() == 800);
  CHECK(getProperty(*host.kernel.root().find("/sys/server/physics/engine"), "approximateSteps").toInteger() == 0);
}
