// Prints the time of a step with ODE's dense solver and with the articulated solver, for the same contacts: medians of
// this thread's CPU time, in microseconds per robot (or box) and step.
//
//     dense   a step with OdeEngine
//     world   a step with the articulated engine
//     solver  the articulated solver's part of it
//     times   dense / solver
//
// It asserts nothing, and runs only on request: test-physics-articulated "[timing]".

#include <fmt/format.h>

#include <algorithm>
#include <ctime>

#include "humanoids.h"
#include "spark/describe.h"
#include "spark/link.h"
#include "stepper.h"

using namespace spark;
using namespace spark::test;

namespace {

/// CPU time of this thread [us].
double now() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e6 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_nsec);
}

double median(std::vector<double> v) {
  std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
  return v[v.size() / 2];
}

/// The articulated solver in one thread, which measures its time.
struct TimedSolver : engine::ISolver {
  explicit TimedSolver(engine::IEngine& below) : deferred(below) {}
  void compile(const engine::Model& model, const engine::State&) override {
    stepper.compile(model);
    deferredKnows = false;
  }
  void step(engine::Step& step) override {
    const double start = now();
    const auto others = stepper.step(step, 600, 1, {});
    spent = now() - start;
    if (others.empty()) return;
    engine::ISolver& below = attached.of(deferred, step.model);
    if (!std::exchange(deferredKnows, true)) below.compile(step.model, step.state);
    engine::Step rest{step.model, step.state, step.contacts, step.dt, others};
    below.step(rest);
  }
  engine::IEngine& deferred;
  engine::Attached<engine::IEngine> attached;
  bool deferredKnows = false;
  articulated::Stepper stepper;
  double spent = 0;  ///< time of the last step [us]
};

class TimedEngine : public spark::Node, public engine::IEngine {
  SPARK_CLASS(TimedEngine, spark::Node)
 public:
  static void describe(Description<TimedEngine>& d) {
    d.doc("Measures the time of the articulated solver.");
    d.implements<engine::IEngine>();
    d.link(&TimedEngine::deferred_, Child<engine::IEngine>());
  }
  Leaf& leaf() override { return *this; }
  engine::Capabilities capabilities() const override { return {.armature = true, .laws = true, .damping = true}; }
  std::unique_ptr<engine::ISolver> create(const engine::Model&) override {
    return std::make_unique<TimedSolver>(*deferred_);
  }
  const TimedSolver& solver() const { return static_cast<const TimedSolver&>(*parts().front()); }

 private:
  Link<engine::IEngine> deferred_;
};

/// A scene in two worlds that are stepped alternately, and the times of all steps [us].
struct Timing {
  Twins twins;
  TimedEngine& timed;
  std::vector<double> dense, world, solver;
  double contacts = 0;

  Timing() : timed(replaceEngine(twins)) {
    twins.ground();
    twins.parameters.cfm = 1e-3;
    twins.apply();
  }
  static TimedEngine& replaceEngine(Twins& t) {
    t.articulated().parent()->remove(t.articulated());
    t.kernel.registerClass<TimedEngine>();
    auto& made = t.kernel.create<TimedEngine>("TimedEngine", Twins::kSolvedEngine);
    made.spark::Node::create("OdeEngine", "deferred");
    t.solved.engine = &made;
    return made;
  }
  void step(Scene& scene) {
    twins.detectContacts(scene);
    contacts = static_cast<double>(scene.contacts.size());
    const double start = now();
    scene.step(twins.dt);
    (&scene == &twins.plain ? dense : world).push_back(now() - start);
    if (&scene == &twins.solved) solver.push_back(timed.solver().spent);
  }
  /// Steps both scenes in alternating blocks. Within a block the caches are warm from the same world's last step, as in
  /// a real run. `before(scene, step)` sets the motors.
  template <class F>
  void run(int steps, F&& before) {
    constexpr int kBlock = 10;
    for (int first = 0; first < steps; first += kBlock) {
      twins.copyState();
      twins.forBoth([&](Scene& scene) {
        for (int i = first; i < first + kBlock; ++i) before(scene, i), step(scene);
      });
    }
  }
  /// Prints the medians per robot or box. `count`: their number.
  void print(const char* name, int count) const {
    const double d = median(dense) / count, w = median(world) / count, a = median(solver) / count;
    const articulated::Stepper::Counts s = timed.solver().stepper.counts();
    fmt::print("{:<28} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>6} {:>8}\n", "", "contacts", "dense", "world", "solver",
               "times", "passes", "exact", "deferred");
    fmt::print("{:<28} {:>8.1f} {:>8.1f} {:>8.1f} {:>8.2f} {:>8.1f} {:>8.2f} {:>6} {:>8}\n", name, contacts / count, d,
               w, a, d / a, static_cast<double>(s.passes) / static_cast<double>(s.islands), s.exactSolutions,
               s.deferredIslands);
  }
};

/// How humanoids move.
struct Motion {
  const char* name;
  int robots;
  double height, spacing;  ///< m
  double maxTorque;        ///< of the motors [Nm]
  double speed;            ///< maximum of the motors [rad/s]
  bool random;             ///< a random speed in each step, otherwise a sine
};

void timeHumanoids(const Motion& motion, int steps) {
  Timing timing;
  Humanoids humanoids(timing.twins);
  for (int i = 0; i < motion.robots; ++i)
    humanoids.add({motion.spacing * (i % 6), motion.spacing * (i / 6), motion.height});
  timing.run(steps, [&](Scene& scene, int i) {
    const auto speed = [&](std::size_t j) {
      return motion.random ? timing.twins.uniform(-motion.speed, motion.speed)
                           : motion.speed * std::sin(0.1 * i + 0.3 * static_cast<double>(j));
    };
    humanoids.drive(scene, speed, motion.maxTorque);
  });
  timing.print(motion.name, motion.robots);
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

TEST_CASE("time of a step with the dense and with the articulated solver", "[.][timing]") {
  constexpr int kSteps = 150;
  SECTION("air") { timeHumanoids({"in the air, moving", 22, 50, 2, 25, 2, false}, kSteps); }
  SECTION("standing") { timeHumanoids({"standing", 22, 0, 2, 25, 0, false}, kSteps); }
  SECTION("moving") { timeHumanoids({"moving on the ground", 22, 0, 2, 25, 2, false}, kSteps); }
  SECTION("wild") { timeHumanoids({"wild", 22, 0.2, 2, 25, 6, true}, kSteps); }
  SECTION("weak") { timeHumanoids({"weak", 22, 0.2, 2, 0.6, 6, true}, kSteps); }
  SECTION("pushing") { timeHumanoids({"six pushing each other", 6, 0, 0.18, 25, 1, false}, 40); }
  SECTION("boxes") { timeBoxes(1000, 60); }
}
