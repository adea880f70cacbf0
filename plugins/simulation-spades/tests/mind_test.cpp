#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "../agent_mind.h"
#include "../think_time.h"
#include "test_support.h"

using namespace spark;
using namespace spark::spades;
using Result = AgentMind::Result;

namespace {

/// An agent that has said I, with constant think time.
struct Talk {
  Latencies latencies;
  AgentMind mind{latencies};
  std::vector<Act> acts;
  Time think;

  explicit Talk(Time steps = 3) : think(steps) { REQUIRE(mind.take("I") == Result::ready); }
  std::optional<std::string> at(Time now) { return mind.next(now, {think, 0}); }
  void done() {
    REQUIRE(mind.take("D") == Result::done);
    mind.end(think, acts);
  }
};

}  // namespace

TEST_CASE("Where time goes on elsewhere, nothing is on its way, and what an agent thinks meanwhile comes to nothing") {
  Talk agent;
  agent.mind.sense(0, "(first)");
  agent.mind.sense(20, "(second)");
  REQUIRE(agent.at(10) == "S0 10 (first)");
  agent.mind.forget();
  REQUIRE(agent.mind.horizon() == 0);  // the world waits until it has answered
  agent.mind.take("A(late)");
  agent.done();
  REQUIRE(agent.acts.empty());
  REQUIRE(agent.mind.horizon() == kNever);
  agent.mind.sense(0, "(third)");
  REQUIRE(agent.at(9) == std::nullopt);
  REQUIRE(agent.at(10) == "S0 10 (third)");
}

TEST_CASE("Where time goes back, an act is due by its own thought, not by those of the time before") {
  Talk agent;
  agent.mind.sense(1000, "(late)");
  REQUIRE(agent.at(1010) == "S1000 1010 (late)");
  agent.mind.take("A(late)");
  agent.done();
  REQUIRE(agent.acts.back().due == 1010 + 3 + 10);
  agent.mind.forget();
  agent.mind.sense(0, "(early)");
  REQUIRE(agent.at(10) == "S0 10 (early)");
  REQUIRE(agent.mind.horizon() == 10 + 3 + 10);
  agent.mind.take("A(early)");
  agent.done();
  REQUIRE(agent.acts.back().data == "(early)");
  REQUIRE(agent.acts.back().due == 10 + 3 + 10);
}

TEST_CASE("a sensation arrives after its latency and opens a cycle; acts take effect after think time and latency") {
  Talk t;
  t.mind.sense(1, "");
  REQUIRE_FALSE(t.at(10));
  REQUIRE(t.at(11) == "S1 11 ");
  REQUIRE(t.mind.thinking());
  REQUIRE(t.mind.horizon() == 11 + 3 + 10);
  REQUIRE_FALSE(t.at(12));
  t.mind.take("A(create)");
  t.mind.take("A");
  t.mind.take("A(drive 1 0 0)");
  t.done();
  REQUIRE(t.acts.size() == 2);
  REQUIRE(t.acts[0].due == 24);
  REQUIRE(t.acts[0].data == "(create)");
  REQUIRE(t.acts[1].due == 24);
  REQUIRE(t.mind.horizon() == kNever);
}

TEST_CASE("time notifications come at their time, or at the end of the cycle that requested them") {
  Talk t;
  t.mind.sense(10, "x");
  REQUIRE(t.at(20) == "S10 20 x");
  t.mind.take("R22");
  t.mind.take("R40");
  t.mind.take("Rubbish");
  t.done();
  REQUIRE_FALSE(t.at(22));
  REQUIRE(t.at(23) == "T22");
  t.done();
  REQUIRE_FALSE(t.at(39));
  REQUIRE(t.at(40) == "T40");
}

TEST_CASE(
    "what comes while the agent thinks waits for the end of the cycle, in the order of time; too old it is dropped") {
  Talk t(15);
  t.mind.sense(10, "a");
  t.mind.sense(20, "b");
  REQUIRE(t.at(20) == "S10 20 a");
  REQUIRE_FALSE(t.at(30));
  t.mind.take("R32");
  t.done();  // ends at 35
  REQUIRE_FALSE(t.at(34));
  REQUIRE(t.at(35) == "S20 35 b");
  t.done();
  REQUIRE(t.at(50) == "T32");
  t.mind.sense(50, "late");
  t.mind.sense(130, "in time");
  REQUIRE(t.mind.take("D") == Result::done);
  t.mind.end(100, t.acts);  // 90 steps after the first of them arrived
  REQUIRE(t.at(150) == "S130 150 in time");
  REQUIRE(t.mind.dropped() == 1);
}

TEST_CASE("the order of messages does not depend on when the agent answers") {
  const auto run = [](Time answersAt) {
    Talk t;
    std::vector<std::string> told;
    t.mind.sense(10, "a");
    told.push_back(*t.at(20));
    t.mind.take("R25");
    if (answersAt < 25) t.done();
    for (Time now = 21; now < 33; ++now) {  // the world may run until 33
      if (now == 22) t.mind.sense(22, "b");
      if (now == answersAt && t.mind.thinking()) t.done();
      if (auto m = t.at(now)) {
        told.push_back(*m);
        t.done();
      }
    }
    for (Time now = 33; now < 50; ++now)
      if (auto m = t.at(now)) {
        told.push_back(*m);
        t.done();
      }
    return told;
  };
  REQUIRE(run(20) == std::vector<std::string>{"S10 20 a", "T25", "S22 32 b"});
  REQUIRE(run(32) == run(20));
}

TEST_CASE(
    "after K the agent gets nothing until it answers D, and the world runs on to the first step that it could change") {
  Talk t;
  t.mind.sense(1, "a");
  REQUIRE(t.at(11) == "S1 11 a");
  t.done();
  REQUIRE(t.mind.inform() == "K3");
  REQUIRE(t.mind.informed());
  REQUIRE_FALSE(t.mind.thinking());
  REQUIRE(t.mind.horizon() == kNever);
  t.mind.sense(21, "b");
  REQUIRE(t.mind.horizon() == 31 + 3 + 10);
  t.mind.take("A(late)");
  t.mind.take("R25");
  REQUIRE(t.mind.take("C") == Result::nothing);
  REQUIRE_FALSE(t.at(31));
  REQUIRE(t.mind.take("D") == Result::nothing);
  REQUIRE_FALSE(t.mind.informed());
  REQUIRE(t.at(40) == "S21 31 b");  // as if it had answered before
  REQUIRE(t.mind.horizon() == 31 + 3 + 10);
  t.done();
  REQUIRE(t.acts.empty());
  REQUIRE_FALSE(t.at(100));
}

TEST_CASE("the order of messages does not depend on when the agent answers K") {
  const auto run = [](Time answersAfter) {
    Talk t(15);
    std::vector<std::string> told;
    Time informedAt = kNever;
    for (Time now = 0; now < 200; ++now) {
      if (now % 20 == 1) t.mind.sense(now, "");
      if (t.mind.informed() && (now - informedAt >= answersAfter || now >= t.mind.horizon())) t.mind.take("D");
      if (const auto m = t.at(now)) {
        told.push_back(*m);
        if (told.size() % 3 == 0) t.mind.take(fmt::format("R{}", t.mind.began() + 4));
        t.done();
        told.push_back(t.mind.inform());
        informedAt = now;
      }
      REQUIRE(t.mind.horizon() > now);
    }
    REQUIRE(told.size() >= 16);
    told.resize(16);  // later ones may not be there yet
    return told;
  };
  const auto told = run(0);
  REQUIRE(told[1] == "K15");
  for (const Time after : {1, 7, 19, 100}) REQUIRE(run(after) == told);
}

TEST_CASE("latencies and think times that change while the agent thinks mean the same whenever it answers") {
  // What the agent is told and when its acts take effect, in a world that waits for it only where it must.
  const auto run = [](Time answersAfter, bool informs) {
    Talk t;
    std::vector<std::string> events;
    std::size_t inEffect = 0;
    Time since = 0;
    for (Time now = 0; now < 400; ++now) {
      if (now % 90 == 24) t.latencies.act = 1;
      if (now % 90 == 50) t.latencies.act = 40;
      if (now % 70 == 30) t.think = 12;
      if (now % 70 == 60) t.think = 2;
      if (now % 50 == 10) t.latencies.sense = 25;
      if (now % 50 == 20) t.latencies.sense = 2;
      const auto mustAnswer = [&] { return now - since >= answersAfter || t.mind.horizon() <= now; };
      do {
        if (t.mind.thinking() && mustAnswer()) {
          if (t.mind.began() % 3 == 0) t.mind.take(fmt::format("A{}", t.mind.began()));
          REQUIRE(t.mind.take("D") == Result::done);
          t.mind.end(t.mind.model().thought(0), t.acts);
          if (informs) t.mind.inform();
        }
        if (t.mind.informed() && mustAnswer()) t.mind.take("D");
        if (const auto m = t.at(now)) events.push_back(*m), since = now;
      } while (t.mind.horizon() <= now);
      for (; inEffect < t.acts.size() && t.acts[inEffect].due <= now; ++inEffect)
        events.push_back(fmt::format("{} in effect at {}", t.acts[inEffect].data, now));
      if (now % 7 == 0) t.mind.sense(now, "");
    }
    std::sort(events.begin(), events.end());
    std::erase_if(events, [](const std::string& e) { return e.starts_with("S3"); });  // later ones may not be there yet
    return events;
  };
  for (const bool informs : {false, true}) {
    const auto events = run(0, informs);
    REQUIRE(events.size() > 30);
    for (const Time after : {1, 5, 9, 100}) REQUIRE(run(after, informs) == events);
  }
}

TEST_CASE("no sensation and no act overtakes an earlier one where latencies become shorter") {
  Talk t;
  t.mind.sense(1, "a");
  t.latencies.sense = 2;
  t.mind.sense(2, "b");
  REQUIRE_FALSE(t.at(4));
  REQUIRE(t.at(11) == "S1 11 a");
  t.mind.take("A1");
  t.done();
  t.latencies.act = 1;
  REQUIRE(t.at(14) == "S2 14 b");
  t.mind.take("A2");
  t.done();
  REQUIRE(t.acts.at(0).due == 24);
  REQUIRE(t.acts.at(1).due == 24);
}

TEST_CASE("time goes on whatever an agent requests") {
  Talk t(0);  // its thoughts take no time
  t.mind.sense(1, "");
  REQUIRE(t.at(11));
  t.mind.take("R0");
  t.mind.take("R9223372036854775807");  // never
  t.done();
  REQUIRE_FALSE(t.at(11));
  REQUIRE(t.at(12) == "T0");
  t.done();
  t.mind.inform();
  REQUIRE(t.mind.horizon() == kNever);
  t.mind.take("D");
  // What it requests and does not get yet is limited.
  for (Time now = 20; now < 60; ++now) {
    t.mind.sense(now - 10, "");
    REQUIRE(t.at(now));
    for (int i = 0; i < 64; ++i) t.mind.take("R1000");
    t.done();
  }
  Time told = 0;
  for (Time now = 1000; t.at(now); ++told) t.done();
  REQUIRE(told == 1024);
}

TEST_CASE("an agent that floods its thought with acts is found out") {
  Talk t;
  t.mind.sense(1, "");
  REQUIRE(t.at(11));
  const std::string act = "A" + std::string(1000, 'x');
  int taken = 0;
  while (t.mind.take(act) == Result::nothing) ++taken;
  REQUIRE(taken > 900);
  REQUIRE(taken < 1100);
}

TEST_CASE("the limits of one thought, on acts and requests, begin anew with the next one") {
  Talk t;
  const std::string act = "A" + std::string(1000, 'x');
  Time now = 10;
  for (int thought = 0; thought < 5; ++thought, now += 1000) {
    CAPTURE(thought);
    t.mind.sense(now - 10, "");
    REQUIRE(t.at(now));
    for (int i = 0; i < 900; ++i) REQUIRE(t.mind.take(act) == Result::nothing);  // nearly as many as are allowed
    for (int i = 0; i < 100; ++i) t.mind.take("R" + std::to_string(now + 50));
    t.acts.clear();
    t.done();
    REQUIRE(t.acts.size() == 900);
    int notified = 0;
    for (Time at = now + 50; t.at(at); at += 3, ++notified) t.done();
    REQUIRE(notified == 64);
  }
}

TEST_CASE("the last thoughts of an agent and their mean") {
  RecentThoughts thoughts;
  REQUIRE(std::isnan(thoughts.last()));
  REQUIRE(std::isnan(thoughts.mean()));
  thoughts.add(3);
  thoughts.add(4);
  REQUIRE(thoughts.last() == 4);
  REQUIRE(thoughts.mean() == 3.5);
  for (int i = 0; i < 31; ++i) thoughts.add(2);
  REQUIRE(thoughts.mean() == (4 + 31 * 2) / 32.0);
  Talk t;
  t.mind.sense(1, "");
  REQUIRE(t.at(11));
  REQUIRE(std::isnan(t.mind.thoughts().last()));
  REQUIRE(t.mind.take("D") == Result::done);
  t.mind.end(1, t.acts);  // less than the least is the least
  REQUIRE(t.mind.thoughts().last() == 3);
}

TEST_CASE("messages at the wrong time are ignored") {
  Talk t;
  REQUIRE(t.mind.take("D") == Result::nothing);
  REQUIRE(t.mind.take("C") == Result::nothing);
  REQUIRE(t.mind.take("I") == Result::nothing);
  REQUIRE(t.mind.take("") == Result::nothing);
  REQUIRE(t.mind.take("Zwhat") == Result::nothing);
  t.mind.take("A(early)");
  t.mind.take("R5");
  t.mind.sense(1, "");
  REQUIRE(t.at(11));
  t.done();
  REQUIRE(t.acts.empty());
  REQUIRE_FALSE(t.at(100));
  REQUIRE(t.mind.take("X") == Result::exit);
}

TEST_CASE("timers of the database: fixed and measured") {
  REQUIRE(readTimer("fixed 3")->thought(99) == 3);
  REQUIRE(readTimer("fixed 0")->least() == 0);
  const ThinkModel jiffies = *readTimer("jiffies 2000");
  REQUIRE(jiffies.least() == 1);
  REQUIRE(jiffies.thought(0) == 1);
  REQUIRE(jiffies.thought(0.0021) == 2);
  REQUIRE(readTimer("perfctr_instr 2000")->thought(0.0021) == 2);
  REQUIRE_FALSE(readTimer("perfctr_instr 2000")->instructions);
  const ThinkModel instructions = *readTimer("instructions 1000000");
  REQUIRE(instructions.least() == 1);
  REQUIRE(instructions.thought(99, 0) == 1);
  REQUIRE(instructions.thought(99, 1e6) == 1);
  REQUIRE(instructions.thought(0, 1.1e6) == 2);
  REQUIRE(instructions.thought(0, 1e300) == 1000000000);
  REQUIRE_FALSE(readTimer("default"));
  REQUIRE_FALSE(readTimer(""));
  for (const char* bad : {"fixed", "fixed -1", "jiffies 0", "instructions 0", "instructions", "sundial 3", "fixed 3x"})
    REQUIRE_THROWS_WITH(readTimer(bad), Catch::Contains(bad));
}
