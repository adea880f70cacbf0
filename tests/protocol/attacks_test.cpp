#include <catch2/catch.hpp>

#include "absence.h"
#include "robot_client.h"

using namespace spark;
using namespace spark::test;

TEST_CASE("Invalid actions do not affect the valid ones") {
  Arena a;
  Client c = robot(a);
  c.send("(nonsense 1)(he1)(he1 nan)((he1 2))()(he1 abc)atom(he1 3)");
  applyActions(a, 3);
  REQUIRE(actionLog() == ActionLog{"1 he1 nan", "1 he1 0", "1 he1 3"});
  REQUIRE(a.logged("no effector registered for predicate nonsense"));
  const std::string agent = "agent 1 (" + c.name() + "): ";
  REQUIRE(a.logged(agent + "he1: expected a number, found none"));
  REQUIRE(a.logged(agent + "expected (predicate arguments...), found 'atom' outside of brackets."));
  REQUIRE(a.logged(agent + "expected (predicate arguments...), found a list that does not begin with a word."));
}

TEST_CASE("Each kind of mistake of an agent is logged once, and again for another agent") {
  Arena a;
  Client one = robot(a), two = robot(a);
  const auto lines = [&](const std::string& text) { return count(a.host.text, text); };
  for (int i = 0; i < 20; ++i) {
    for (Client* c : {&one, &two})
      c->send("(he1)(he3 " + std::to_string(i) + ")(he2)x" + std::to_string(i) + " (scene robot)");
    one.arrive();
    two.arrive();
    a.cycle();
    one.drain(), two.drain();
  }
  for (const std::string& agent : {"agent 1 (" + one.name() + "): ", "agent 2 (" + two.name() + "): "}) {
    CHECK(lines(agent) == 5);
    CHECK(lines(agent + "he1: expected a number, found none") == 1);
    CHECK(lines(agent + "he2: expected a number, found none") == 1);
    CHECK(lines(agent + "no effector registered for predicate he3. Did you mean 'he1' or 'he2'?") == 1);
    CHECK(lines(agent + "expected (predicate arguments...), found 'x0' outside of brackets.") == 1);
    CHECK(lines(agent + "scene: expected one robot, found a request for another") == 1);
  }
}

TEST_CASE("A mistake in a message costs its predicate, and the connection stays open") {
  Arena a;
  Client c = robot(a);
  c.send("(he1 1))(he1 2)");
  applyActions(a, 1);
  c.send("(he1 3)" + std::string(60000, '('));
  applyActions(a, 2);
  c.send("\x01\x02\xff garbage");
  c.send("(he1 4)");
  applyActions(a, 3);
  REQUIRE(actionLog() == ActionLog{"1 he1 1", "1 he1 2", "1 he1 3", "1 he1 4"});
  REQUIRE(a.logged("that predicate is ignored"));
}

TEST_CASE("200,000 nested parentheses over several messages close at most that connection") {
  Arena a;
  Client other = robot(a), c = robot(a);
  for (int i = 0; i < 4; ++i) c.send(std::string(50000, '('));
  c.raw(std::string("\x00\x03\x0d\x40", 4));  // and once in a single message that is too long
  REQUIRE(c.closed());
  other.send("(he1 1)");
  applyActions(a, 1);
  REQUIRE(a.agents() == 1);
}

TEST_CASE("The number of log lines about one agent is limited") {
  Arena a;
  Client c = robot(a);
  const auto flood = [&](int seed) {
    std::string message;
    for (int i = 0; i < 5000; ++i) message += fmt::format("(bad{} 1)", seed + i);
    c.send(message + "(he1 1)");
    actionLog().clear();
    applyActions(a, 1);
    return count(a.host.text, "predicate bad");
  };
  const auto pause = [&] {
    for (int i = 0; i < 100; ++i) a.cycle(), c.drain();
  };
  REQUIRE(flood(0) == 100);
  REQUIRE(flood(5000) == 100);
  pause();
  REQUIRE(flood(10000) == 200);
  REQUIRE(a.logged("these were mistakes of 200 kinds; no more of its mistakes are logged."));
  pause();
  REQUIRE(flood(15000) == 200);
}

TEST_CASE("A scene that cannot be loaded leaves the agent without a robot, and the log says why") {
  Arena a;
  Client c = a.client();
  a.until([&] { return a.agents() == 1; });
  const std::string file = GENERATE("missing", "broken", "/etc/passwd", "../x");
  c.send("(scene " + file + ")");
  a.until([&] { return a.logged("Agent 1 gets no robot"); });
  a.cycle();
  a.cycle();
  a.cycle();
  REQUIRE(c.drain().empty());
  REQUIRE(a.control->agents()[0]->children().size() == 1);
  c.send("(scene robot)");
  std::vector<std::string> got;
  a.until([&] { return !(got = c.drain()).empty(); });
}

TEST_CASE("An agent that names bad scenes in every cycle is finally refused and does not fill the log") {
  Arena a;
  Client c = a.client();
  a.until([&] { return a.agents() == 1; });
  for (int i = 0; i < 100; ++i) {
    c.send("(scene missing)");
    c.arrive();
    a.cycle();
  }
  REQUIRE(count(a.host.text, "gets no robot") == 10);
  REQUIRE(a.logged("no robot could be built too often"));
}

TEST_CASE("A second robot is refused") {
  Arena a;
  Client c = robot(a);
  const auto children = a.control->agents()[0]->children().size();
  c.send("(scene robot)(he1 1)");
  applyActions(a, 1);
  REQUIRE(a.logged("it has a robot already"));
  REQUIRE(a.control->agents()[0]->children().size() == children);
}

TEST_CASE("Long messages of a client do not fill the log") {
  Arena a;
  Client c = robot(a);
  a.host.text.clear();
  c.send("(" + std::string(60000, 'x') + " 1)(scene " + std::string(3000, 'y') + ")(he1 1)");
  applyActions(a, 1);
  REQUIRE(a.logged("no effector registered for predicate xxx"));
  REQUIRE(a.host.text.size() < 2000);
}

TEST_CASE("Agents above maxAgents are refused") {
  Arena a;
  a.set("maxAgents", 1);
  Client one = robot(a);
  Client two = a.client();
  REQUIRE(two.closed());
  REQUIRE(a.logged("there are 1 agents already (maxAgents)"));
}

TEST_CASE("A client that never reads uses bounded memory and does not disturb the others") {
  Arena a;
  Client other = robot(a);
  Client deaf = a.client();
  a.until([&] { return a.agents() == 2; });
  deaf.send("(scene loud)");
  std::size_t heard = 0;
  for (int i = 0; i < 1200; ++i) {
    a.cycle();
    heard += other.drain().size();
  }
  REQUIRE(heard >= 1100);
  REQUIRE(a.get("messagesDropped").toInteger() > 100);
}

TEST_CASE("A client that sends more than maxPending within a cycle is closed") {
  Arena a;
  Client other = robot(a), flood = robot(a);
  std::string message;
  for (int i = 0; i < 5000; ++i) message += "(he1 1)";
  for (int i = 0; i < 20; ++i) flood.send(message);
  REQUIRE(flood.closed());
  REQUIRE(a.logged("it sent more than 262144 bytes within one cycle"));
  a.cycle();
  REQUIRE(a.agents() == 1);
}
