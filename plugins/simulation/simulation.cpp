#include "simulation.h"

#include <algorithm>
#include <thread>

#include "spark/error.h"
#include "spark/plugin.h"
#include "spark/running.h"
#include "spark/state.h"

// One cycle, and where waiting happens:
//
//   wait for the clock ─► input ─► act ─► prepare ─► physics ─► place ─► rule ─► sense ─► publish
//   (real time only;       │
//    input is taken        └ poll all sources; while a gate is closed, wait for input and ask again;
//    meanwhile)              then poll once more: what was received when the last answer was read counts
//
// All waiting is inside a source's wait(), so that input is taken as it comes, and in slices, so that a stop request
// and sources that can only be polled are seen soon. Waiting never shows in the state: the simulated clock stands still
// meanwhile. In real time, what a cycle takes longer than its step is dropped, and counted: the simulation gets slower,
// it never catches up with double steps.
//
// Unlike the original, the first cycle has a step like every other: nobody can see the difference (an agent's robot
// exists from the end of a cycle's act phase at the earliest), and cycles * step is the time.

namespace spark {

namespace {
constexpr double kSlice = 0.02;  // s; bound on the delay of a stop request and of polled sources
constexpr const char* kTakesInput = "it takes input just now";
constexpr double kJitter = 0.002;        // s; a cycle that starts later than this lost time that is not made up for
constexpr const char* kInput = "input";  ///< as a phase, for last words and watchdogs
using simulation::Part;

double secondsUntil(std::chrono::steady_clock::time_point t) {
  return std::chrono::duration<double>(t - std::chrono::steady_clock::now()).count();
}
}  // namespace

void Simulation::describe(Description<Simulation>& d) {
  d.doc("The run loop: names the phases and drives them.");
  d.implements<ISimulation>();
  d.link(&Simulation::sources_, At<Node>("/sys/server").child<IInputSource>());
  d.link(&Simulation::gates_, At<Node>("/").below<IInputGate>());
  d.property("step", &Simulation::step_).unit("s").range(1e-6, 1).doc("Simulated time of one cycle.");
  d.property("rate", &Simulation::rate_)
      .choices({"real", "max"})
      .doc("real: paced to wall time; max: as fast as it goes.");
  d.property("sync", &Simulation::sync_).doc("Lockstep: a cycle starts when every agent has answered.");
  d.property("duration", &Simulation::duration_)
      .unit("s")
      .min(0)
      .doc("Simulated time after which run() ends; 0: never.");
  d.property("threads", &Simulation::threads, &Simulation::setThreads)
      .range(1, 64)
      .doc("Host threads for physics, sensing and encoding. Results do not depend on it.");
  d.property("cycle", &Simulation::cycle).doc("Number of the current cycle, from 1; 0 before the first.");
  d.property("time", &Simulation::time).unit("s").doc("Simulated time since the start.");
  d.property("phaseMicros", &Simulation::phaseMicros)
      .doc("Mean wall time per cycle of each phase since resetTimers() [microseconds].");
  d.property("cycleTimes", &Simulation::cycleTimes)
      .doc(
          "Three lists {name, cycles, p50, p90, p99, p99.9, longest} of wall time since resetTimers() [microseconds]: "
          "late, from when a cycle was due in real time to "
          "its beginning; long, from its beginning to its end; done, from when it was due to its end.");
  d.property("histogram", &Simulation::histogram)
      .doc(
          "The same in buckets, a list {from, late, long, done} for each that has any: where it begins [microseconds], "
          "and how many cycles are in it.");
  d.property("lostTime", &Simulation::lostTime_)
      .unit("s")
      .readOnly()
      .doc(
          "Wall time by which cycles began too late in real time, because those before took longer than a step. It is "
          "not made up for.");
  d.property("lateCycles", &Simulation::lateCycles_).readOnly().doc("Cycles that began too late in real time.");
  d.property("faults", &Simulation::faults)
      .doc(
          "Faults of plugins and scripts that were caught while the simulation ran; the log tells the first of each "
          "place.");
  d.method("run", &Simulation::run).doc("Runs until duration is reached or something asks to stop.");
  d.method("runCycles", &Simulation::runCycles).parameters({"count"}).doc("Runs that many cycles.");
  d.method("paceTable", &Simulation::paceTable)
      .doc("cycleTimes and histogram as a table for people, with wider buckets.");
  d.method("stop", &Simulation::stop).doc("Ends run() after the current cycle.");
  d.method("resetTimers", &Simulation::resetTimers).doc("Starts phaseMicros, cycleTimes and histogram anew.");
}

void Simulation::onLink() {
  Events& events = kernel().events();
  act_ = &events.define(phase::kAct, Order::parentsFirst, "Agents' messages are realised; immediate effectors act.");
  prepare_ =
      &events.define(phase::kPrepare, Order::childrenFirst, "Deferred actions, controllers, sampling before the step.");
  physics_ =
      &events.define(phase::kPhysics, Order::parentsFirst, "Contacts, collision handlers, joints, one solver step.");
  place_ = &events.define(phase::kPlace, Order::parentsFirst, "Bodies write transforms; world matrices.");
  rule_ = &events.define(phase::kRule, Order::parentsFirst, "Control aspects see the new world.");
  sense_ = &events.define(phase::kSense, Order::parentsFirst, "Perceptors read the world.");
  publish_ = &events.define(phase::kPublish, Order::parentsFirst, "Monitors and recorders take a frame.");
  kernel().jobs().setThreads(threads_);
}

void Simulation::setThreads(int count) {
  threads_ = count;
  if (isLinked()) kernel().jobs().setThreads(count);
}

void Simulation::saveState(StateWriter& out) const {
  out.write(cycle_);
  out.write(time_);
}

void Simulation::loadState(StateReader& in) {
  cycle_ = in.readInteger();
  time_ = in.readNumber();
}

void Simulation::run() {
  loop([this] { return !finished(); });
}

void Simulation::runCycles(std::int64_t count) {
  loop([&count] { return count-- > 0; });
}

// A trainer or sparkctl may call what it likes, also run() while it runs.
template <class More>
void Simulation::loop(More more) {
  if (running_) throw Error(path() + " runs already: run() and runCycles() cannot be called from within a cycle");
  struct Running {
    explicit Running(bool& f) : flag(f) { flag = true; }
    ~Running() { flag = false; }
    bool& flag;
  } running(running_);
  const InUse atWork(*this, "the run loop is at work; stop() ends it after the current cycle");
  const InUse servers(kernel().root().require<Node>("/sys"), "servers keep their names while the run loop is at work",
                      InUse::kAllBelow);
  const InUse scenes(kernel().root().require<Node>("/usr"), "scenes keep their names while the run loop is at work", 1);
  stopped_ = false;
  due_ = Clock::now();
  while (more() && collectInput()) executeCycle();
}

// Half a step of tolerance: the sum of steps is not exact.
bool Simulation::finished() const { return stopping() || (duration_ > 0 && time_ > duration_ - 0.5 * step_); }

// Input changes the tree (agents come and go), so positions are looked up anew for every source.
void Simulation::poll() {
  NowRunning now(kInput);
  now.beat();
  for (std::size_t i = 0;; ++i) {
    const std::vector<Found<IInputSource>>& sources = sources_.all();
    if (i >= sources.size()) return;
    const InUse polled(*sources[i].leaf, kTakesInput);
    now.at(sources[i].leaf);
    sources[i]->poll();
  }
}

bool Simulation::gatesOpen() {
  for (std::size_t i = 0;; ++i) {
    const std::vector<Found<IInputGate>>& gates = gates_.all();
    if (i >= gates.size()) return true;
    if (!gates[i]->ready(sync_)) return false;
  }
}

void Simulation::waitForInput(double seconds) {
  const double slice = std::min(seconds, kSlice);
  const auto canWait = [](const Found<IInputSource>& s) { return s->canWait(); };
  const auto waiter = std::find_if(sources_.begin(), sources_.end(), canWait);
  const bool found = waiter != sources_.end();
  NowRunning now(kInput, found ? waiter->leaf : nullptr);
  now.beat();
  if (found) {
    const InUse waited(*waiter->leaf, kTakesInput);
    (*waiter)->wait(slice);
  } else {
    std::this_thread::sleep_for(std::chrono::duration<double>(slice));
  }
  if (sources_.size() > 1) poll();
}

void Simulation::waitForClock() {
  while (paced() && !stopping()) {
    const double left = secondsUntil(due_);
    if (left <= 0) break;
    waitForInput(left);
  }
  wanted_ = due_;
  const double late = -secondsUntil(due_);
  if (late > kJitter) {
    due_ = Clock::now();
    if (paced()) lostTime_ += late, ++lateCycles_;
  }
  due_ += std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(step_));
}

bool Simulation::collectInput() {
  waitForClock();
  kernel().plugins().settle();
  const auto mark = Clock::now();
  poll();
  bool waited = false;
  while (!stopping() && !gatesOpen()) {
    waitForInput(kSlice);
    waited = true;
  }
  if (stopping()) return false;
  if (waited) {
    poll();
    due_ = std::max(due_, Clock::now());  // the clock stood still for agents: that is not lost
    wanted_ = std::max(wanted_, Clock::now());
  }
  timers_.add(Part::input, waited ? Clock::duration::zero() : Clock::now() - mark);
  return !stopping();
}

void Simulation::emit(Part part, Channel& channel, Clock::time_point& mark) {
  Event event;
  event.name = channel.name();
  event.time = time_;
  event.step = step_;
  event.cycle = cycle_;
  channel.emit(event);
  const auto now = Clock::now();
  timers_.add(part, now - mark);
  mark = now;
}

void Simulation::executeCycle() {
  ++cycle_;
  auto mark = Clock::now();
  pace_.begin(wanted_, mark, paced());
  emit(Part::act, *act_, mark);
  emit(Part::prepare, *prepare_, mark);
  emit(Part::physics, *physics_, mark);
  time_ += step_;
  emit(Part::place, *place_, mark);
  emit(Part::rule, *rule_, mark);
  emit(Part::sense, *sense_, mark);
  emit(Part::publish, *publish_, mark);
  pace_.end(mark);
  timers_.cycleDone();
}

}  // namespace spark

SPARK_PLUGIN("simulation", "1.0",
             "The run loop: names the phases and drives them in real time, in lockstep, or as fast as possible.",
             spark::Simulation)
