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
  double contacts = 0, most = 0;
  for (int i = 0; i < steps; ++i) {
    humanoids.drive(
        [&](std::size_t j) { return s.random ? t.uniform(-s.speed, s.speed) : s.speed * std::sin(0.1 * i + 0.3 * static_cast<double>(j)); },
        s.strength);
    t.copyState();
    t.each([&](Scene& scene) { t.touch(scene); });
    const double start = now();
    t.plain.engine.step(t.plain.world, t.plain.contacts, t.dt);
    const double between = now();
    t.solved.engine.step(t.solved.world, t.solved.contacts, t.dt);
    const double end = now();
    dense.push_back(between - start);
    tree.push_back(end - between);
    contacts += static_cast<double>(t.plain.contacts.size());
    most = std::max(most, t.difference());
  }
  const double d = median(dense) / s.robots, b = median(tree) / s.robots;
  fmt::print("{:<28} {:>8.1f} {:>10.1f} {:>8.2f} {:>8.1f} {:>8.2f} {:>6} {:>6} {:>10.1e}\n", s.name, contacts / steps / s.robots, d, b,
             d / b, static_cast<double>(t.counted("passes")) / static_cast<double>(t.counted("islands")), t.counted("exactSolutions"),
             t.counted("leftIslands"), most);
}

}  // namespace

TEST_CASE("what a step costs by the dense solver and along the trees", "[.][timing]") {
  const int steps = 150;
  fmt::print("{:<28} {:>8} {:>10} {:>8} {:>8} {:>8} {:>6} {:>6} {:>10}\n", "", "contacts", "dense us", "tree us", "times", "passes",
             "exact", "left", "difference");
  measure({"in the air, moving", 22, 50, 2, 25, 2, false}, steps);
  measure({"standing", 22, 0, 2, 25, 0, false}, steps);
  measure({"moving on the ground", 22, 0, 2, 25, 2, false}, steps);
  measure({"wild", 22, 0.2, 2, 25, 6, true}, steps);
  measure({"weak", 22, 0.2, 2, 0.6, 6, true}, steps);
  measure({"pairs and more in contact", 6, 0, 0.18, 25, 1, false}, steps / 4);
}
