#include <catch2/catch.hpp>
#include <cmath>

#include "api/inputs.h"
#include "arena.h"

// For how long lockstep waits for an agent, on a wall clock that stands still until the test moves it.

using namespace spark;
using namespace spark::test;

namespace {

/// A tape whose time is the test's.
class TestWallClock : public Node, public IInputTape {
  SPARK_CLASS(TestWallClock, Node)
 public:
  static void describe(Description<TestWallClock>& d) {
    d.doc("The wall clock of a test.");
    d.implements<IInputTape>();
  }
  bool playing() const override { return false; }
  bool put(const Input&) override { return true; }
  Clock::time_point time(Clock::time_point) override { return now; }
  bool decide(std::string_view, std::uint64_t, bool live, bool) override { return live; }
  void advance(double seconds) {
    now += std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  }

 private:
  Clock::time_point now{std::chrono::hours(1)};
};

class WaitingArena : public Arena {
 public:
  WaitingArena() : Arena(true) {}
  TestWallClock& clock = add();

  /// Runs cycles until the simulation is blocked; returns their number.
  int cyclesUntilBlocked() {
    int n = 0;
    for (int blocked = 0; blocked < 5;) {
      blocked = step() ? 0 : blocked + 1;
      n += blocked == 0;
    }
    return n;
  }
  /// Waits for that time in several looks. True if no cycle began.
  bool blockedFor(double seconds) {
    for (int i = 0; i < 10; ++i) {
      clock.advance(seconds / 10);
      if (step()) return false;
    }
    return !step();
  }
  /// Sends a message and waits until its answer is complete. Returns the number of cycles until it is blocked again.
  int answer(Client& c, std::string_view message) {
    c.drain();
    c.send(message);
    c.arrive();
    net->poll();
    clock.advance(kPace);
    return cyclesUntilBlocked();
  }
  /// A client that has named its robot, and got its first percepts.
  Client joined(std::string_view message = "(scene robot)") {
    Client c = client();
    const auto before = agents();
    until([&] { return agents() > before; });
    c.send(message);
    c.arrive();
    cyclesUntilBlocked();
    return c;
  }
  static constexpr double kPace = 0.011;  // a bit more than joinPace

 private:
  TestWallClock& add() {
    kernel.registerClass<TestWallClock>();
    return kernel.create<TestWallClock>("TestWallClock", IInputTape::kPath);
  }
};

}  // namespace

TEST_CASE("A client that answers every message is waited for before its first (syn)") {
  WaitingArena a;
  Client c = a.joined();
  REQUIRE(c.drain().size() == 1);
  REQUIRE(a.blockedFor(0.9));
  for (const char* said : {"(init (unum 1)(teamname A))", "(he1 1)", "(he1 2)", "(syn)", "(syn)"}) {
    REQUIRE(a.answer(c, said) == 1);
    REQUIRE(c.drain().size() == 1);
    REQUIRE(a.blockedFor(0.9));
  }
  REQUIRE(actionLog() == std::vector<std::string>{"1 init A 1", "1 he1 1", "1 he1 2"});
}

TEST_CASE("Two clients that answer every message, one of them without (syn), get theirs in the same cycles") {
  WaitingArena a;
  Client player = a.joined("(scene robot)(syn)");
  Client other = a.client();
  std::size_t toPlayer = player.drain().size();
  player.send("(syn)");
  a.until([&] {
    for (std::size_t n = player.drain().size(); n > 0; --n, ++toPlayer) player.send("(syn)");
    return a.agents() == 2;
  });
  other.send("(scene robot)");
  other.arrive();
  std::size_t toOther = 0;
  a.until([&] {
    for (std::size_t n = player.drain().size(); n > 0; --n, ++toPlayer) player.send("(syn)");
    return (toOther = other.drain().size()) > 0;
  });
  REQUIRE(toOther == 1);
  a.cyclesUntilBlocked();
  for (int i = 0; i < 20; ++i) {
    player.drain();
    player.send("(syn)");
    player.arrive();
    REQUIRE(a.cyclesUntilBlocked() == 0);
    REQUIRE(a.answer(other, "(he1 1)") == 1);
    REQUIRE(other.drain().size() == 1);
  }
}

TEST_CASE("A client that never answers is waited for once, for answerWait, and paced by joinPace from then on") {
  WaitingArena a;
  Client c = a.joined();
  REQUIRE(a.blockedFor(0.9));
  REQUIRE_FALSE(a.blockedFor(0.2));
  REQUIRE(a.logged("has not answered for 1"));
  for (int i = 0; i < 100; ++i) {
    REQUIRE(a.blockedFor(0.009));
    REQUIRE_FALSE(a.blockedFor(0.002));
  }
  SECTION("it gets the percepts of each cycle") { REQUIRE(c.drain().size() > 100); }
  SECTION("an answer without (syn) changes nothing") {
    c.send("(he1 1)");
    c.arrive();
    REQUIRE_FALSE(a.blockedFor(0.02));
    REQUIRE_FALSE(a.blockedFor(0.02));
  }
  SECTION("it is waited for after its first (syn)") {
    a.answer(c, "(syn)");
    REQUIRE(a.blockedFor(100));
  }
  REQUIRE(a.agents() == 1);
}

TEST_CASE("A client that stops answering before its first (syn) is waited for longer the more it has answered") {
  WaitingArena a;
  a.set("syncTimeout", 30);
  const int answers = GENERATE(1, 4, 60);
  Client c = a.joined();
  for (int i = 0; i < answers; ++i) REQUIRE(a.answer(c, "(he1 1)") == 1);
  const double patience = std::min(1 + answers, 30);
  REQUIRE(a.blockedFor(patience - 0.1));
  REQUIRE_FALSE(a.blockedFor(0.3));
  a.cycle();
  REQUIRE_FALSE(a.blockedFor(0.02));
  REQUIRE(a.agents() == 1);
}

TEST_CASE("Each agent that was waited for in vain halves the wait for others, as long as it is there") {
  WaitingArena a;
  std::vector<Client> silent;
  for (int i = 0; i < 3; ++i) {
    Client& c = silent.emplace_back(a.client());
    c.send("(scene robot)");
    a.until([&] { return a.clock.advance(WaitingArena::kPace), !c.drain().empty(); });
    REQUIRE(a.blockedFor(std::ldexp(0.8, -i)));
    REQUIRE_FALSE(a.blockedFor(std::ldexp(0.3, -i)));
  }
  silent.clear();
  a.until([&] { return a.clock.advance(WaitingArena::kPace), a.agents() == 0; });
  Client last = a.joined();
  REQUIRE(a.blockedFor(0.9));
}

TEST_CASE("A client that answers before its first (syn) and leaves lets the simulation continue") {
  WaitingArena a;
  Client c = a.joined();
  REQUIRE(a.answer(c, "(init (unum 1)(teamname A))") == 1);
  c.leave();
  a.until([&] { return a.agents() == 0; });
}

TEST_CASE("Several messages without a pause are one answer until the first cycle with (syn) is over") {
  WaitingArena a;
  Client c = a.joined();
  for (const char* said : {"(init (unum 1)(teamname A))", "(syn)", "(syn)", "(syn)"}) {
    c.send(said);
    c.arrive();
    REQUIRE(a.blockedFor(0.009));
  }
  a.clock.advance(0.002);
  REQUIRE(a.cyclesUntilBlocked() == 1);
  // From now on (syn) alone decides.
  c.send("(he1 1)");
  c.arrive();
  REQUIRE(a.blockedFor(1));
  c.send("(syn)");
  c.arrive();
  REQUIRE(a.cyclesUntilBlocked() == 1);
}

TEST_CASE("Time in which the host did not look for input does not count as a client's silence") {
  WaitingArena a;
  SECTION("in lockstep") {
    a.set("syncTimeout", 30);
    const bool pledged = GENERATE(true, false);
    Client c = a.joined(pledged ? "(scene robot)(syn)" : "(scene robot)");
    // The answer comes after the poll, and then the host does not run for an hour.
    c.send(pledged ? "(syn)" : "(he1 1)");
    a.clock.advance(3600);
    REQUIRE_FALSE(a.gate->ready(true));
    REQUIRE_FALSE(a.logged("answer"));
    c.arrive();
    a.net->poll();
    a.clock.advance(WaitingArena::kPace);
    a.gate->ready(true);
    REQUIRE(a.cyclesUntilBlocked() == 1);
  }
  SECTION("before the match") {
    a.set("expect", 1);
    Client c = a.client();
    c.send("(scene robot)");
    c.arrive();
    a.step();
    c.send("(init (unum 1)(teamname A))(syn)");
    a.clock.advance(3600);
    REQUIRE_FALSE(a.gate->ready(true));
    REQUIRE(c.drain().empty());  // no greeting
    c.arrive();
    REQUIRE(a.step());
  }
}

TEST_CASE("A slow agent that delays no other trusted agent is waited for, whatever joinBudget is") {
  WaitingArena a;
  a.set("joinBudget", 1);
  Client c = a.joined("(scene robot)(syn)");
  for (int i = 0; i < 120; ++i) REQUIRE(a.answer(c, "(syn)") == 1);
  a.set("syncTimeout", 1000);
  for (int i = 0; i < 5; ++i) {
    REQUIRE(a.blockedFor(100));
    REQUIRE(a.answer(c, "(syn)") == 1);
  }
}
