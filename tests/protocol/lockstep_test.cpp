#include <catch2/catch.hpp>

#include "arena.h"

using namespace spark;
using namespace spark::test;

namespace {
/// Connects a robot and answers until the clock waits for it.
Client robot(Arena& a, std::string_view scene = "(scene robot)") {
  Client c = a.client();
  const auto before = a.agents();
  a.until([&] { return a.agents() > before; });
  c.send(scene);
  std::vector<std::string> got;
  a.until([&] { return !(got = c.drain()).empty(); });
  return c;
}
/// Lockstep cycles until `n` tries in a row found the clock waiting.
int cyclesUntilBlocked(Arena& a) {
  int cycles = 0;
  for (int blocked = 0; blocked < 200;) {
    if (a.step()) ++cycles, blocked = 0;
    else ++blocked;
  }
  return cycles;
}
}  // namespace

TEST_CASE("The clock waits for (syn), and each gives one cycle") {
  Arena a(true);
  a.set("grace", 0);
  Client c = robot(a);
  REQUIRE(cyclesUntilBlocked(a) == 0);
  for (int i = 0; i < 5; ++i) {
    c.send("(he1 1)(syn)");
    c.arrive();
    REQUIRE(cyclesUntilBlocked(a) == 1);
    REQUIRE(c.drain().size() == 1);
  }
}

TEST_CASE("Three syns in one message, or in three messages already there, give one cycle") {
  Arena a(true);
  a.set("grace", 0);
  Client c = robot(a);
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

TEST_CASE("The position of (syn) does not matter, everything that was received is realised") {
  Arena a(true);
  a.set("grace", 0);
  Client c = robot(a);
  cyclesUntilBlocked(a);
  c.send("(syn)(he1 1)");
  c.send("(he2 2)");
  c.arrive();
  REQUIRE(cyclesUntilBlocked(a) == 1);
  REQUIRE(deeds() == std::vector<std::string>{"1 he1 1", "1 he2 2"});
}

TEST_CASE("All agents are waited for") {
  Arena a(true);
  a.set("grace", 0);
  Client one = robot(a);
  one.send("(syn)");
  Client two = a.client();
  a.until([&] { return a.agents() == 2; });
  two.send("(scene robot)");
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

TEST_CASE("In its first cycles a robot gets one message more without (syn)") {
  Arena a(true);
  a.set("graceWait", 0.05);
  Client c = a.client();
  a.until([&] { return a.agents() == 1; });
  c.send("(scene robot)(syn)");
  std::size_t messages = 0;
  a.until([&] { return (messages += c.drain().size()) > 0; });
  a.until([&] { return (messages += c.drain().size()) > 1; });
  REQUIRE(cyclesUntilBlocked(a) == 0);
  REQUIRE(c.drain().empty());
}

TEST_CASE("Agents that cannot answer are not waited for") {
  Arena a(true);
  a.set("graceWait", 0);
  Client empty = a.client();
  SECTION("an idle connection") { a.until([&] { return a.agents() == 1; }); }
  SECTION("a robot without a sync effector") {
    a.until([&] { return a.agents() == 1; });
    empty.send("(scene mute)");
    std::vector<std::string> got;
    a.until([&] { return !(got = empty.drain()).empty(); });
  }
  for (int i = 0; i < 20; ++i) REQUIRE(a.step());
}

TEST_CASE("A new client is given a moment to name its robot, no longer") {
  Arena a(true);
  Client c = a.client();
  a.until([&] { return a.agents() == 1; });
  const auto joined = a.cycles();
  c.send("(scene robot)");
  a.until([&] { return !deeds().empty() || a.kernel.root().find("/usr/scene/AgentAspect1/clock") != nullptr; });
  REQUIRE(a.cycles() == joined + 1);
  c.leave();
  a.until([&] { return a.agents() == 0; });
  Client silent = a.client();
  a.set("graceWait", 0.01);
  a.until([&] { return a.agents() == 1; });
  const auto from = a.cycles();
  a.until([&] { return a.cycles() > from + 12; });
}

TEST_CASE("An agent that falls silent is closed after syncTimeout, the others go on") {
  Arena a(true);
  a.set("grace", 0);
  a.set("syncTimeout", 0.02);
  Client silent = robot(a);
  a.until([&] { return a.agents() == 0; });
  REQUIRE(silent.closed());
  REQUIRE(a.logged("did not answer for 0.02 s, all others wait"));
  REQUIRE(a.step());
}

TEST_CASE("A disconnect frees the clock") {
  Arena a(true);
  a.set("grace", 0);
  Client c = robot(a);
  REQUIRE(cyclesUntilBlocked(a) == 0);
  c.leave();
  a.until([&] { return a.agents() == 0; });
}

TEST_CASE("Out of lockstep nobody is waited for, unless game control is told to") {
  Arena a(true);
  a.set("grace", 0);
  Client c = robot(a);
  REQUIRE(a.gate->ready(false));
  a.set("sync", true);
  REQUIRE_FALSE(a.gate->ready(false));
}
