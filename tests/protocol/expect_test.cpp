#include <catch2/catch.hpp>

#include "arena.h"

using namespace spark;
using namespace spark::test;

namespace {

std::string init(const std::string& team, int unum) { return fmt::format("(init (unum {})(teamname {}))", unum, team); }

/// How a client starts its session. stepByStep: scene, a message, init, a message, (syn). plain: a robot without an
/// init effector.
enum class Style { atOnce, inTurn, stepByStep, plain };

/// A client that, once it has joined, answers every message with `(he1 <size of the message>)(syn)`.
struct Player {
  Player(Arena& a, std::string t, int u, Style s) : client(a.client()), team(std::move(t)), unum(u), style(s) {
    if (style == Style::atOnce) {
      client.send("(scene robot)");
      client.send(init(team, unum) + "(syn)");
      said = 2;
    } else if (style == Style::plain) {
      client.send(fmt::format("(scene robot {}{})(syn)", team, unum));
    } else {
      client.send(style == Style::inTurn ? "(scene robot)(syn)" : "(scene robot)");
    }
  }
  void play() {
    for (const auto& message : client.drain()) {
      heard.push_back(message);
      if (said == 0 && style != Style::plain)
        client.send(init(team, unum) + (style == Style::inTurn ? "(syn)" : ""));
      else if (said < 2)
        client.send("(syn)");
      else
        client.send(fmt::format("(he1 {})(syn)", message.size()));
      said += style == Style::inTurn ? 2 : 1;
    }
  }
  Client client;
  std::string team;
  int unum;
  Style style;
  int said = 0;  ///< number of joining steps sent, after its first message
  std::vector<std::string> heard;
};

/// Plays 40 cycles with players that connect in this order; returns all actions, then the first messages of every
/// player.
std::vector<std::string> match(const std::vector<int>& order, Style style, int threads = 1) {
  static const std::vector<std::pair<std::string, int>> kPlayers{
      {"Alpha", 1}, {"Alpha", 2}, {"Beta", 1}, {"Beta", 10}, {"Beta", 3}};
  Arena a(true);
  a.kernel.jobs().setThreads(threads);
  a.set("expect", static_cast<int>(order.size()));
  a.set("holdWait", 0.02);
  std::vector<std::unique_ptr<Player>> players;
  for (const int i : order) {
    const auto& [team, unum] = kPlayers[static_cast<std::size_t>(i)];
    players.push_back(std::make_unique<Player>(a, team, unum, style));
    for (int k = 0; k < i; ++k) a.net->poll();
  }
  a.until([&] {
    for (auto& p : players) p->play();
    return a.cycles() >= 40;
  });
  auto all = actionLog();
  std::sort(players.begin(), players.end(),
            [](const auto& x, const auto& y) { return std::tie(x->team, x->unum) < std::tie(y->team, y->unum); });
  for (const auto& p : players) all.insert(all.end(), p->heard.begin(), p->heard.begin() + 30);
  return all;
}

}  // namespace

TEST_CASE("The simulation waits for the expected agents with and without lockstep") {
  Arena a(true);
  a.set("expect", 2);
  Client one = a.client();
  one.send("(scene robot)" + init("A", 1) + "(syn)");
  Client two = a.client();
  two.send("(scene robot)" + init("A", 2));
  for (int i = 0; i < 300; ++i) {
    a.net->poll();
    REQUIRE_FALSE(a.gate->ready(false));
    REQUIRE_FALSE(a.gate->ready(true));
  }
  REQUIRE(a.agents() == 0);
  two.send("(syn)");
  a.until([&] { return a.gate->ready(true); }, false);
  a.cycle();
  REQUIRE(a.agents() == 2);
  REQUIRE(a.logged("2 of 2 expected agents are ready."));
}

TEST_CASE("The simulation waits for an expected agent until the (syn) after its init has arrived") {
  Arena a(true);
  a.set("expect", 1);
  Client c = a.client();
  c.send("(scene robot)(syn)");
  c.send(init("A", 1));
  c.arrive();
  for (int i = 0; i < 100; ++i) {
    a.net->poll();
    REQUIRE_FALSE(a.gate->ready(true));
  }
  SECTION("in a separate message") { c.send("(syn)"); }
  SECTION("before another init in one message") { c.send("(syn)" + init("A", 1)); }
  a.until([&] { return a.gate->ready(true); }, false);
}

TEST_CASE("Expected agents are numbered by team and number in any connection order and play the same match") {
  const Style style = GENERATE(Style::atOnce, Style::inTurn);
  const auto first = match({0, 1, 2, 3, 4}, style);
  REQUIRE(std::vector<std::string>(first.begin(), first.begin() + 5) ==
          std::vector<std::string>{"1 init Alpha 1", "1 he1 " + first[1].substr(6), "2 init Alpha 2",
                                   "2 he1 " + first[3].substr(6), "3 init Beta 1"});
  REQUIRE(std::count_if(first.begin(), first.end(), [](const auto& s) { return s.find("init") != s.npos; }) == 5);
  REQUIRE(std::find(first.begin(), first.end(), "4 init Beta 3") != first.end());
  REQUIRE(std::find(first.begin(), first.end(), "5 init Beta 10") != first.end());
  REQUIRE(match({4, 3, 2, 1, 0}, style) == first);
  REQUIRE(match({2, 4, 0, 3, 1}, style) == first);
}

TEST_CASE(
    "Agents that send step by step and robots without init start and play the same match in any connection order") {
  const Style style = GENERATE(Style::stepByStep, Style::plain);
  const auto first = match({0, 1, 2, 3, 4}, style);
  const char* begin = style == Style::plain ? "argument \"Alpha1\"" : "1 init Alpha 1";
  REQUIRE(first.front() == begin);
  REQUIRE(match({4, 3, 2, 1, 0}, style) == first);
  REQUIRE(match({2, 4, 0, 3, 1}, style) == first);
}

TEST_CASE(
    "After joinWait without progress the match starts with the agents that are ready, and the others join later") {
  Arena a(true);
  a.set("expect", 3);
  a.set("joinWait", 0.05);
  Client first = a.client();
  first.send("(scene robot)" + init("A", 1) + "(syn)");
  Client mute = a.client();
  Client unfinished = a.client();
  SECTION("with one agent ready and one that has only named its robot") {
    unfinished.send("(scene robot)");
    a.until([&] { return a.gate->ready(true); }, false);
    a.cycle();
    REQUIRE(a.agents() == 3);
    REQUIRE(
        a.logged("Of 3 expected agents 1 are ready, and nothing more came for 0.05 s (joinWait): the match starts."));
    // One program creates its agents one after the other: the first plays while the second joins.
    Client second = a.client();
    second.send("(scene robot)" + init("A", 2) + "(syn)");
    a.until([&] {
      for (auto* c : {&first, &second})
        for (std::size_t n = c->drain().size(); n > 0; --n) c->send(c == &second ? init("A", 2) + "(syn)" : "(syn)");
      return std::find(actionLog().begin(), actionLog().end(), "4 init A 2") != actionLog().end();
    });
  }
  SECTION("not if joinWait is 0 or no agent has named its robot") {
    a.set("joinWait", GENERATE(0.0, 0.05));
    first.leave();
    if (a.get("joinWait").toNumber() == 0) unfinished.send("(scene robot)");
    for (int i = 0; i < 200; ++i) {
      a.net->wait(0.0005);
      REQUIRE_FALSE(a.gate->ready(true));
    }
  }
}

TEST_CASE("The host reports which agents it waits for and what each must send") {
  Arena a(true);
  a.set("expect", 6);
  a.set("holdReport", 0.01);
  a.set("joinWait", 3600.0);
  Client silent = a.client(), bare = a.client(), named = a.client(), plain = a.client(), ready = a.client();
  bare.send(init("A", 2));
  named.send("(scene robot)" + init("A", 3));
  plain.send("(scene robot)(syn)");
  ready.send("(scene robot)" + init("A", 1) + "(syn)");
  for (auto* c : {&bare, &named, &plain, &ready}) c->arrive();
  a.host.text.clear();
  a.until([&] { return a.gate->ready(true) || a.logged("is not connected"); }, false);
  INFO(a.host.text);
  CHECK(a.logged("Waiting for 5 of 6 agents: agent at " + silent.name() + " has said nothing; "));
  CHECK(a.logged("agent at " + bare.name() + " owes (scene ...) and (syn); "));
  CHECK(a.logged("agent at " + named.name() + " has named its robot and its team, owes (syn); "));
  CHECK(a.logged("agent at " + plain.name() +
                 " has named its robot, owes (init ...) and (syn); if it has no init, (syn) to two messages; "));
  CHECK(a.logged("1 is not connected; without any news the match starts in 3"));
  CHECK_FALSE(a.logged(ready.name()));
}

TEST_CASE("Without a join policy expected agents need no init, and their robots determine the order") {
  Arena a(true);
  auto& control = a.kernel.root().require<Node>("/sys/server/gamecontrol");
  control.remove(*control.find("names"));
  a.set("expect", 2);
  a.set("holdReport", 0.01);
  a.set("joinWait", 3600.0);
  Client second = a.client(), first = a.client();
  second.send("(scene robot Bravo)");
  first.send("(scene robot Alpha)" + init("A", 9) + "(syn)");
  second.arrive(), first.arrive();
  a.until([&] { return a.gate->ready(true) || a.logged("has named its robot"); }, false);
  CHECK(a.logged("agent at " + second.name() + " has named its robot, owes (syn); "));
  CHECK_FALSE(a.logged("init"));
  REQUIRE_FALSE(a.gate->ready(true));
  second.send("(syn)");
  a.until([&] { return a.gate->ready(true); }, false);
  a.cycle();
  REQUIRE(a.agents() == 2);
  a.until([&] {
    for (auto* c : {&first, &second})
      for (std::size_t n = c->drain().size(); n > 0; --n) c->send("(he1 1)(syn)");
    return std::count(actionLog().begin(), actionLog().end(), "2 he1 1") > 0;
  });
  REQUIRE(actionLog().size() > 3);
  CHECK(actionLog()[0] == "argument \"Alpha\"");
  CHECK(actionLog()[1] == "argument \"Bravo\"");
  CHECK(actionLog()[2] == "1 init A 9");  // the init sent during the hold
}

TEST_CASE("Without a join policy an expected agent whose robot a rule makes owes an answer alone") {
  for (const std::string answer : {"(syn)", "(he1 1)"}) {
    Arena a(true);
    auto& control = a.kernel.root().require<Node>("/sys/server/gamecontrol");
    control.remove(*control.find("names"));
    a.set("expect", 1);
    a.set("holdWait", 0.01);
    a.set("holdReport", 0.01);
    a.set("joinWait", 3600.0);
    Client c = a.client();
    if (answer == "(syn)") {
      c.send("(syn)");  // perhaps it names its robot in its next message
      c.arrive();
      a.until([&] { return a.gate->ready(true) || a.logged("if a rule makes its robot"); }, false);
    }
    REQUIRE_FALSE(a.gate->ready(true));
    std::vector<std::string> got;
    a.until([&] { return a.gate->ready(true) || !(got = c.drain()).empty(); }, false);
    REQUIRE(got == std::vector<std::string>{"(time (now 0.00))"});
    c.send(answer);
    a.until([&] { return a.gate->ready(true); }, false);
    a.cycle();
    CHECK(a.agents() == 1);
  }
}

TEST_CASE("The messages to agents do not depend on the number of threads") {
  REQUIRE(match({0, 1, 2, 3, 4}, Style::atOnce, 4) == match({0, 1, 2, 3, 4}, Style::atOnce, 1));
}

TEST_CASE("A client that waits for a first message gets a minimal one, and the others get none") {
  Arena a(true);
  a.set("expect", 2);
  a.set("holdWait", 0.01);
  Client waits = a.client();
  waits.send("(scene robot)");
  Client complete = a.client();
  complete.send("(scene robot)" + init("A", 1) + "(syn)");
  std::vector<std::string> got;
  a.until(
      [&] {
        REQUIRE_FALSE(a.gate->ready(true));
        return !(got = waits.drain()).empty();
      },
      false);
  REQUIRE(got == std::vector<std::string>{"(time (now 0.00))"});
  for (int i = 0; i < 100; ++i) {
    a.net->wait(0.0005);
    REQUIRE_FALSE(a.gate->ready(true));
  }
  REQUIRE(waits.drain().empty());
  REQUIRE(complete.drain().empty());
}

TEST_CASE("An agent that leaves during the hold is not counted, and an additional agent joins afterwards") {
  Arena a(true);
  a.set("expect", 2);
  const auto ready = [&](const std::string& team, int unum) {
    Client c = a.client();
    c.send("(scene robot)" + init(team, unum) + "(syn)");
    return c;
  };
  {
    Client gone = ready("A", 1);
    a.until([&] { return a.gate->ready(true) || a.logged("1 of 2"); }, false);
  }
  a.until([&] { return a.gate->ready(true) || a.logged("1 of 2 expected agents are ready.\n0 of 2"); }, false);
  REQUIRE_FALSE(a.gate->ready(true));
  Client idle = a.client();
  const auto seen = a.host.text.size() - 1;
  Client late = ready("B", 5);
  REQUIRE_FALSE(a.gate->ready(true));
  a.until(
      [&] {
        a.gate->ready(true);
        return a.host.text.rfind("1 of 2 expected agents are ready.\n") > seen;
      },
      false);
  Client last = ready("A", 9);
  a.until([&] { return a.gate->ready(true); }, false);
  a.cycle();
  REQUIRE(a.agents() == 3);
  a.until([&] {
    for (auto* c : {&late, &last})
      for (std::size_t n = c->drain().size(); n > 0; --n) c->send("(syn)");
    return actionLog().size() >= 2;
  });
  REQUIRE(actionLog() == std::vector<std::string>{"1 init A 9", "2 init B 5"});
}
