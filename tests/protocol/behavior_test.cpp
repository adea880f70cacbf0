#include <catch2/catch.hpp>

#include "absence.h"
#include "arena.h"
#include "spark/script_server.h"

using namespace spark;
using namespace spark::test;

namespace {
/// Requests a robot, then answers every message with `(he1 <messages so far>)`.
class TestBehavior : public Behavior {
  SPARK_CLASS(TestBehavior, Behavior)
 public:
  static void describe(Description<TestBehavior>& d) {
    d.doc("Counts the messages that it receives.");
    d.property("heard", &TestBehavior::heard).doc("Messages.");
  }
  void start(Predicates& actions) override { actions.open("scene").add("robot").close(); }
  void think(const Predicates& percepts, Predicates& actions) override {
    if (heard++ == 0) first = (*percepts.begin()).named("now").at(1).number();
    actions.open("he1").add(heard).close();
  }
  int heard = 0;
  double first = 0;
};
}  // namespace

TEST_CASE("A behavior controls an agent with the latency of a connection") {
  Arena a;
  a.kernel.registerClass<TestBehavior>();
  auto& b = a.kernel.create<TestBehavior>("TestBehavior", "/usr/agent/b");
  a.cycle();  // joins
  a.cycle();  // robot
  a.cycle();  // first percepts
  REQUIRE(b.heard == 0);
  a.cycle();  // thinks
  REQUIRE(b.heard == 1);
  REQUIRE(b.first == Approx(3 * 0.02));
  REQUIRE(actionLog().empty());
  a.cycle();  // acts
  REQUIRE(actionLog() == std::vector<std::string>{"1 he1 1"});
  a.cycle();
  REQUIRE(actionLog() == std::vector<std::string>{"1 he1 1", "1 he1 2"});
}

TEST_CASE("The pending actions and percepts of a behavior are part of the state") {
  std::string saved;
  {
    Arena a;
    a.kernel.registerClass<TestBehavior>();
    a.kernel.create("TestBehavior", "/usr/agent/b");
    for (int i = 0; i < 4; ++i) a.cycle();  // its last action is (he1 1)
    StateWriter out(true);
    saveTree(*a.kernel.root().find("/sys/server/gamecontrol"), out);
    saved = out.bytes();
  }
  Arena a;
  a.kernel.registerClass<TestBehavior>();
  auto& b = a.kernel.create<TestBehavior>("TestBehavior", "/usr/agent/b");
  b.heard = 7;
  for (int i = 0; i < 5; ++i) a.cycle();
  Leaf& control = *a.kernel.root().find("/sys/server/gamecontrol");
  const auto before = stateHash(control);
  StateReader in(saved);
  loadTree(control, in);
  REQUIRE(stateHash(control) != before);
  StateWriter again(true);
  saveTree(control, again);
  REQUIRE(again.bytes() == saved);
  actionLog().clear();
  b.first = 0;
  b.heard = 0;
  a.cycle();
  REQUIRE(actionLog() == std::vector<std::string>{"1 he1 1"});
  REQUIRE(b.first == Approx(4 * 0.02));
}

TEST_CASE("Without latency of percepts a behavior acts one cycle earlier") {
  Arena a;
  a.setTiming("senseLatency", 0);
  a.kernel.registerClass<TestBehavior>();
  auto& b = a.kernel.create<TestBehavior>("TestBehavior", "/usr/agent/b");
  a.cycle();
  a.cycle();
  a.cycle();
  REQUIRE(b.heard == 1);
  a.cycle();
  REQUIRE(actionLog() == std::vector<std::string>{"1 he1 1"});
}

TEST_CASE("Behaviors are agents in tree order and before connections, and lockstep does not wait for their answer") {
  Arena a;
  a.kernel.registerClass<TestBehavior>();
  a.kernel.create("TestBehavior", "/usr/agent/team/one");
  a.kernel.create("TestBehavior", "/usr/agent/two");
  Client c = a.client();
  a.until([&] { return a.agents() == 3; });
  for (int i = 0; i < 6; ++i) a.cycle();
  REQUIRE(actionLog().size() >= 2);
  REQUIRE(actionLog()[0] == "1 he1 1");
  REQUIRE(actionLog()[1] == "2 he1 1");
  REQUIRE(a.step());
}

TEST_CASE("Removing a behavior removes its agent") {
  Arena a;
  a.kernel.registerClass<TestBehavior>();
  Leaf& b = a.kernel.create("TestBehavior", "/usr/agent/b");
  a.cycle();
  REQUIRE(a.agents() == 1);
  b.parent()->remove(b);
  a.cycle();
  REQUIRE(a.agents() == 0);
}

TEST_CASE("A behavior written in Lua receives percepts and acts") {
  Arena a;
  Leaf& b = a.kernel.create("ScriptBehavior", "/usr/agent/lua");
  scripts(a.kernel).attachText(b, R"lua(
    on("start", function(self) self.actions = "(scene robot)" end)
    on("think", function(self, event)
      local time = event.data[1]          -- {"time", {"now", t}}
      self.actions = string.format("(he1 %.2f)", time[2][2] * 100)
    end)
  )lua",
                               "test", true);
  for (int i = 0; i < 5; ++i) a.cycle();
  REQUIRE(actionLog() == std::vector<std::string>{"1 he1 6"});
}

TEST_CASE("A behavior written in Lua may delete itself, when it starts or thinks") {
  for (const char* event : {"start", "think"}) {
    Arena a;
    auto& b = a.kernel.create<Node>("ScriptBehavior", "/usr/agent/b");
    scripts(a.kernel).attachText(b,
                                 "on('start', function(self) self.actions = '(scene robot)' end) on('" +
                                     std::string(event) + "', function(self) self:delete() end)",
                                 "test", true);
    for (int i = 0; i < 6; ++i) a.cycle();
    CHECK(a.kernel.root().find("/usr/agent/b") == nullptr);
    CHECK(a.agents() == 0);
  }
}

TEST_CASE("A behavior that cannot get an agent is reported once") {
  Arena a;
  a.kernel.registerClass<TestBehavior>();
  a.set("createEffector", "NoSuchEffector");
  a.kernel.create("TestBehavior", "/usr/agent/b");
  a.cycle();
  a.cycle();
  a.cycle();
  REQUIRE(count(a.host.text, "cannot be made") == 1);
  REQUIRE(a.agents() == 0);
}
