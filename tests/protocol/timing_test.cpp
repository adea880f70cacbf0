#include <catch2/catch.hpp>

#include "arena.h"
#include "spark/error.h"

// Latencies of percepts and actions, for agents over the network and inside the host.

using namespace spark;
using namespace spark::test;

namespace {
/// Notes when it thinks and when its percepts were sensed, and commands `(he1 <cycle>)`.
class TimedBehavior : public Behavior {
  SPARK_CLASS(TimedBehavior, Behavior)
 public:
  static void describe(Description<TimedBehavior>& d) { d.doc("Notes the age of its percepts."); }
  void start(Predicates& actions) override { actions.open("scene").add("robot").close(); }
  void think(const Predicates& percepts, Predicates& actions) override {
    const double now = (*percepts.begin()).named("now").at(1).number();
    ages.push_back(static_cast<int>(arena->cycles() - std::lround(now / 0.02)));
    actions.open("he1").add(arena->cycles()).close();
  }
  Arena* arena = nullptr;
  std::vector<int> ages;  ///< cycles between sensing and thinking
};

TimedBehavior& addBehavior(Arena& a, const char* path = "/usr/agent/b") {
  if (!a.kernel.root().find("/usr/agent")) a.kernel.registerClass<TimedBehavior>();
  auto& b = a.kernel.create<TimedBehavior>("TimedBehavior", path);
  b.arena = &a;
  return b;
}

/// A client whose robot has sent its first percepts.
Client clientWithRobot(Arena& a) {
  Client c = a.client();
  const auto before = a.agents();
  a.until([&] { return a.agents() > before; });
  c.send("(scene robot)(syn)");
  a.until([&] { return !c.drain().empty(); });
  return c;
}

/// Runs a cycle with the action; the number of further cycles until it takes effect.
int cyclesToEffect(Arena& a, Client& c) {
  c.send("(he1 7)");
  c.arrive();
  actionLog().clear();
  for (int n = 0; n < 100; ++n) {
    a.cycle();
    if (!actionLog().empty()) return n;
  }
  throw Error("the action had no effect");
}

/// Runs a cycle in which a message comes; the cycles since it was sensed.
int ageOfPercepts(Arena& a, Client& c) {
  a.cycle();
  const std::string message = c.receive().value();
  const auto now = message.find("now ");
  return static_cast<int>(a.cycles() - std::lround(std::stod(message.substr(now + 4)) / 0.02));
}

void saveControl(Arena& a, std::string& to) {
  StateWriter out(true);
  saveTree(*a.kernel.root().find("/sys/server/gamecontrol"), out);
  to = out.bytes();
}
}  // namespace

TEST_CASE("Actions of a client take effect exactly actLatency cycles later") {
  for (const int latency : {0, 1, 3, 20}) {
    Arena a;
    a.setTiming("actLatency", latency);
    Client c = clientWithRobot(a);
    for (int i = 0; i < 3; ++i) CHECK(cyclesToEffect(a, c) == latency);
  }
}

TEST_CASE("Percepts of a client arrive exactly senseLatency cycles after they were sensed, one message in each cycle") {
  for (const int latency : {0, 1, 2, 20}) {
    Arena a;
    a.setTiming("senseLatency", latency);
    Client c = clientWithRobot(a);
    for (int i = 0; i < 30; ++i) CHECK(ageOfPercepts(a, c) == latency);
    CHECK(c.drain().empty());
  }
}

TEST_CASE("A behavior has the latencies of a client") {
  for (const int sense : {0, 1, 4})
    for (const int act : {0, 3}) {
      Arena a;
      a.setTiming("senseLatency", sense);
      a.setTiming("actLatency", act);
      TimedBehavior& b = addBehavior(a);
      for (int i = 0; i < 30; ++i) {
        actionLog().clear();
        a.cycle();
        // What it decided in a cycle departs in the next one.
        if (!actionLog().empty()) CHECK(actionLog().front() == fmt::format("1 he1 {}", a.cycles() - 1 - act));
      }
      CHECK(actionLog().size() == 1);
      REQUIRE(b.ages.size() > 15);
      CHECK(b.ages == std::vector<int>(b.ages.size(), sense));
    }
}

TEST_CASE("The robot of an agent with latencies comes later by actLatency, its first percepts by both") {
  const auto firstThought = [](int sense, int act) {
    Arena a;
    a.setTiming("senseLatency", sense);
    a.setTiming("actLatency", act);
    const TimedBehavior& b = addBehavior(a);
    while (b.ages.empty()) a.cycle();
    return static_cast<int>(a.cycles());
  };
  const int plain = firstThought(1, 0);
  CHECK(firstThought(1, 3) == plain + 3);
  CHECK(firstThought(5, 0) == plain + 4);
  CHECK(firstThought(5, 3) == plain + 7);
}

TEST_CASE("In lockstep each answer allows one cycle, whatever the latencies") {
  Arena a(true);
  a.set("expect", 1);
  a.setTiming("senseLatency", 4);
  a.setTiming("actLatency", 2);
  Client c = a.client();
  c.send("(scene robot)(init (unum 1)(teamname A))(syn)");
  a.until([&] { return !c.drain().empty(); });
  for (int i = 1; i <= 20; ++i) {
    REQUIRE_FALSE(a.step());
    c.send(fmt::format("(he1 {})(syn)", i));
    c.arrive();
    actionLog().clear();
    REQUIRE(a.step());
    REQUIRE(c.receive().has_value());
    if (i > 2) CHECK(actionLog().back() == fmt::format("1 he1 {}", i - 2));
  }
}

TEST_CASE("In lockstep latencies may change: each message is answered once, and a cycle without one waits for nobody") {
  Arena a(true);
  a.set("expect", 1);
  Client c = a.client();
  c.send("(scene robot)(init (unum 1)(teamname A))(syn)");
  a.until([&] { return !c.drain().empty(); });
  const auto answer = [&](const char* actions) {
    c.send(actions);
    c.arrive();
  };
  const auto run = [&](int cycles) {  // in each of which one message comes and is answered
    for (int i = 0; i < cycles; ++i) {
      REQUIRE_FALSE(a.step());
      answer("(syn)");
      REQUIRE(a.step());
      REQUIRE(c.receive().has_value());
    }
  };
  run(5);
  // Of what was sensed with the old latency one message is under way.
  a.setTiming("senseLatency", 5);
  run(1);
  answer("(syn)");
  const auto before = a.cycles();
  for (int i = 0; i < 2; ++i) REQUIRE(a.step());
  // So it is after a state is restored.
  std::string saved, again;
  saveControl(a, saved);
  StateReader in(saved);
  loadTree(*a.kernel.root().find("/sys/server/gamecontrol"), in);
  saveControl(a, again);
  CHECK((again == saved));
  for (int i = 0; i < 3; ++i) REQUIRE(a.step());
  REQUIRE(a.cycles() == before + 5);
  REQUIRE(c.receive().has_value());
  run(10);
  a.setTiming("senseLatency", 1);
  run(4);
  answer("(syn)");
  REQUIRE(a.step());
  std::size_t messages = 0;
  for (; messages < 5; ++messages) REQUIRE(c.receive().has_value());
  for (; messages > 1; --messages) {
    answer("(syn)");
    REQUIRE_FALSE(a.step());
  }
  answer("(he1 4)(syn)");
  actionLog().clear();
  REQUIRE(a.step());
  CHECK(actionLog() == std::vector<std::string>{"1 he1 4"});
  REQUIRE(c.receive().has_value());
  run(5);
}

TEST_CASE("With agentStep messages arrive in the first turn in which they are due") {
  Arena a;
  a.setTiming("agentStep", 0.06);  // three cycles
  a.setTiming("senseLatency", 4);
  a.setTiming("actLatency", 1);
  TimedBehavior& b = addBehavior(a);
  for (int i = 0; i < 60; ++i) a.cycle();
  REQUIRE(b.ages.size() > 10);
  CHECK(b.ages == std::vector<int>(b.ages.size(), 6));
  actionLog().clear();
  for (int i = 0; i < 3; ++i) a.cycle();
  // The turn is in cycle 61. The agent thought in 55, its action departed in 58.
  CHECK(actionLog() == std::vector<std::string>{"1 he1 55"});
}

TEST_CASE("An agent may have latencies of its own") {
  Arena a;
  a.setTiming("actLatency", 2);
  Leaf& own = a.kernel.create("AgentLatency", "/sys/server/gamecontrol/timing/second");
  setProperty(own, "agent", 2);
  setProperty(own, "senseLatency", 6);
  const TimedBehavior &one = addBehavior(a, "/usr/agent/one"), &two = addBehavior(a, "/usr/agent/two");
  for (int i = 0; i < 20; ++i) a.cycle();
  CHECK(one.ages.back() == 1);
  CHECK(two.ages.back() == 6);
  actionLog().clear();
  a.cycle();
  CHECK(actionLog() ==
        std::vector<std::string>{fmt::format("1 he1 {}", a.cycles() - 3), fmt::format("2 he1 {}", a.cycles() - 1)});
}

TEST_CASE("Latencies that change while messages are under way change the order of none") {
  Arena a;
  a.setTiming("senseLatency", 5);
  Client c = clientWithRobot(a);
  a.setTiming("senseLatency", 1);
  // What was sensed meanwhile comes together with the last of the older messages.
  std::vector<std::string> all;
  for (int i = 0; i < 12; ++i) {
    a.cycle();
    all.push_back(c.receive().value());
    for (std::string& more : c.drain()) all.push_back(std::move(more));
  }
  double before = 0;
  for (const std::string& message : all) {
    const double now = std::stod(message.substr(message.find("now ") + 4));
    CHECK(now == Approx(before == 0 ? now : before + 0.02));
    before = now;
  }
  CHECK(ageOfPercepts(a, c) == 1);
  a.setTiming("senseLatency", 3);
  a.cycle();  // the last one with the old latency
  c.receive();
  a.cycle();
  a.cycle();
  CHECK(c.drain().empty());
  CHECK(ageOfPercepts(a, c) == 3);
}

TEST_CASE("Messages under way are part of the state, and arrive after it was restored as they would have") {
  constexpr int kBefore = 20, kAfter = 12;
  const auto run = [](Arena& a, int sense, int act) -> TimedBehavior& {
    a.setTiming("senseLatency", sense);
    a.setTiming("actLatency", act);
    TimedBehavior& b = addBehavior(a);
    for (int i = 0; i < kBefore; ++i) a.cycle();
    actionLog().clear();
    b.ages.clear();
    return b;
  };
  const auto goOn = [](Arena& a) {
    for (int i = 0; i < kAfter; ++i) a.cycle();
    return actionLog();
  };
  std::string saved, again;
  std::vector<std::string> expected;
  {
    Arena a;
    run(a, 4, 3);
    saveControl(a, saved);
    expected = goOn(a);
    REQUIRE(expected.size() == kAfter);
  }
  Arena a;
  TimedBehavior& b = run(a, 9, 1);  // other messages are under way
  StateReader in(saved);
  loadTree(*a.kernel.root().find("/sys/server/gamecontrol"), in);
  saveControl(a, again);
  CHECK((again == saved));
  a.setTiming("senseLatency", 4);
  a.setTiming("actLatency", 3);
  CHECK(goOn(a) == expected);
  CHECK(b.ages == std::vector<int>(kAfter, 4));
}

TEST_CASE("A client that goes on after a restored state gets the percepts that were under way") {
  Arena a;
  a.setTiming("senseLatency", 3);
  a.setTiming("actLatency", 3);
  Client c = clientWithRobot(a);
  for (int i = 0; i < 10; ++i) CHECK(ageOfPercepts(a, c) == 3);
  c.send("(he1 5)");
  c.arrive();
  a.cycle();  // its action has departed
  c.receive();
  std::string saved;
  saveControl(a, saved);
  StateReader in(saved);
  loadTree(*a.kernel.root().find("/sys/server/gamecontrol"), in);
  actionLog().clear();
  for (int i = 0; i < 2; ++i) CHECK(ageOfPercepts(a, c) == 3);
  CHECK(actionLog().empty());
  CHECK(ageOfPercepts(a, c) == 3);
  CHECK(actionLog() == std::vector<std::string>{"1 he1 5"});
}
