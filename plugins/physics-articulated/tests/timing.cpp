// Prints what a step costs by ODE's dense solver and by this one, both through the engine, with the same contacts: CPU time of this thread,
// medians, in microseconds for each robot and step. Nothing is asserted; runs only when asked for: test-physics-articulated [timing].

#include <fmt/format.h>

#include <algorithm>
#include <ctime>

#include "humanoids.h"

using namespace spark;
using namespace spark::test;

namespace {

double now() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e6 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_nsec);
}

double median(std::vector<double> v) {
  std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
  return v[v.size() / 2];
}

struct Scenario {
  const char* name;
  int robots;
  double height, apart;  ///< m
  double strength;       ///< Nm
  double speed;          ///< rad/s
  bool random;
};

void measure(const Scenario& s, int steps) {
  Twins t;
  t.ground();
  t.parameters.cfm = 1e-3;
  t.apply();
  Humanoids humanoids(t);
  for (int i = 0; i < s.robots; ++i) humanoids.add({s.apart * (i % 6), s.apart * (i / 6), s.height});
  std::vector<double> dense, tree;
  double contacts = 0;
  // In blocks: a step finds in the caches what the same world's last step left there, as it does in a run.
  constexpr int kBlock = 10;
  for (int i = 0; i < steps; i += kBlock) {
    t.copyState();
    t.each([&](Scene& scene) {
      std::vector<double>& times = &scene == &t.plain ? dense : tree;
      for (int k = i; k < i + kBlock; ++k) {
        humanoids.drive(
            scene,
            [&](std::size_t j) {
              return s.random ? t.uniform(-s.speed, s.speed) : s.speed * std::sin(0.1 * k + 0.3 * static_cast<double>(j));
            },
            s.strength);
        t.touch(scene);
        contacts += 0.5 * static_cast<double>(scene.contacts.size());
        const double start = now();
        scene.engine.step(scene.world, scene.contacts, t.dt);
        times.push_back(now() - start);
      }
    });
  }
  const double d = median(dense) / s.robots, b = median(tree) / s.robots;
  fmt::print("{:<28} {:>8.1f} {:>10.1f} {:>8.2f} {:>8.1f} {:>8.2f} {:>6} {:>6}\n", s.name, contacts / steps / s.robots, d, b, d / b,
             static_cast<double>(t.counted("passes")) / static_cast<double>(t.counted("islands")), t.counted("exactSolutions"),
             t.counted("leftIslands"));
}

}  // namespace

TEST_CASE("what a step costs by the dense solver and along the trees", "[.][timing]") {
  const int steps = 150;
  fmt::print("{:<28} {:>8} {:>10} {:>8} {:>8} {:>8} {:>6} {:>6}\n", "", "contacts", "dense us", "tree us", "times", "passes", "exact",
             "left");
  SECTION("in the air, moving") { measure({"in the air, moving", 22, 50, 2, 25, 2, false}, steps); }
  SECTION("standing") { measure({"standing", 22, 0, 2, 25, 0, false}, steps); }
  SECTION("moving on the ground") { measure({"moving on the ground", 22, 0, 2, 25, 2, false}, steps); }
  SECTION("wild") { measure({"wild", 22, 0.2, 2, 25, 6, true}, steps); }
  SECTION("weak") { measure({"weak", 22, 0.2, 2, 0.6, 6, true}, steps); }
  SECTION("pairs and more in contact") { measure({"pairs and more in contact", 6, 0, 0.18, 25, 1, false}, steps / 4); }
}
