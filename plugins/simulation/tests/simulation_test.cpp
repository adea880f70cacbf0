#include <catch2/catch.hpp>
#include <chrono>
#include <deque>
#include <string>

#include "api/phases.h"
#include "spark/error.h"
#include "spark/state.h"
#include "test_support.h"

using namespace spark;

namespace {
/// An input source and gate that records its calls. The gate opens after a number of waits.
class Batches : public Node, public IInputSource, public IInputGate {
  SPARK_CLASS(Batches, Node)
 public:
  static void describe(Description<Batches>& d) {
    d.implements<IInputSource>();
    d.implements<IInputGate>();
  }
  void poll() override { log += "p"; }
  bool wait(double seconds) override {
    log += "w";
    waited += seconds;
    if (waitsBeforeReady > 0) --waitsBeforeReady;
    if (stopAt > 0 && --stopAt == 0) kernel().requestStop();
    return true;
  }
  bool ready(bool lockstep) override {
    seenLockstep = lockstep;
    return waitsBeforeReady == 0;
  }
  std::string log;
  double waited = 0;
  int waitsBeforeReady = 0, stopAt = 0;
  bool seenLockstep = false;
};

/// A source that is only polled.
class Polled : public Node, public IInputSource {
  SPARK_CLASS(Polled, Node)
 public:
  static void describe(Description<Polled>& d) { d.implements<IInputSource>(); }
  void poll() override { ++polls; }
  bool wait(double) override { return ++waits, false; }
  bool canWait() const override { return false; }
  int polls = 0, waits = 0;
};

/// A source that counts calls when none of its class is left.
class Removed : public Node, public IInputSource {
  SPARK_CLASS(Removed, Node)
 public:
  Removed() { ++living; }
  ~Removed() override { --living; }
  static void describe(Description<Removed>& d) { d.implements<IInputSource>(); }
  void poll() override {}
  bool wait(double) override { return count(); }
  bool canWait() const override { return count(); }
  static inline int living = 0, late = 0;

 private:
  static bool count() {
    if (living == 0) ++late;
    return living > 0;
  }
};

/// A gate that opens a second after its first check.
class ClosedForASecond : public Node, public IInputGate {
  SPARK_CLASS(ClosedForASecond, Node)
 public:
  static void describe(Description<ClosedForASecond>& d) { d.implements<IInputGate>(); }
  bool ready(bool) override {
    const auto now = std::chrono::steady_clock::now();
    if (opensAt_ == std::chrono::steady_clock::time_point()) opensAt_ = now + std::chrono::seconds(1);
    return now >= opensAt_;
  }

 private:
  std::chrono::steady_clock::time_point opensAt_{};
};

/// Takes a while in its phase, in wall time.
class Slow : public Node {
  SPARK_CLASS(Slow, Node)
 public:
  static void describe(Description<Slow>& d) { d.on<&Slow::act>(phase::kAct); }
  void act(const Event&) {
    for (const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(3);
         std::chrono::steady_clock::now() < end;) {
    }
  }
};

struct LoopFixture {
  test::TestHost host;
  Leaf* simulation = nullptr;
  ISimulation* loop = nullptr;
  LoopFixture() {
    host.kernel.registerClass<Batches>();
    host.kernel.registerClass<Polled>();
    host.kernel.registerClass<Slow>();
    host.kernel.registerClass<ClosedForASecond>();
    host.kernel.plugins().use("simulation");
    simulation = &host.kernel.create("Simulation", "/sys/server/simulation");
    loop = simulation->as<ISimulation>();
    setProperty(*simulation, "rate", "max");
  }
  void runCycles(int n) { callMethod(*simulation, "runCycles", std::vector<Value>{n}); }
  void run() { callMethod(*simulation, "run", {}); }
};
}  // namespace

TEST_CASE("A cycle runs its phases in the designed order") {
  LoopFixture f;
  std::string order;
  for (const char* name : {"publish", "sense", "rule", "place", "physics", "prepare", "act"})
    f.host.kernel.events().channel(name).add(f.host.kernel.root(),
                                             [&](Leaf&, const Event& e) { order += std::string(e.name) + " "; });
  f.runCycles(1);
  REQUIRE(order == "act prepare physics place rule sense publish ");
}

TEST_CASE("Time is the sum of executed steps, and phases after the solver see the new time") {
  LoopFixture f;
  double act = -1, sense = -1, step = 0;
  std::int64_t cycle = 0;
  f.host.kernel.events().channel("act").add(f.host.kernel.root(), [&](Leaf&, const Event& e) { act = e.time; });
  f.host.kernel.events().channel("sense").add(
      f.host.kernel.root(), [&](Leaf&, const Event& e) { sense = e.time, step = e.step, cycle = e.cycle; });
  REQUIRE(f.loop->cycle() == 0);
  f.runCycles(1);
  REQUIRE(act == 0);
  REQUIRE(sense == Approx(0.02));
  REQUIRE(step == Approx(0.02));
  REQUIRE(cycle == 1);
  f.runCycles(4);
  REQUIRE(f.loop->cycle() == 5);
  REQUIRE(f.loop->time() == Approx(0.1));
}

TEST_CASE("run ends after exactly the cycles of its duration") {
  LoopFixture f;
  setProperty(*f.simulation, "duration", 600.0);
  f.run();
  REQUIRE(f.loop->cycle() == 30000);
}

TEST_CASE("run ends when the kernel or a script requests a stop") {
  LoopFixture f;
  f.host.kernel.events().channel("sense").add(f.host.kernel.root(), [&](Leaf&, const Event& e) {
    if (e.cycle == 7) callMethod(*f.simulation, "stop", {});
    if (e.cycle == 9) f.host.kernel.requestStop();
  });
  f.run();
  REQUIRE(f.loop->cycle() == 7);
  f.run();
  REQUIRE(f.loop->cycle() == 9);
  f.run();
  REQUIRE(f.loop->cycle() == 9);
}

TEST_CASE("A program can step, pace and stop the loop through its interface") {
  LoopFixture f;
  f.loop->setPaced(true);
  REQUIRE(f.loop->paced());
  REQUIRE(getProperty(*f.simulation, "rate") == Value("real"));
  f.loop->setPaced(false);
  REQUIRE_FALSE(f.loop->paced());
  f.host.kernel.events().channel("rule").add(f.host.kernel.root(), [&](Leaf&, const Event& e) {
    if (e.cycle == 3) f.loop->stop();
    if (e.cycle == 5) REQUIRE_THROWS_WITH(f.loop->runCycles(1), Catch::Contains("runs already"));
  });
  f.loop->runCycles(10);
  REQUIRE(f.loop->cycle() == 3);
  f.loop->runCycles(10);
  REQUIRE(f.loop->cycle() == 13);
  setProperty(*f.simulation, "duration", 0.4);
  f.loop->run();
  REQUIRE(f.loop->cycle() == 20);
}

TEST_CASE("A cycle waits until all gates are open, then polls its input once more") {
  LoopFixture f;
  auto& source = f.host.kernel.create<Batches>("Batches", "/sys/server/net");
  source.waitsBeforeReady = 3;
  setProperty(*f.simulation, "sync", true);
  f.runCycles(1);
  REQUIRE(source.log == "pwwwp");
  REQUIRE(source.seenLockstep);
  REQUIRE(f.loop->cycle() == 1);
  REQUIRE(f.loop->time() == Approx(0.02));
}

TEST_CASE("In lockstep input is polled once more though no gate was closed, since ports are polled one by one") {
  LoopFixture f;
  auto& source = f.host.kernel.create<Batches>("Batches", "/sys/server/net");
  const bool sync = GENERATE(true, false);
  setProperty(*f.simulation, "sync", sync);
  f.runCycles(1);
  REQUIRE(source.log == (sync ? "pp" : "p"));
}

TEST_CASE("A cycle may remove the source that the loop would wait in") {
  LoopFixture f;
  f.host.kernel.registerClass<Removed>();
  for (const char* name : {"first", "other"}) f.host.kernel.create("Removed", fmt::format("/sys/server/{}", name));
  f.host.kernel.create<Polled>("Polled", "/sys/server/polled");
  // Two of three go, and the loop waits next: the list of sources is shorter then.
  f.host.kernel.events().channel("rule").add(f.host.kernel.root(), [&](Leaf& root, const Event& e) {
    if (e.cycle != 2) return;
    Node& servers = root.require<Node>("/sys/server");
    for (const char* name : {"first", "other"}) servers.remove(*servers.find(name));
    setProperty(*f.simulation, "rate", "real");
  });
  f.runCycles(3);
  REQUIRE(f.loop->cycle() == 3);
  REQUIRE(Removed::living == 0);
  REQUIRE(Removed::late == 0);
}

TEST_CASE("A stop request ends the wait for a gate that never opens") {
  LoopFixture f;
  auto& source = f.host.kernel.create<Batches>("Batches", "/sys/server/net");
  source.waitsBeforeReady = 1000000;
  source.stopAt = 5;
  f.run();
  REQUIRE(f.loop->cycle() == 0);
  REQUIRE(source.log == "pwwwww");
}

TEST_CASE("A source that cannot wait is polled before every cycle") {
  LoopFixture f;
  auto& polled = f.host.kernel.create<Polled>("Polled", "/sys/server/control");
  f.runCycles(10);
  REQUIRE(polled.polls == 10);
  REQUIRE(polled.waits == 0);
}

TEST_CASE("In real time the simulation is never faster than wall time") {
  LoopFixture f;
  setProperty(*f.simulation, "rate", "real");
  const auto start = std::chrono::steady_clock::now();
  f.runCycles(6);
  const double spent = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  REQUIRE(spent >= 5 * 0.02);
}

TEST_CASE("A run that was faster than real time goes on at once when it is paced again") {
  LoopFixture f;
  constexpr std::int64_t kAhead = 20000;  // cycles: 400 s, in no time
  f.host.kernel.events().channel("publish").add(f.host.kernel.root(), [&f](Leaf&, const Event& event) {
    if (event.cycle == kAhead) setProperty(*f.simulation, "rate", "real");
  });
  const auto begin = std::chrono::steady_clock::now();
  f.runCycles(kAhead + 3);
  // It does not wait for what it was ahead.
  CHECK(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() < 200);
}

TEST_CASE("Lost time and late cycles are reported in real time only") {
  for (const char* rate : {"real", "max"}) {
    LoopFixture f;
    setProperty(*f.simulation, "rate", rate);
    f.host.kernel.events().channel("physics").add(f.host.kernel.root(), [](Leaf&, const Event&) {
      const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(45);
      while (std::chrono::steady_clock::now() < end) {
      }
    });
    f.runCycles(3);
    const double lost = getProperty(*f.simulation, "lostTime").toNumber();
    const std::int64_t late = getProperty(*f.simulation, "lateCycles").toInteger();
    if (rate == std::string("real")) {
      REQUIRE(lost >= 2 * 0.025 - 1e-9);
      REQUIRE((late == 2 || late == 3));
    } else {
      REQUIRE((lost == 0 && late == 0));
    }
  }
}

TEST_CASE("Waiting for a gate does not count as lost time") {
  LoopFixture f;
  setProperty(*f.simulation, "rate", "real");
  f.host.kernel.create<ClosedForASecond>("ClosedForASecond", "/sys/server/gate");
  const auto begin = std::chrono::steady_clock::now();
  f.runCycles(3);
  const double spent = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  REQUIRE(getProperty(*f.simulation, "lostTime").toNumber() <= spent - 1);
}

TEST_CASE("Input is read while the loop waits for real time") {
  LoopFixture f;
  auto& source = f.host.kernel.create<Batches>("Batches", "/sys/server/net");
  setProperty(*f.simulation, "rate", "real");
  while (source.log.find('w') == std::string::npos) f.runCycles(2);  // unless it comes too late for the second one
  REQUIRE(source.waited > 0);
}

TEST_CASE("Wall time is measured per phase and is not part of the state") {
  LoopFixture f, g;
  f.runCycles(3);
  g.runCycles(3);
  const Value micros = getProperty(*f.simulation, "phaseMicros");
  REQUIRE(micros.toList().size() == 8);
  REQUIRE(micros.at("physics")->toNumber() > 0);
  REQUIRE(stateHash(*f.simulation) == stateHash(*g.simulation));
  callMethod(*f.simulation, "resetTimers", {});
  REQUIRE(getProperty(*f.simulation, "phaseMicros").at("physics")->toNumber() == 0);
}

TEST_CASE("A run within a run is refused and does no harm") {
  LoopFixture f;
  std::string refusal;
  f.host.kernel.events().channel("rule").add(f.host.kernel.root(), [&](Leaf&, const Event& e) {
    if (e.cycle != 2) return;
    try {
      f.run();
    } catch (const Error& error) {
      refusal = error.what();
    }
  });
  f.runCycles(3);
  REQUIRE(f.loop->cycle() == 3);
  REQUIRE(refusal.find("/sys/server/simulation runs already") != std::string::npos);
}

TEST_CASE("Cycle and time are saved and restored") {
  LoopFixture f, g;
  f.runCycles(8);
  StateWriter out(true);
  saveTree(*f.simulation, out);
  REQUIRE(stateHash(*g.simulation) != stateHash(*f.simulation));
  StateReader in(out.bytes());
  loadTree(*g.simulation, in);
  REQUIRE(g.loop->cycle() == 8);
  REQUIRE(stateHash(*g.simulation) == stateHash(*f.simulation));
}

TEST_CASE("The property threads sets the number of threads") {
  LoopFixture f;
  setProperty(*f.simulation, "threads", 4);
  REQUIRE(f.host.kernel.jobs().threads() == 4);
  REQUIRE_THROWS_AS(setProperty(*f.simulation, "threads", 0), Error);
}

TEST_CASE("Cycles are counted by their duration, and in real time also by their delay") {
  LoopFixture f;
  f.host.kernel.create("Slow", "/usr/slow");
  setProperty(*f.simulation, "step", 0.001);
  const auto row = [&f](std::size_t i) { return getProperty(*f.simulation, "cycleTimes").toList().at(i).toList(); };
  f.runCycles(3);
  CHECK(row(0)[0].toString() == "late");
  CHECK(row(0)[1].toInteger() == 0);  // no cycle can be late at the maximum rate
  CHECK(row(1)[1].toInteger() == 3);
  CHECK(row(1)[2].toNumber() >= 3000);  // the median
  CHECK(row(1)[6].toNumber() >= row(1)[5].toNumber());

  setProperty(*f.simulation, "rate", "real");
  f.runCycles(3);
  CHECK(row(0)[1].toInteger() == 3);
  CHECK(row(0)[6].toNumber() >= 2000);  // a cycle takes 3 ms, and the next one is due after 1 ms
  CHECK(row(2)[1].toInteger() == 3);
  CHECK(row(2)[6].toNumber() >= 5000);
  std::int64_t counted = 0;
  const Value histogram = getProperty(*f.simulation, "histogram");
  for (const Value& bucket : histogram.toList()) counted += bucket.at(2)->toInteger();
  CHECK(counted == 6);
  const std::string table = callMethod(*f.simulation, "paceTable", {}).toString();
  CHECK(table.find("late") != std::string::npos);
  CHECK(table.find("99.9 %") != std::string::npos);

  callMethod(*f.simulation, "resetTimers", {});
  CHECK(row(1)[1].toInteger() == 0);
  CHECK(getProperty(*f.simulation, "histogram").toList().empty());
}
