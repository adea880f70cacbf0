#include "oracle_house.h"

// Islands that the engine defers to ODE, and forces that no engine can handle.

using namespace spark;
using namespace spark::oracle;

namespace {

/// A pile of overlapping boxes, and far from it a swinging chain and a falling box.
struct Islands : test::EngineHost {
  std::vector<BodyHandle> pile, chain;
  BodyHandle falling;
  /// Steps the world. The articulated one defers to an OdeEngine below it.
  Node& used;
  explicit Islands(bool articulated) : used(articulated ? makeArticulated(kernel) : static_cast<Node&>(engine.leaf())) {
    setGravity(9.81, true);
    geom(test::plane(0, 0, 1, 0));
    for (int i = 0; i < 20; ++i) {
      pile.push_back(body({0.01 * i, 0.015 * (i * 7 % 11), 0.3 + 0.007 * (i * 5 % 13)}));
      world.setMass(pile.back(), {1, Vec3::Zero(), Mat3::Identity() * 0.03});
      geom(test::box(0.4, 0.4, 0.4), pile.back());
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
    stepper.step(*used.as<engine::IEngine>(), contacts, 0.02);
  }
  std::int64_t counted(const char* property) const { return getProperty(used, property).toInteger(); }
  std::vector<double> saved(const std::vector<BodyHandle>& bodies) const {
    std::vector<double> out;
    for (const BodyHandle b : bodies) world.saveBody(b, out);
    return out;
  }
};

/// Largest distance between corresponding bodies of two worlds.
double apart(const Islands& a, const Islands& b, const std::vector<BodyHandle>& ofA,
             const std::vector<BodyHandle>& ofB) {
  double largest = 0;
  for (std::size_t i = 0; i < ofA.size(); ++i)
    largest = std::max(largest, (a.position(ofA[i]) - b.position(ofB[i])).norm());
  return largest;
}

}  // namespace

TEST_CASE(
    "an island that is too large is deferred to ODE with the same bits as from ODE alone, and the engine solves the "
    "other islands") {
  Islands dense(false), articulated(true);
  setProperty(dense.used, "directRows", 60);
  setProperty(articulated.used, "mostRows", 60);
  setProperty(*articulated.used.child("deferred"), "directRows", 60);
  for (int i = 0; i < 20; ++i) {
    dense.step(), articulated.step();
    // The two engines count an island's rows differently. In the first steps the pile is too large for both.
    if (i < 5) REQUIRE((articulated.saved(articulated.pile) == dense.saved(dense.pile)));
  }
  REQUIRE(dense.counted("approximateSteps") >= 5);
  CHECK(articulated.counted("deferredIslands") >= 5);
  CHECK(articulated.counted("islands") > 0);
  CHECK(apart(dense, articulated, dense.chain, articulated.chain) < 1e-8);
  CHECK(apart(dense, articulated, {dense.falling}, {articulated.falling}) < 1e-8);
}

TEST_CASE("absurd forces affect only their island, and its bodies are repaired") {
  for (const double absurd : {1e308, 1e200, 1e12}) {
    CAPTURE(absurd);
    Islands calm(true), hit(true);
    for (int i = 0; i < 3; ++i) calm.step(), hit.step();
    hit.world.addForce(hit.chain[2], {absurd, -absurd, absurd});
    hit.world.addTorque(hit.chain[1], {absurd, absurd, 0});
    calm.step(), hit.step();
    CHECK_FALSE(hit.stepper.repaired().empty());
    for (int i = 0; i < 20; ++i) calm.step(), hit.step();
    CHECK((hit.saved(hit.pile) == calm.saved(calm.pile)));
    CHECK((hit.saved({hit.falling}) == calm.saved({calm.falling})));
    for (const BodyHandle b : hit.chain) CHECK(hit.position(b).norm() < 1e3);
  }
}
