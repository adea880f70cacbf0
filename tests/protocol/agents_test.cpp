#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "absence.h"
#include "robot_client.h"

using namespace spark;
using namespace spark::test;

namespace {
/// Throws in the middle of its percept, unless its name is "whole".
class TestFault : public Perceptor {
  SPARK_CLASS(TestFault, Perceptor)
 public:
  static void describe(Description<TestFault>& d) { d.doc("Throws."); }
  void sense(Predicates& out, const Event&) override {
    out.open("half");
    if (name() == "whole") return void(out.close());
    if (name() == "odd") throw 42;
    throw Error("the sensor is broken");
  }
};

/// Leaves a list open, or closes one too many.
class TestSloppy : public Perceptor {
  SPARK_CLASS(TestSloppy, Perceptor)
 public:
  static void describe(Description<TestSloppy>& d) { d.doc("Counts its parentheses wrongly."); }
  void sense(Predicates& out, const Event&) override {
    if (name() == "open")
      out.open("OPEN").open("rt").add(1);
    else
      out.pair("SURPLUS", 1).close();
  }
};

/// Throws.
class TestBomb : public Effector {
  SPARK_CLASS(TestBomb, Effector)
 public:
  static void describe(Description<TestBomb>& d) { d.doc("Throws."); }
  std::string predicate() const override { return name(); }
  std::string act(const Element&) override {
    if (name() == "odd") throw 42;
    throw Error("the motor is broken");
  }
};

/// `(thief m1 m2)`: removes the siblings of those names.
class TestThief : public Effector {
  SPARK_CLASS(TestThief, Effector)
 public:
  static void describe(Description<TestThief>& d) { d.doc("Removes its siblings."); }
  std::string act(const Element& action) override {
    for (std::size_t i = 1; i < action.size(); ++i) parent()->remove(*parent()->child(action.at(i).text()));
    return {};
  }
};

/// Logs agents that connect and leave.
class TestRule : public ControlAspect {
  SPARK_CLASS(TestRule, ControlAspect)
 public:
  static void describe(Description<TestRule>& d) { d.doc("Logs agents that connect and leave."); }
  void rule(const Event&) override {}
  void agentConnected(AgentAspect& agent) override { actionLog().push_back("come " + agent.path()); }
  void agentLeaving(AgentAspect& agent) override { actionLog().push_back("go " + agent.path()); }
};
}  // namespace

TEST_CASE("The last percepts of an agent and its answer latency are available") {
  Arena a;
  Client c = a.client();
  a.until([&] { return a.agents() == 1; });
  const AgentAspect& agent = *a.control->agents()[0];
  REQUIRE(a.control->percepts(agent) == nullptr);
  c.send("(scene robot)");
  a.until([&] { return a.control->percepts(agent) != nullptr; });
  a.until([&] { return !c.drain().empty(); });
  std::vector<std::string> heads;
  for (int i = 0; i < 3; ++i, a.cycle())
    for (const Element e : *a.control->percepts(agent)) heads.emplace_back(e.head());
  REQUIRE(std::count(heads.begin(), heads.end(), "time") == 3);
  REQUIRE(std::count(heads.begin(), heads.end(), "vision") == 1);
  REQUIRE(std::isnan(a.control->latency(agent)));
  c.send("(he1 1)");
  c.arrive();
  applyActions(a, 1);
  const double first = a.control->latency(agent);
  REQUIRE(first > 0);
  c.send("(he1 1)");
  c.arrive();
  applyActions(a, 2);
  REQUIRE(a.control->latency(agent) > 0);
  REQUIRE(a.control->latency(agent) != first);  // the second answer counts, too
  a.kernel.root().require<Node>("/usr/scene").create("AgentAspect", "stranger");
  const auto& stranger = a.kernel.root().require<AgentAspect>("/usr/scene/stranger");
  REQUIRE(a.control->percepts(stranger) == nullptr);
  REQUIRE(std::isnan(a.control->latency(stranger)));
}

TEST_CASE(
    "A session starts as on the original server with silence, the robot, then percepts with the original latency") {
  Arena a;
  Client c = a.client();
  a.until([&] { return a.agents() == 1; });
  const auto joined = a.cycles();
  REQUIRE(c.drain().empty());
  c.send("(scene robot 4 abc)");
  a.until([&] { return !actionLog().empty(); });
  const auto loaded = a.cycles();
  REQUIRE(loaded > joined);
  REQUIRE(actionLog() == ActionLog{"argument \"4\"", "argument \"abc\""});
  // No message in the loading cycle. The next cycle senses, and the one after it sends.
  a.cycle();
  REQUIRE(c.drain().empty());
  a.cycle();
  const auto first = c.receive();
  REQUIRE(first);
  REQUIRE(first->starts_with(fmt::format("(time (now {:.2f}))", 0.02 * static_cast<double>(loaded + 1))));
  REQUIRE(a.control->agents()[0]->path() == "/usr/scene/AgentAspect1");
  REQUIRE(a.control->agentsSeen() == 1);
}

TEST_CASE("A perceptor with interval 3 senses in every third cycle since the agent connected") {
  Arena a;
  Client c = a.client();
  a.until([&] { return a.agents() == 1; });
  c.send("(scene robot)(syn)");
  // Connected in cycle 1, loaded in 2, sensed from 3 on. As in the recordings, the first message has the percept.
  a.until([&] { return a.agents() == 1 && !a.kernel.root().find("/usr/scene/AgentAspect1/vision"); }, false);
  a.until(
      [&] {
        a.cycle();
        return a.kernel.root().find("/usr/scene/AgentAspect1/vision") != nullptr;
      },
      false);
  const auto loaded = a.cycles();
  std::string seen;
  for (int i = 0; i < 7; ++i) a.cycle();
  for (int i = 0; i < 6; ++i) seen += c.receive()->find("vision") == std::string::npos ? '.' : 'V';
  const auto counter = loaded + 1;  // joined in cycle 1
  REQUIRE(seen == (counter % 3 == 0 ? "V..V.." : counter % 3 == 1 ? "..V..V" : ".V..V."));
}

TEST_CASE("An init in the message that names the robot is ignored with a warning") {
  Arena a;
  Client c = a.client();
  a.until([&] { return a.agents() == 1; });
  c.send("(scene robot)(init (unum 1)(teamname A))");
  std::vector<std::string> got;
  a.until([&] { return !(got = c.drain()).empty(); });
  REQUIRE(a.logged("no effector registered for predicate init"));
  REQUIRE(actionLog().empty());
  c.send("(init (unum 7)(teamname A))");
  applyActions(a, 1);
  REQUIRE(actionLog() == ActionLog{"1 init A 7"});
}

TEST_CASE("Messages are applied in the order of agent numbers, and predicates in the order they were sent") {
  Arena a;
  Client one = robot(a), two = robot(a);
  // The second agent sends first.
  two.send("(he2 5)(he1 6)");
  two.send("(he1 7)");
  one.send("(he1 1)(he2 2)(he1 3)");
  two.arrive();
  one.arrive();
  a.cycle();
  REQUIRE(actionLog() == ActionLog{"1 he1 1", "1 he2 2", "1 he1 3", "2 he2 5", "2 he1 6", "2 he1 7"});
}

TEST_CASE("Each action finds its effector in any order of actions") {
  Arena a;
  Client c = robot(a);
  ActionLog expected;
  const auto say = [&](std::initializer_list<const char*> motors) {
    std::string message;
    for (const char* m : motors) {
      message += fmt::format("({} {})", m, expected.size());
      expected.push_back(fmt::format("1 {} {}", m, expected.size()));
    }
    c.send(message);
    c.arrive();
    a.cycle();
    REQUIRE(actionLog() == expected);
  };
  say({"he1", "he2"});
  say({"he1", "he2"});
  say({"he2", "he1", "he1"});
  say({"he2"});
  say({"he1", "he2", "he1", "he2"});
}

TEST_CASE("The agent of a client that leaves is removed at the start of the next cycle, and the others stay") {
  Arena a;
  Client one = robot(a), two = robot(a);
  REQUIRE(a.kernel.root().find("/usr/scene/AgentAspect1"));
  one.leave();
  a.until(
      [&] {
        a.cycle();
        return a.agents() == 1;
      },
      false);
  REQUIRE(a.kernel.root().find("/usr/scene/AgentAspect1") == nullptr);
  REQUIRE(a.control->agents()[0]->number() == 2);
  Client three = robot(a);
  REQUIRE(a.control->agents()[1]->number() == 3);
}

TEST_CASE("An agent that requires what is refused hears why, acts no more and leaves") {
  for (const bool all : {true, false}) {
    Arena a;
    a.set("requests", true);
    a.set("requireAll", all);
    Client c = a.client();
    a.until([&] { return a.agents() == 1; });
    c.send("(scene robot)(request (perceptor Nothing)(name n))");
    std::string heard;
    a.until([&] {
      for (const std::string& message : c.drain()) heard += message;
      return heard.find("(refused (name n)") != std::string::npos;
    });
    c.send("(he1 1)");
    if (all) {
      CHECK(c.closed());
      a.until([&] { return a.agents() == 0; });
      CHECK(actionLog().empty());
      CHECK(a.logged("does not take part: it requires Nothing, which is refused: expected the class of a perceptor"));
    } else {
      a.until([&] { return !actionLog().empty(); });
      CHECK(a.agents() == 1);
    }
  }
}

TEST_CASE("With byArrival agents act in the order in which their messages arrived") {
  for (const bool byArrival : {true, false}) {
    Arena a;
    Client one = robot(a), two = robot(a);
    a.set("byArrival", byArrival);
    for (Client* sender : {&two, &one}) {
      sender->send("(he1 1)");
      sender->arrive();
      a.net->poll();
    }
    actionLog().clear();
    applyActions(a, 2);
    CHECK(actionLog() == (byArrival ? ActionLog{"2 he1 1", "1 he1 1"} : ActionLog{"1 he1 1", "2 he1 1"}));
  }
}

TEST_CASE("Removing an agent closes its connection only on request") {
  Arena a;
  Client c = robot(a);
  const bool close = GENERATE(true, false);
  c.send("(he1 1)");
  applyActions(a, 1);
  a.control->removeAgent(*a.control->agents()[0], close);
  a.cycle();
  REQUIRE(a.agents() == 0);
  if (close)
    REQUIRE(c.closed());
  else {
    c.send("(he1 2)");
    c.arrive();
    a.cycle();
    a.cycle();
    REQUIRE(actionLog() == ActionLog{"1 he1 1"});
  }
}

TEST_CASE("Control aspects are notified of agents that connect and leave") {
  Arena a;
  a.kernel.registerClass<TestRule>();
  a.kernel.create("TestRule", "/sys/server/gamecontrol/rule");
  { Client c = robot(a); }
  applyActions(a, 2);
  REQUIRE(actionLog() == ActionLog{"come /usr/scene/AgentAspect1", "go /usr/scene/AgentAspect1"});
}

TEST_CASE("An action may remove the effectors of those that follow it") {
  Arena a;
  a.kernel.registerClass<TestThief>();
  Client c = robot(a);
  AgentAspect& agent = *a.control->agents()[0];
  agent.create("TestThief", "thief");
  for (const char* motor : {"m1", "m2", "m3"}) agent.create("TestMotor", motor);
  a.cycle();
  ActionLog expected;
  const auto say = [&](const char* message, const ActionLog& done) {
    expected.insert(expected.end(), done.begin(), done.end());
    c.send(message);
    c.arrive();
    a.cycle();
    REQUIRE(actionLog() == expected);
  };
  // The first message teaches the order of the actions.
  say("(thief)(m1 1)(m2 2)(m3 3)", {"1 m1 1", "1 m2 2", "1 m3 3"});
  say("(thief m1 m2)(m1 4)(m2 5)(m3 6)", {"1 m3 6"});
  say("(thief)(m1 7)(m3 8)(thief m3)(m3 9)", {"1 m3 8"});
  say("(thief)(m3 10)", {});
}

TEST_CASE("A perceptor or effector that throws is named in the log, and its agent and the host continue") {
  Arena a;
  a.kernel.registerClass<TestFault>();
  a.kernel.registerClass<TestBomb>();
  Client c = robot(a);
  a.control->agents()[0]->create("TestFault", "fault");
  a.control->agents()[0]->create("TestBomb", "bomb");
  a.cycle();
  c.drain();
  c.send("(bomb)(he1 1)");
  applyActions(a, 1);
  REQUIRE(a.logged("/usr/scene/AgentAspect1/fault (TestFault) threw and is asked no more: the sensor is broken"));
  REQUIRE(a.logged("/usr/scene/AgentAspect1/bomb (TestBomb) threw: the motor is broken"));
  const std::string without = c.receive().value();
  a.control->agents()[0]->create("TestFault", "whole");
  for (int i = 0; i < 3; ++i) a.cycle();
  std::string with;
  for (const std::string& message : c.drain()) with += message;
  REQUIRE(lacks(without, "half", with));
}

TEST_CASE("A perceptor that leaves lists open is named once, and the percepts of others stay intact") {
  Arena a;
  a.kernel.registerClass<TestSloppy>();
  Client c = robot(a);
  AgentAspect& agent = *a.control->agents()[0];
  agent.create("TestSloppy", "open");
  agent.create("TestSloppy", "surplus");
  agent.create("TestClock", "behind");
  for (int i = 0; i < 3; ++i) {
    a.cycle();
    c.drain();
    c.send("(he1 1)");
    applyActions(a, 1);
    const std::string message = *c.receive();
    CAPTURE(message);
    CHECK_THAT(message, Catch::Contains("(OPEN (rt 1))(SURPLUS 1)("));
    Predicates percepts;
    CHECK(readSexp(message, percepts).message.empty());
  }
  CHECK(count(a.host.text, "/usr/scene/AgentAspect1/open (TestSloppy) left 2 list(s) open in sense()") == 1);
  CHECK(count(a.host.text, "/usr/scene/AgentAspect1/surplus (TestSloppy) closed a list that was not open in sense()") ==
        1);
}

TEST_CASE("A perceptor or effector may throw something other than an exception, and on a worker thread") {
  Arena a;
  a.kernel.jobs().setThreads(3);
  a.kernel.registerClass<TestFault>();
  a.kernel.registerClass<TestBomb>();
  std::vector<Client> clients;
  for (int i = 0; i < 4; ++i) clients.push_back(robot(a));
  for (AgentAspect* agent : a.control->agents()) {
    agent->create("TestFault", "odd");
    agent->create("TestBomb", "odd");
  }
  a.cycle();
  for (Client& c : clients) c.send("(odd)(he1 1)");
  applyActions(a, 4);
  REQUIRE(a.logged(
      "/usr/scene/AgentAspect4/odd (TestFault) threw and is asked no more: something that is no std::exception"));
  REQUIRE(a.logged("(TestBomb) threw something that is no std::exception"));
}

TEST_CASE("An agent aspect removed by other code is no longer an agent from that moment on") {
  Arena a;
  Client one = robot(a), two = robot(a);
  AgentAspect* first = a.control->agents()[0];
  first->parent()->remove(*first);
  REQUIRE(a.agents() == 1);
  REQUIRE(a.control->agents()[0]->number() == 2);
  a.cycle();
  REQUIRE(a.agents() == 1);
  REQUIRE(one.closed());
}

TEST_CASE("Thirty agents join at once") {
  Arena a;
  std::vector<Client> clients;
  for (int i = 0; i < 30; ++i) clients.push_back(a.client());
  for (auto& c : clients) c.send("(scene robot)(syn)");
  std::vector<std::size_t> got(30, 0);
  a.until([&] {
    for (std::size_t i = 0; i < 30; ++i) {
      const std::size_t n = clients[i].drain().size();
      got[i] += n;
      for (std::size_t k = 0; k < n; ++k) clients[i].send("(he1 1)(syn)");
    }
    return *std::min_element(got.begin(), got.end()) >= 5;
  });
  REQUIRE(a.control->agentsSeen() == 30);
  REQUIRE(a.get("messagesDropped").toInteger() == 0);
}

TEST_CASE("Two ports use two message formats at the same time in one process") {
  Arena a;
  a.addPort("json", "JsonParser");
  Client sexp = robot(a);
  Client json = robot(a, R"([["scene","robot"]])", "json");
  sexp.send("(he1 1.5)(init (unum 3)(teamname A))");
  json.send(R"([["he1",2.5],["init",["unum",7],["teamname","B"]]])");
  json.send(R"(["he2",3])");
  sexp.arrive();
  json.arrive();
  a.cycle();
  REQUIRE(actionLog() == ActionLog{"1 he1 1.5", "1 init A 3", "2 he1 2.5", "2 init B 7", "2 he2 3"});
  sexp.drain();
  json.drain();
  a.cycle();
  REQUIRE(sexp.receive()->starts_with("(time (now "));
  REQUIRE(json.receive()->starts_with(R"([["time",["now",)"));
}

TEST_CASE("Replacing the parser node changes the message format") {
  Arena a;
  Node& home = a.kernel.root().require<Node>("/sys/server/gamecontrol");
  home.remove(*home.child("parser"));
  home.create("JsonParser", "parser");
  Client c = robot(a, R"(["scene","robot"])");
  c.send(R"(["he1",2.5])");
  applyActions(a, 1);
  REQUIRE(actionLog() == ActionLog{"1 he1 2.5"});
}
