// Prints what a step costs by ODE's dense solver and by this one, both through the engine, with the same contacts: CPU
// time of this thread, medians (dense: the engine with ODE; engine: with this solver, of which solver: the solver
// itself; times: dense / solver), in microseconds for each robot and step. Nothing is asserted; runs only when asked
// for: test-physics-articulated [timing].

#include <fmt/format.h>

#include <algorithm>
#include <ctime>

#include "humanoids.h"
#include "spark/describe.h"
#include "stepper.h"

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

/// The solver, with a clock: what it takes from the engine's plain data and back.
class TimedSolver : public Leaf, public engine::ISolver {
  SPARK_CLASS(TimedSolver, Leaf)
 public:
  static void describe(Description<TimedSolver>& d) {
    d.doc("Solves against a clock.");
    d.implements<engine::ISolver>();
  }
  std::size_t step(engine::SolverStep& step) override {
    const double start = now();
    const std::size_t left = stepper.step(step, 1, {});
    spent = now() - start;
    return left;
  }
  void forget(engine::World world) override { stepper.forget(world); }
  articulated::Stepper stepper;
  double spent = 0;
};

/// A scene in both engines, stepped by turns.
struct Timing {
  Twins twins;
  TimedSolver& timed;
  std::vector<double> dense, whole, alone;
  double contacts = 0;

  Timing() : timed(replaceSolver(twins)) {
    twins.ground();
    twins.parameters.cfm = 1e-3;
    twins.apply();
  }
  static TimedSolver& replaceSolver(Twins& t) {
    t.solver().parent()->remove(t.solver());
    t.kernel.registerClass<TimedSolver>();
    return t.kernel.create<TimedSolver>("TimedSolver", "/sys/solved/solver");
  }
  void step(Scene& scene) {
    twins.touch(scene);
    contacts = static_cast<double>(scene.contacts.size());
    const double start = now();
    scene.engine.step(scene.world, scene.contacts, twins.dt);
    (&scene == &twins.plain ? dense : whole).push_back(now() - start);
    if (&scene == &twins.solved) alone.push_back(timed.spent);
  }
  /// In blocks: a step finds in the caches what the same world's last step left there, as it does in a run.
  /// `before(scene, step)` drives.
  template <class F>
  void run(int steps, F&& before) {
    constexpr int kBlock = 10;
    for (int first = 0; first < steps; first += kBlock) {
      twins.copyState();
      twins.each([&](Scene& scene) {
        for (int i = first; i < first + kBlock; ++i) before(scene, i), step(scene);
      });
    }
  }
  /// For each of so many robots or boxes.
  void print(const char* name, int things) const {
    const double d = median(dense) / things, e = median(whole) / things, solver = median(alone) / things;
    const articulated::Stepper& s = timed.stepper;
    fmt::print("{:<28} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>6} {:>6}\n", "", "contacts", "dense", "engine", "solver",
               "times", "passes", "exact", "left");
    fmt::print("{:<28} {:>8.1f} {:>8.1f} {:>8.1f} {:>8.2f} {:>8.1f} {:>8.2f} {:>6} {:>6}\n", name, contacts / things, d,
               e, solver, d / solver, static_cast<double>(s.passes()) / static_cast<double>(s.islands()),
               s.exactSolutions(), s.deferredIslands());
  }
};

struct Doing {
  const char* name;
  int robots;
  double height, apart;  ///< m
  double strength;       ///< Nm
  double speed;          ///< rad/s
  bool random;
};

void timeHumanoids(const Doing& what, int steps) {
  Timing timing;
  Humanoids humanoids(timing.twins);
  for (int i = 0; i < what.robots; ++i) humanoids.add({what.apart * (i % 6), what.apart * (i / 6), what.height});
  timing.run(steps, [&](Scene& scene, int i) {
    const auto speed = [&](std::size_t j) {
      return what.random ? timing.twins.uniform(-what.speed, what.speed)
                         : what.speed * std::sin(0.1 * i + 0.3 * static_cast<double>(j));
    };
    humanoids.drive(scene, speed, what.strength);
  });
  timing.print(what.name, what.robots);
}

void timeBoxes(int count, int steps) {
  Timing timing;
  for (int i = 0; i < count; ++i)
    timing.twins.box({0.3, 0.3, 0.3}, timing.twins.body({0.5 * (i % 32), 0.5 * (i / 32), 0.2 + 0.001 * (i % 40)}, 1,
                                                        Mat3::Identity() * 0.015));
  timing.run(steps, [](Scene&, int) {});
  timing.print("boxes on the ground", count);
}

}  // namespace

TEST_CASE("what a step costs by the dense solver and along the trees", "[.][timing]") {
  constexpr int kSteps = 150;
  SECTION("air") { timeHumanoids({"in the air, moving", 22, 50, 2, 25, 2, false}, kSteps); }
  SECTION("standing") { timeHumanoids({"standing", 22, 0, 2, 25, 0, false}, kSteps); }
  SECTION("moving") { timeHumanoids({"moving on the ground", 22, 0, 2, 25, 2, false}, kSteps); }
  SECTION("wild") { timeHumanoids({"wild", 22, 0.2, 2, 25, 6, true}, kSteps); }
  SECTION("weak") { timeHumanoids({"weak", 22, 0.2, 2, 0.6, 6, true}, kSteps); }
  SECTION("pushing") { timeHumanoids({"six pushing each other", 6, 0, 0.18, 25, 1, false}, 40); }
  SECTION("boxes") { timeBoxes(1000, 60); }
}
