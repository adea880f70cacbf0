// Perceptors, effectors and control aspects that are written in Lua.
#include <catch2/catch.hpp>

#include "absence.h"
#include "arena.h"
#include "spark/script_server.h"

using namespace spark;
using namespace spark::test;
using Catch::Contains;

namespace {
/// Keeps a value.
class Taker : public Node {
  SPARK_CLASS(Taker, Node)
 public:
  static void describe(Description<Taker>& d) {
    d.doc("Keeps a value.");
    d.property("taken", &Taker::taken).doc("The value.");
  }
  Value taken;
};

/// An arena whose robots are built by a script when their agents connect, and one client.
struct ScriptArena : Arena {
  Client client;
  Leaf& rule;
  explicit ScriptArena(const std::string& robot) : client(Arena::client()), rule(makeRule()) {
    script(rule, "on('agentConnected', function(self, event) local agent = get(event.data) " + robot + " end)");
    kernel.registerClass<Taker>();
    client.send("(hello)");
    until([this] { return Arena::logged(" joins."); });
  }
  void script(Leaf& node, const std::string& text) { scripts(kernel).attachText(node, text, "test", true); }
  /// The client's next message in the cycle after the next one.
  std::string percepts() {
    cycle();
    client.drain();
    cycle();
    return client.receive().value_or("");
  }
  void act(const std::string& actions) {
    client.send(actions);
    client.arrive();
    cycle();
  }
  /// How often the log holds a text.
  int logged(const std::string& text) const { return count(host.text, text); }

 private:
  Leaf& makeRule() { return kernel.create("ScriptAspect", "/sys/server/gamecontrol/rule"); }
};

/// A robot with a clock and an eye; `function` is the eye's handler.
std::string clockAndEye(const std::string& function) {
  return "agent:new('TestClock', 'clock') agent:new('ScriptPerceptor', 'eye'):on('perceive', " + function + ")";
}
/// What the robot senses if the script of its eye returns a number.
std::string perceptsWithEye() { return ScriptArena(clockAndEye("function() return 1 end")).percepts(); }
}  // namespace

TEST_CASE("what the script of a ScriptPerceptor returns is its percept") {
  const auto percept = [](const std::string& returned) {
    ScriptArena a("agent:new('ScriptPerceptor', 'eye'):on('perceive', function(self, event) return " + returned +
                  " end)");
    return a.percepts();
  };
  CHECK(percept("1.5") == "(eye 1.50)");
  CHECK(percept("{1, 'two', true}") == "(eye 1 two true)");
  CHECK(percept("{distance = 1.5, bearing = 30}") == "(eye (bearing 30) (distance 1.50))");
  CHECK(percept("{{'pol', 1, 2, 3}, {'pol', 4, 5, 6}}") == "(eye (pol 1 2 3) (pol 4 5 6))");
  CHECK(percept("{}") == "(eye )");
  CHECK(percept("event.name .. event.cycle") == "(eye perceive0)");
}

TEST_CASE("a ScriptPerceptor whose script returns nil senses nothing, and other names and intervals count") {
  const auto heard = [](const std::string& quiet, const std::string& name, int interval) {
    ScriptArena a(
        "calls = 0 agent:new('TestClock', 'clock') agent:new('ScriptPerceptor', 'quiet'):on('perceive', "
        "function() " +
        quiet + " end) local eye = agent:new('ScriptPerceptor', 'eye') " + name + " eye.interval = " +
        std::to_string(interval) + " eye:on('perceive', function() calls = calls + 1 return calls end)");
    std::string all;
    for (int i = 0; i < 9; ++i) {
      a.cycle();
      for (const std::string& message : a.client.drain()) all += message;
    }
    return all;
  };
  const std::string kName = "eye.predicateName = 'SEE'", all = heard("", kName, 3);
  CHECK_THAT(all, Contains("(time (now") && Contains("(SEE 2)"));
  CHECK(lacks(all, "(SEE 4)", heard("", kName, 1)));
  CHECK(lacks(all, "quiet", heard("return 1", kName, 3)));
  CHECK(lacks(all, "eye", heard("", "", 3)));
}

TEST_CASE("a text of a percept that is no word is sent in quotes") {
  for (const auto& [returned, sent] :
       std::vector<std::pair<std::string, std::string>>{{"'two words'", R"((eye "two words"))"},
                                                        {"{'a', {1, '(b'}}", R"((eye a (1 "(b")))"},
                                                        {"{''}", R"((eye ""))"},
                                                        {R"('a"\\b')", R"((eye "a\"\\b"))"}}) {
    ScriptArena a(
        "agent:new('TestClock', 'clock') agent:new('ScriptPerceptor', 'eye'):on('perceive', function() return " +
        returned + " end)");
    CHECK_THAT(a.percepts(), Contains(sent));
  }
}

TEST_CASE("a percept that cannot be sent is logged once and left out") {
  for (const char* returned : {"0/0", "{1, {'a', 1/0}}", "('a'):rep(70000)"}) {
    ScriptArena a(clockAndEye("function() return " + std::string(returned) + " end"));
    INFO(returned);
    const std::string percepts = a.percepts();
    CHECK_THAT(percepts, Contains("(time (now"));
    CHECK(lacks(percepts, "eye", perceptsWithEye()));
    CHECK(a.logged("/usr/scene/AgentAspect1/eye: its script returned a percept that cannot be sent: expected") == 1);
    CHECK(a.kernel.faults() > 1);
  }
}

TEST_CASE("a percept that is too large is logged once and left out") {
  for (const char* returned : {"string.rep('x', 70000)", "table.pack(string.byte(string.rep('x', 9000), 1, -1))"}) {
    ScriptArena a(clockAndEye("function() return " + std::string(returned) + " end"));
    INFO(returned);
    const std::string percepts = a.percepts();
    CHECK_THAT(percepts, Contains("(time (now"));
    CHECK(lacks(percepts, "eye", perceptsWithEye()));
    CHECK(a.logged("/usr/scene/AgentAspect1/eye: its script returned a percept that cannot be sent: expected at most "
                   "65536 bytes, found more. This is logged once.") == 1);
  }
  ScriptArena fits("agent:new('ScriptPerceptor', 'eye'):on('perceive', function() return string.rep('x', 60000) end)");
  CHECK(fits.percepts().size() > 60000);
}

TEST_CASE("a reason of a ScriptEffector that is too long is replaced by one line") {
  const auto said = [](int bytes) {
    ScriptArena a("agent:new('ScriptEffector', 'push'):on('perform', function() return string.rep('x', " +
                  std::to_string(bytes) + ") end)");
    a.act("(push 1)");
    return a.host.text;
  };
  const std::string text = said(2000);
  CHECK(count(text, "push: its script returned a reason of 2000 bytes: expected at most 1024") == 1);
  CHECK(lacks(text, "xxxx", said(1024)));
}

TEST_CASE("an error in the script of a ScriptPerceptor is one line with file and line, and the others sense") {
  ScriptArena a(clockAndEye("function()\n error('no') end"));
  const std::string percepts = a.percepts();
  CHECK_THAT(percepts, Contains("(time (now"));
  CHECK(lacks(percepts, "eye", perceptsWithEye()));
  CHECK(a.logged("handler of 'perceive' at /usr/scene/AgentAspect1/eye failed: test:2: no") == 1);
}

TEST_CASE("a ScriptPerceptor that returns no value is an error with the place of the function") {
  ScriptArena a("agent:new('ScriptPerceptor', 'eye'):on('perceive',\n function() return print end)");
  a.cycle();
  CHECK(
      a.logged("failed: test:2: what this function returned: expected a value (nil, boolean, number, string, table or "
               "node), found a function") == 1);
}

TEST_CASE("a ScriptPerceptor may delete itself, other perceptors, its robot and other agents while it senses") {
  for (const char* victim : {"self", "agent:find('clock')", "agent:find('other')", "agent"}) {
    ScriptArena a(
        "agent:new('TestClock', 'clock') agent:new('ScriptPerceptor', 'eye'):on('perceive', function(self) delete(" +
        std::string(victim) + ") return 1 end) agent:new('ScriptPerceptor', 'other')");
    INFO(victim);
    for (int i = 0; i < 3; ++i) a.cycle();
    CHECK(a.agents() == (std::string(victim) == "agent" ? 0 : 1));
  }
  ScriptArena a("agent:new('ScriptPerceptor', 'eye'):on('perceive', function() delete('/sys/server/gamecontrol') end)");
  a.cycle();
  CHECK(a.logged("it is in use: agents sense just now") == 1);
}

TEST_CASE("the script of a ScriptEffector gets its actions as tables") {
  ScriptArena a(R"(new('Taker', '/usr/taker')
    agent:new('ScriptEffector', 'push'):on('perform', function(self, event)
      get('/usr/taker').taken = event.data
      if event.data[2] == 'wrong' then return 'it is wrong' end
    end))");
  const auto taken = [&](const std::string& action) {
    a.act(action);
    return a.kernel.root().require<Taker>("/usr/taker").taken;
  };
  CHECK(taken("(push 1 -0.5 fast \"12\" (to 3 goal))") ==
        Value(List{"push", 1.0, -0.5, "fast", "12", List{"to", 3.0, "goal"}}));
  CHECK(taken("(push)") == Value(List{"push"}));
  const std::string before = a.host.text;
  taken("(push wrong)");
  CHECK(lacks(before, "push:", a.host.text));
}

TEST_CASE("a text that the script of a ScriptEffector returns is a mistake of the agent") {
  ScriptArena a(R"(agent:new('ScriptEffector', 'push'):on('perform', function(self, event)
    if type(event.data[2]) ~= 'number' then return 'expected a number, found ' .. tostring(event.data[2]) end
  end))");
  a.act("(push 3)");
  const std::string before = a.host.text;
  a.act("(push hard)");
  a.act("(push hard)");
  CHECK(lacks(before, "push:", a.host.text));
  CHECK(a.logged("agent 1 (" + a.client.name() + "): push: expected a number, found hard") == 1);
}

TEST_CASE("an error in the script of a ScriptEffector is logged, and the other actions are executed") {
  ScriptArena a(R"(agent:new('TestMotor', 'he1')
    agent:new('ScriptEffector', 'push'):on('perform', function(self, event)
      error('no') end))");
  a.act("(push 3)(he1 4)");
  CHECK(a.logged("handler of 'perform' at /usr/scene/AgentAspect1/push failed: test:3: no") == 1);
  CHECK(actionLog() == std::vector<std::string>{"1 he1 4"});
}

TEST_CASE("a ScriptEffector may delete itself while it acts") {
  ScriptArena a("agent:new('ScriptEffector', 'push'):on('perform', function(self) delete(self) return 'gone' end)");
  a.act("(push 1)(push 2)");
  CHECK(a.agents() == 1);
}

TEST_CASE("a ScriptEffector may delete another one of its agent, whose later actions are unknown") {
  ScriptArena a(R"(agent:new('TestMotor', 'he1') agent:new('TestMotor', 'he2')
    agent:new('ScriptEffector', 'drop'):on('perform', function() delete('/usr/scene/AgentAspect1/he1') end))");
  a.act("(he1 1)(he2 1)");
  a.act("(he1 2)(drop)(he1 3)(he2 2)");
  a.act("(he1 4)(he2 3)");
  CHECK(actionLog() == std::vector<std::string>{"1 he1 1", "1 he2 1", "1 he1 2", "1 he2 2", "1 he2 3"});
  CHECK(a.agents() == 1);
}

TEST_CASE("a ScriptBehavior may delete itself while it starts or thinks, and its agent leaves") {
  for (const auto& [channel, deletes] : {std::pair{"start", true}, {"think", true}, {"think", false}}) {
    Arena a;
    Leaf& behavior = a.kernel.create("ScriptBehavior", "/usr/agent/lua");
    scripts(a.kernel).attachText(behavior,
                                 R"lua(
      on("start", function(self) self.actions = "(scene robot)" end)
      on(")lua" + std::string(channel) +
                                     R"lua(", function(self) self.actions = "(he1 1)" )lua" +
                                     (deletes ? "delete(self)" : "") + " end)",
                                 "test", true);
    for (int i = 0; i < 6; ++i) a.cycle();
    CHECK(a.agents() == (deletes ? 0 : 1));
    CHECK(actionLog().empty() == deletes);
  }
}

TEST_CASE("the script of a ScriptAspect judges, and knows who comes and goes") {
  Arena a;
  Leaf& rule = a.kernel.create("ScriptAspect", "/sys/server/gamecontrol/rule");
  scripts(a.kernel).attachText(rule, R"lua(
    new("Node", "/usr/log")
    local function note(self, event) new("Node", "/usr/log/" .. event.name .. "_" .. tostring(event.data):gsub("/", "_")) end
    for _, channel in ipairs{"judge", "agentConnected", "agentLeaving"} do on(channel, note) end
  )lua",
                               "test", true);
  std::vector<std::string> seen;
  const auto notes = [&] {
    seen.clear();
    for (const auto& child : a.kernel.root().require<Node>("/usr/log").children()) seen.push_back(child->name());
    a.kernel.root().require<Node>("/usr/log").removeChildren();
    return seen;
  };
  using Names = std::vector<std::string>;
  const auto judge = [&] { a.kernel.events().channel("rule").emit({"rule"}); };
  judge();
  CHECK(notes() == Names{"judge_nil"});
  setProperty(rule, "enabled", false);
  judge();
  CHECK(notes() == Names{});
  {
    Client c = a.client();
    a.until([&] { return a.agents() == 1; });
    CHECK(notes() == Names{"agentConnected__usr_scene_AgentAspect1"});
  }
  a.until([&] { return a.agents() == 0; });
  CHECK(notes() == Names{"agentLeaving__usr_scene_AgentAspect1"});
}

TEST_CASE("a ScriptAspect may change the rules and refuse the agent that connects") {
  Arena a;
  Leaf& rule = a.kernel.create("ScriptAspect", "/sys/server/gamecontrol/rule");
  a.kernel.create("ScriptAspect", "/sys/server/gamecontrol/second");
  scripts(a.kernel).attachText(rule, R"lua(
    on("agentConnected", function(self, event)
      delete("/sys/server/gamecontrol/second")
      for i = 1, 50 do new("ScriptAspect", "/sys/server/gamecontrol/more" .. i) end
      delete(event.data)
    end)
  )lua",
                               "test", true);
  Client c = a.client();
  a.until([&] { return a.logged(" leaves."); });
  CHECK(c.closed());
  CHECK(a.kernel.faults() == 0);
}

TEST_CASE("any handler may remove the network while clients are connected") {
  const std::string handler = GENERATE(as<std::string>(), "agentConnected", "perceive", "perform", "judge");
  INFO(handler);
  Arena a;
  Leaf& rule = a.kernel.create("ScriptAspect", "/sys/server/gamecontrol/rule");
  scripts(a.kernel).attachText(rule, "local handler = '" + handler + R"lua('
    local function cut() local net = get("/sys/server/net") if net then net:delete() end end
    on("agentConnected", function(self, event)
      local agent = get(event.data)
      if handler == "agentConnected" then cut() end
      agent:new("ScriptPerceptor", "eye"):on("perceive", handler == "perceive" and cut or function() return 1 end)
      agent:new("ScriptEffector", "push"):on("perform", handler == "perform" and cut or function() end)
    end)
    if handler == "judge" then on("judge", cut) end
  )lua",
                               "test", true);
  Client first = a.client(), second = a.client();
  a.until([&] { return getProperty(a.port(), "connections") == Value(2); }, false);
  for (Client* client : {&first, &second}) client->send("(push 1)"), client->arrive();
  a.net->poll();
  // From here on there is no network to read from.
  Event event{"", 0, 0.02, 0, nullptr};
  for (int cycle = 1; cycle <= 5; ++cycle)
    for (const ChannelName phase : {phase::kAct, phase::kPrepare, phase::kRule, phase::kSense, phase::kPublish}) {
      event.cycle = cycle, event.name = phase;
      a.kernel.events().channel(phase).emit(event);
    }
  CHECK_FALSE(a.kernel.root().find("/sys/server/net"));
  CHECK(a.logged("agent 2 (" + second.name() + ") joins.") == (handler != "agentConnected"));
  CHECK(a.agents() == 0);
  CHECK(a.kernel.faults() == 0);
}

TEST_CASE("a handler may remove the network while an agent leaves") {
  Arena a;
  Leaf& rule = a.kernel.create("ScriptAspect", "/sys/server/gamecontrol/rule");
  scripts(a.kernel).attachText(
      rule, "on('agentLeaving', function() local net = get('/sys/server/net') if net then net:delete() end end)",
      "test", true);
  Client first = a.client(), second = a.client();
  a.until([&] { return a.agents() == 2; });
  first.leave();
  a.until([&] { return getProperty(a.port(), "connections") == Value(1); }, false);
  for (int cycle = 1; cycle <= 3; ++cycle) a.kernel.events().channel(phase::kAct).emit({phase::kAct});
  CHECK_FALSE(a.kernel.root().find("/sys/server/net"));
  CHECK(a.agents() == 0);
}
