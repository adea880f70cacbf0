#include "simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <thread>

#include "spark/error.h"
#include "spark/plugin.h"
#include "spark/running.h"
#include "spark/state.h"

// One cycle, and where it waits:
//
//   wait for the clock ─► input ─► act ─► prepare ─► physics ─► place ─► rule ─► sense ─► publish
//   (real time only;       │
//    input is processed    └ poll all sources; while a gate is closed, wait for input and check the gates again;
//    meanwhile)              then poll once more: input that had arrived with the last answer belongs to this cycle
//
// All waiting is done in the wait() of an input source, so that input is processed as it arrives. It is done in slices,
// so that a stop request and sources without a wait() are noticed soon. Waiting does not change the state: the
// simulated clock does not advance. In real time, the time by which a cycle exceeds its step is lost, and counted as
// such: the simulation becomes slower and never catches up.
//
// Unlike in the installed base, the first cycle has a step like every other. Agents cannot observe the difference,
// because their robots exist from the end of the first act phase at the earliest; and time is always cycles * step.

namespace spark {

namespace {
constexpr double kSlice = 0.02;    // longest single wait [s]: bounds the delay of a stop request and of polled sources
constexpr double kJitter = 0.002;  // lateness [s] that the next cycles may make up for; more is lost time
constexpr const char* kTakesInput = "it takes input just now";  // reason why a source cannot be removed during a call
constexpr const char* kInput = "input";  // name of the input part, for crash reports and watchdogs
using simulation::Part;

double secondsUntil(std::chrono::steady_clock::time_point t) {
  return std::chrono::duration<double>(t - std::chrono::steady_clock::now()).count();
}
}  // namespace

void Simulation::describe(Description<Simulation>& d) {
  d.doc("The run loop: defines the phases and runs them.");
  d.implements<ISimulation>();
  d.link(&Simulation::sources_, At<Node>("/sys/server").child<IInputSource>());
  d.link(&Simulation::tape_, At<IInputTape>()).doc("Records inputs, or plays recorded ones.");
  d.link(&Simulation::gates_, At<Node>("/").below<IInputGate>());
  d.property("step", &Simulation::step_).unit("s").range(1e-6, 1).doc("Simulated time of one cycle.");
  d.property("rate", &Simulation::rate_)
      .choices({"real", "max"})
      .doc("real: paced to wall time; max: as fast as possible.");
  d.property("sync", &Simulation::sync_).doc("Lockstep: a cycle starts when every agent has answered.");
  d.property("duration", &Simulation::duration_)
      .unit("s")
      .min(0)
      .doc("Simulated time after which run() ends; 0: never.");
  d.property("threads", &Simulation::threads, &Simulation::setThreads)
      .range(1, 64)
      .doc("Threads of the host for physics, sensing and encoding. Results do not depend on it.");
  d.property("cycle", &Simulation::cycle).doc("Number of the current cycle, from 1; 0 before the first.");
  d.property("time", &Simulation::time).unit("s").doc("Simulated time since the start.");
  d.property("phaseMicros", &Simulation::phaseMicros)
      .ofProcess()
      .doc("Mean wall time per cycle of each phase since resetTimers() [microseconds].");
  d.property("cycleTimes", &Simulation::cycleTimes)
      .ofProcess()
      .doc(
          "Three lists {name, cycles, p50, p90, p99, p99.9, longest} of wall time since resetTimers() [microseconds]: "
          "late, from the time a cycle was due to its beginning; long, from its beginning to its end; done, from "
          "the time it was due to its end.");
  d.property("histogram", &Simulation::histogram)
      .ofProcess()
      .doc(
          "The same as a histogram, a list {from, late, long, done} for each bucket that is not empty: its lower end "
          "[microseconds], and the numbers of cycles in it.");
  d.property("lostTime", &Simulation::lostTime_)
      .unit("s")
      .readOnly()
      .ofProcess()
      .doc(
          "Wall time by which cycles began too late in real time, because earlier ones took longer than a step. It is "
          "not made up for.");
  d.property("lateCycles", &Simulation::lateCycles_)
      .readOnly()
      .ofProcess()
      .doc("Number of cycles that began too late in real time.");
  d.property("faults", &Simulation::faults)
      .ofProcess()
      .doc(
          "Number of faults of plugins and scripts that were caught while the simulation ran; the log has the first of "
          "each place.");
  d.method("run", &Simulation::run).doc("Runs until duration is reached or a stop is requested.");
  d.method("runCycles", &Simulation::runCycles).parameters({"count"}).doc("Runs that many cycles.");
  d.method("paceTable", &Simulation::paceTable)
      .doc("cycleTimes and histogram as a formatted table, with wider buckets.");
  d.method("stop", &Simulation::stop).doc("Ends run() after the current cycle.");
  d.method("resetTimers", &Simulation::resetTimers).doc("Resets phaseMicros, cycleTimes and histogram.");
}

void Simulation::onLink() {
  Events& events = kernel().events();
  act_ = &events.define(phase::kAct, Order::parentsFirst, "Agents' messages are executed; immediate effectors act.");
  prepare_ =
      &events.define(phase::kPrepare, Order::childrenFirst, "Deferred actions, controllers, sampling before the step.");
  physics_ =
      &events.define(phase::kPhysics, Order::parentsFirst, "Contacts, collision handlers, joints, one solver step.");
  place_ = &events.define(phase::kPlace, Order::parentsFirst, "Bodies write transforms; world matrices are updated.");
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

template <class More>
void Simulation::loop(More more) {
  // A trainer or sparkctl may call run() while it runs.
  if (running_)
    throw Error(fmt::format("{} runs already: run() and runCycles() cannot be called from within a cycle", path()));
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

bool Simulation::finished() const {
  // Half a step of tolerance: the sum of steps is not exact.
  return stopping() || (duration_ > 0 && time_ > duration_ - 0.5 * step_);
}

void Simulation::poll() {
  NowRunning now(kInput);
  now.beat();
  if (tape_ && tape_->playing()) tape_->play();
  // Input changes the tree (agents connect and disconnect): the list is fetched again for every source.
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
  if (tape_ && tape_->playing()) return poll();
  // The first source that can wait; sources that cannot are polled after it.
  const double slice = std::min(seconds, kSlice);
  const auto canWait = [](const Found<IInputSource>& s) { return s->canWait(); };
  const std::vector<Found<IInputSource>>& sources = sources_.all();  // now: the last cycle may have removed some
  const auto waiter = std::find_if(sources.begin(), sources.end(), canWait);
  const bool found = waiter != sources.end();
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
  // Wait until the cycle is due.
  while (paced() && !stopping() && !(tape_ && tape_->playing())) {
    const double remaining = secondsUntil(due_);
    if (remaining <= 0) break;
    waitForInput(remaining);
  }

  // The next one is due a step later: after this due time if the cycle starts in time, else after now.
  startDue_ = due_;
  const double late = -secondsUntil(due_);
  if (late > kJitter) {
    due_ = Clock::now();
    if (paced()) lostTime_ += late, ++lateCycles_;
  }
  if (!paced()) due_ = Clock::now();  // simulated time runs ahead; when it is paced again it goes on at once
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
  // In lockstep everything counts that was sent before the answer that opened the last gate, at whatever port: the poll
  // that read the answer may have looked at another port too early.
  if (waited || sync_) poll();
  if (waited) {
    // Waiting for agents is no lost time.
    due_ = std::max(due_, Clock::now());
    startDue_ = std::max(startDue_, Clock::now());
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
  if (tape_) tape_->put({.kind = Input::Kind::cycle, .number = cycle_});
  auto mark = Clock::now();
  pace_.begin(startDue_, mark, paced());
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
             "The run loop: defines the phases and runs them in real time, in lockstep, or as fast as possible.",
             spark::Simulation)
