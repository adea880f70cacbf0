#include "pitch.h"

// Whole soccer simulations stepped by the articulated engine alone, without a shadow engine.

using namespace spark;
using namespace spark::oracle;

namespace {

const Pitch::Settings kArticulated{{"solver", "articulated"}};

/// Two robots that run into each other near the ball, and two robots by themselves.
const std::vector<Pitch::StartPose> kPoses{{-0.4, 0.1}, {-0.4, 0.1}, {-3, 1}, {-4, -1}};

void stir(Pitch& p) {
  p.push(0, {1, 0, 0});
  p.push(1, {-1, 0, 0});
  p.playOn();
  p.ball().setVelocity({0.5, 0.1, 1});
  // The speeds do not depend on the cycle: a restored simulation does not know how long it ran before.
  p.move([](std::size_t motor, int) { return 2 * std::sin(0.7 * static_cast<double>(motor)); });
}

std::string saved(Pitch& p) {
  StateWriter out(true);
  saveTree(p.kernel.root(), out);
  return out.bytes();
}

void load(Pitch& p, const std::string& bytes) {
  StateReader in(bytes);
  loadTree(p.kernel.root(), in);
}

}  // namespace

TEST_CASE("the result does not depend on the number of threads") {
  std::vector<std::uint64_t> hashes;
  for (const int threads : {1, 2, 4}) {
    Pitch p(kPoses, kArticulated);
    setProperty(p.simulation(), "threads", threads);
    stir(p);
    p.run(120);
    hashes.push_back(p.hash());
  }
  CHECK(hashes[1] == hashes[0]);
  CHECK(hashes[2] == hashes[0]);
}

TEST_CASE("a restored world continues bit for bit, in the same simulation and in one with another history") {
  Pitch p(kPoses, kArticulated), other(kPoses, kArticulated);
  stir(p);
  p.run(40);
  const std::string middle = saved(p);
  p.run(80);
  const std::string end = saved(p);
  REQUIRE(middle != end);
  load(p, middle);
  p.run(80);
  CHECK((saved(p) == end));
  stir(other);
  other.run(7);
  load(other, middle);
  other.run(80);
  CHECK((saved(other) == end));
}

TEST_CASE("an option of the config selects the engine") {
  for (const bool articulated : {false, true}) {
    Pitch p({{-2, 0}}, articulated ? kArticulated : Pitch::Settings{});
    Leaf& engine = p.kernel.root().require<Leaf>("/sys/server/physics/engine");
    REQUIRE(engine.classObject()->name() == (articulated ? "ArticulatedEngine" : "OdeEngine"));
    if (!articulated) continue;
    const auto solved = [&] { return getProperty(engine, "islands").toInteger(); };
    const auto before = solved();
    p.push(0, {0.2, 0, 0});
    p.move();
    p.run(20);
    CHECK(solved() > before);
    CHECK(getProperty(engine, "deferredIslands").toInteger() == 0);
  }
}

TEST_CASE("after one second of motion the results of the two engines differ by less than a micrometer") {
  Pitch dense({{-2, 0}, {-3, 1}}), articulated({{-2, 0}, {-3, 1}}, kArticulated);
  for (Pitch* p : {&dense, &articulated}) {
    p->move();
    p->run(50);
  }
  for (std::size_t i = 0; i < 2; ++i) {
    std::vector<IRigidBody*> a, b;
    dense.robots()[i]->collect(a);
    articulated.robots()[i]->collect(b);
    REQUIRE(a.size() == b.size());
    double apart = 0, moved = 0;
    for (std::size_t k = 0; k < a.size(); ++k) {
      apart = std::max(apart, (a[k]->state().position - b[k]->state().position).norm());
      moved = std::max(moved, a[k]->state().linearVelocity.norm());
    }
    CHECK(moved > 0.01);
    CHECK(apart < 1e-6);
  }
}
