#include "oracle_house.h"

// What an engine defers, and what no engine can solve.

using namespace spark;
using namespace spark::oracle;

namespace {

/// A knot of boxes in one place, far from it a chain that swings and a box that falls.
struct Yard : test::EngineHouse {
  std::vector<BodyHandle> knot, chain;
  BodyHandle falling;
  /// Steps the world. The articulated one defers to an OdeEngine below it.
  Node& used;
  explicit Yard(bool articulated) : used(articulated ? makeArticulated(kernel) : static_cast<Node&>(engine.leaf())) {
    setGravity(9.81, true);
    geom(test::plane(0, 0, 1, 0));
    for (int i = 0; i < 20; ++i) {
      knot.push_back(body({0.01 * i, 0.015 * (i * 7 % 11), 0.3 + 0.007 * (i * 5 % 13)}));
      world.setMass(knot.back(), {1, Vec3::Zero(), Mat3::Identity() * 0.03});
      geom(test::box(0.4, 0.4, 0.4), knot.back());
    }
    BodyHandle last = BodyHandle::none;
    for (int i = 0; i < 4; ++i) {
      chain.push_back(body({30 + 0.4 * i, 0, 3}));
      const JointHandle j = world.createJoint(JointType::hinge);
      world.attach(j, last, chain.back());
      world.setAnchor(j, {29.8 + 0.4 * i, 0, 3});
      world.setAxis(j, 0, {0, 1, 0}, 0);
      world.setParameter(j, JointParameter::maxForce, 0, 5);
      last = chain.back();
    }
    falling = body({50, 0, 2});
    geom(test::box(0.4, 0.4, 0.4), falling);
  }
  static Node& makeArticulated(Kernel& kernel) {
    kernel.plugins().use("physics-articulated");
    auto& made = kernel.create<Node>("ArticulatedEngine", "/sys/articulated");
    made.create("OdeEngine", "deferred");
    return made;
  }
  void step() {
    contacts.clear();
    detect();
    for (auto& c : contacts) c.solve = true;
    world.step(*used.as<engine::IEngine>(), contacts, 0.02);
  }
  std::int64_t counted(const char* property) const { return getProperty(used, property).toInteger(); }
  std::vector<double> saved(const std::vector<BodyHandle>& bodies) const {
    std::vector<double> out;
    for (const BodyHandle b : bodies) world.saveBody(b, out);
    return out;
  }
};

/// Greatest distance between the bodies of two yards.
double apart(const Yard& a, const Yard& b, const std::vector<BodyHandle>& ofA, const std::vector<BodyHandle>& ofB) {
  double most = 0;
  for (std::size_t i = 0; i < ofA.size(); ++i) most = std::max(most, (a.position(ofA[i]) - b.position(ofB[i])).norm());
  return most;
}

}  // namespace

TEST_CASE(
    "an island that is too large is deferred to ODE, which steps it as it does alone, bit for bit; the others are "
    "solved beside it") {
  Yard dense(false), articulated(true);
  setProperty(dense.used, "directRows", 60);
  setProperty(articulated.used, "mostRows", 60);
  setProperty(*articulated.used.child("deferred"), "directRows", 60);
  for (int i = 0; i < 20; ++i) {
    dense.step(), articulated.step();
    // The two count an island's rows in different ways: while it is a knot it is too large for both.
    if (i < 5) REQUIRE((articulated.saved(articulated.knot) == dense.saved(dense.knot)));
  }
  REQUIRE(dense.counted("approximateSteps") >= 5);
  CHECK(articulated.counted("deferredIslands") >= 5);
  CHECK(articulated.counted("islands") > 0);
  CHECK(apart(dense, articulated, dense.chain, articulated.chain) < 1e-8);
  CHECK(apart(dense, articulated, {dense.falling}, {articulated.falling}) < 1e-8);
}

TEST_CASE("numbers beyond all reason stay in their island, are put right, and harm nobody else") {
  for (const double absurd : {1e308, 1e200, 1e12}) {
    CAPTURE(absurd);
    Yard calm(true), hit(true);
    for (int i = 0; i < 3; ++i) calm.step(), hit.step();
    hit.world.addForce(hit.chain[2], {absurd, -absurd, absurd});
    hit.world.addTorque(hit.chain[1], {absurd, absurd, 0});
    calm.step(), hit.step();
    CHECK_FALSE(hit.world.repaired().empty());
    for (int i = 0; i < 20; ++i) calm.step(), hit.step();
    CHECK((hit.saved(hit.knot) == calm.saved(calm.knot)));
    CHECK((hit.saved({hit.falling}) == calm.saved({calm.falling})));
    for (const BodyHandle b : hit.chain) CHECK(hit.position(b).norm() < 1e3);
  }
}
