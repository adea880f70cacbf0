#include <catch2/catch.hpp>

#include "arena.h"

using namespace spark;
using namespace spark::test;

namespace {
/// Connects a robot and waits for its first percepts.
Client joined(Arena& a, std::string_view scene = "(scene robot)(syn)") {
  Client c = a.client();
  const auto before = a.agents();
  a.until([&] { return a.agents() > before; });
  c.send(scene);
  std::vector<std::string> got;
  a.until([&] { return !(got = c.drain()).empty(); });
  return c;
}
/// Runs cycles until the simulation is blocked (200 tries without a cycle); returns their number.
int cyclesUntilBlocked(Arena& a) {
  int cycles = 0;
  for (int blocked = 0; blocked < 200;) {
    if (a.step())
      ++cycles, blocked = 0;
    else
      ++blocked;
  }
  return cycles;
}
}  // namespace

TEST_CASE("The simulation waits for (syn), and each (syn) allows one cycle") {
  Arena a(true);
  Client c = joined(a);
  REQUIRE(cyclesUntilBlocked(a) == 0);
  for (int i = 0; i < 5; ++i) {
    c.send("(he1 1)(syn)");
    c.arrive();
    REQUIRE(cyclesUntilBlocked(a) == 1);
    REQUIRE(c.drain().size() == 1);
  }
}

TEST_CASE("Three syns in one message or in three messages that have arrived allow one cycle") {
  Arena a(true);
  Client c = joined(a);
  cyclesUntilBlocked(a);
  SECTION("one message") { c.send("(syn)(syn)(syn)"); }
  SECTION("three messages") {
    c.send("(syn)");
    c.send("(syn)");
    c.send("(syn)");
  }
  c.arrive();
  REQUIRE(cyclesUntilBlocked(a) == 1);
}

TEST_CASE("The position of (syn) does not matter, and all actions received are applied") {
  Arena a(true);
  Client c = joined(a);
  cyclesUntilBlocked(a);
  c.send("(syn)(he1 1)");
  c.send("(he2 2)");
  c.arrive();
  REQUIRE(cyclesUntilBlocked(a) == 1);
  REQUIRE(actionLog() == std::vector<std::string>{"1 he1 1", "1 he2 2"});
}

TEST_CASE("The simulation waits for all agents that have sent (syn)") {
  Arena a(true);
  Client one = joined(a);
  one.send("(syn)");
  Client two = a.client();
  a.until([&] { return a.agents() == 2; });
  two.send("(scene robot)(syn)");
  std::vector<std::string> got;
  a.until([&] {
    for (std::size_t n = one.drain().size(); n > 0; --n) one.send("(syn)");
    return !(got = two.drain()).empty();
  });
  one.drain();
  one.send("(syn)");
  one.arrive();
  REQUIRE(cyclesUntilBlocked(a) == 0);
  two.send("(syn)");
  two.arrive();
  REQUIRE(cyclesUntilBlocked(a) == 1);
}

TEST_CASE("A silent agent is closed after syncTimeout, and the others continue") {
  Arena a(true);
  a.set("syncTimeout", 0.02);
  Client silent = joined(a);
  a.until([&] { return a.agents() == 0; });
  REQUIRE(silent.closed());
  REQUIRE(a.logged("did not answer for 0.02 s, all others wait"));
  REQUIRE(a.step());
}

TEST_CASE("A disconnect lets the simulation continue") {
  Arena a(true);
  Client c = joined(a);
  REQUIRE(cyclesUntilBlocked(a) == 0);
  c.leave();
  a.until([&] { return a.agents() == 0; });
}

TEST_CASE("Without lockstep the simulation does not wait for agents unless game control's sync is set") {
  Arena a(true);
  Client c = joined(a);
  REQUIRE(a.gate->ready(false));
  a.set("sync", true);
  REQUIRE_FALSE(a.gate->ready(false));
}

TEST_CASE("With agentStep agents act and sense only in some cycles, and the simulation waits only in those") {
  Arena a(true);
  a.setTiming("agentStep", 0.06);
  Client c = joined(a);
  c.send("(syn)");
  c.arrive();
  cyclesUntilBlocked(a);
  // Each answer allows three cycles and brings one message.
  for (int i = 0; i < 4; ++i) {
    c.drain();
    c.send("(syn)");
    c.arrive();
    REQUIRE(cyclesUntilBlocked(a) == 3);
    REQUIRE(c.receive().has_value());
    REQUIRE(c.drain().empty());
  }
  a.setTiming("agentStep", 0.024);  // a step that is due in less than 5 ms is due now
  c.send("(syn)");
  c.arrive();
  cyclesUntilBlocked(a);
  c.send("(syn)");
  c.arrive();
  REQUIRE(cyclesUntilBlocked(a) == 1);
}
