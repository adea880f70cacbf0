// Agents that ask for perceptors and effectors while they run, and rules that refuse.
#include "absence.h"
#include "api/agents.h"
#include "spark/script_server.h"
#include "stadium.h"

using namespace spark;
using namespace spark::test;

namespace {

/// A match in which agents may ask, with one player.
struct AskingMatch : Stadium {
  explicit AskingMatch(bool requests = true)
      : Stadium({{"/sys/server/gamecontrol.requests", requests}}), player(join("A", 1)) {
    trainer("(playMode PlayOn)");
    run(20);
  }
  Leaf& addRule(const char* type) { return node("/sys/server/gamecontrol").asNode()->create(type, "rule"); }
  /// The player's messages from the cycles after it has sent the actions.
  std::string after(const std::string& actions, int cycles = 4) {
    player.all.clear();
    act(player, actions);
    run(cycles);
    std::string out;
    for (const std::string& m : player.all) out += m + "\n";
    return out;
  }
  Player& player;
};

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("An agent asks for a sensor in the middle of a match and gets it") {
  AskingMatch m;
  const std::string before = m.after("(syn)"), heard = m.after("(request (perceptor GPS)(name gps2))");
  INFO(heard);
  CHECK(has(heard, "(granted (name gps2))"));
  CHECK(has(heard, "(GPS (n gps2) (tf "));
  CHECK(lacks(before, "(GPS ", heard));
  CHECK(lacks(m.after("(syn)"), "(granted", heard));  // it is told once
  // Below a part of its robot, by name.
  CHECK(has(m.after("(request (perceptor GPS)(name inside)(at body))"), "(GPS (n inside) (tf "));
}

TEST_CASE("An agent asks for an effector and uses it") {
  AskingMatch m;
  CHECK(has(m.after("(request (effector SayEffector)(name mouth))"), "(granted (name mouth))"));
}

TEST_CASE("Requests that cannot be granted are answered with what was expected") {
  AskingMatch m;
  const auto why = [&](const std::string& request) {
    const std::string heard = m.after(request);
    const std::size_t at = heard.find("(why ");
    return at == std::string::npos ? heard : heard.substr(at, heard.find("))", at) - at);
  };
  CHECK(
      has(why("(request (perceptor Gps)(name g))"), "(why expected the class of a perceptor, such as GPS, found Gps"));
  CHECK(has(why("(request (perceptor RigidBody)(name g))"), "found RigidBody"));
  CHECK(has(why("(request (effector GPS)(name g))"), "(why expected the class of an effector"));
  CHECK(has(why("(request (perceptor Perceptor)(name g))"), "found Perceptor"));
  CHECK(has(why("(request (perceptor GPS)(name g)(at nowhere))"), "there is no node nowhere in this robot"));
  CHECK(has(why("(request (perceptor GPS)(name g)(at ../../../sys/server))"), "there is no node"));
  CHECK(has(why("(request (perceptor GPS)(name a/b))"), "(why "));
  CHECK(has(why("(request (scene rsg/soccer/field.rsg))"),
            "expected a file below rsg/agent/, found rsg/soccer/field.rsg"));
  CHECK(has(why("(request (scene rsg/agent/../soccer/field.rsg))"), "expected a file below"));
  CHECK(has(why("(request (scene rsg/agent/nothing.rsg))"), "(why it cannot be made, the log of the host says why"));
  const std::string granted = m.after("(request (perceptor GPS)(name g))");
  CHECK(has(why("(request (perceptor GPS)(name g))"), "there is a node g already"));
  // Malformed ones are mistakes, which the log has.
  for (const char* wrong : {"(request)", "(request (perceptor))", "(request (perceptor GPS))",
                            "(request perceptor GPS)", "(request (perceptor (GPS))(name x))"})
    CHECK(lacks(m.after(wrong), "granted", granted));
  // No more than its share.
  std::string last;
  for (int i = 0; i < 40; ++i) last = m.after("(request (perceptor GPS)(name more" + std::to_string(i) + "))", 2);
  CHECK(has(m.after("(request (perceptor GPS)(name last))"), "32 requests were granted, no more are"));
}

TEST_CASE("Requests cannot undo what limits an agent, and names are plain words") {
  AskingMatch m;
  for (const char* given :
       {"(request (effector SceneEffector)(name x))", "(request (effector RequestEffector)(name x))",
        "(request (perceptor RequestPerceptor)(name x))"})
    CHECK(has(m.after(given), "(refused (name x) (why expected the class of"));
  const auto named = [&](const std::string& name) { return m.after("(request (perceptor GPS)(name " + name + "))"); };
  const std::string plain = named("plain");
  for (const char* name : {"\"a b\"", "\"a\nb\"", "a\xff", "\xc3\xa9", "\";\""})
    CHECK(lacks(named(name), "(granted", plain));
}

TEST_CASE("Being able to ask is no robot") {
  Stadium s({{"/sys/server/gamecontrol.requests", true}, {"/sys/server/gamecontrol.idleLimit", 1e-9}});
  const auto seen = [&] { return s.get("/sys/server/gamecontrol", "agentsSeen").toInteger(); };
  Player& idle = s.connect();
  s.run(3);
  CHECK(seen() == 0);
  CHECK(idle.client.ended());
}

namespace {
/// Removes a node when an agent asks for something.
class Remover : public ControlAspect, public IAgentJudge {
  SPARK_CLASS(Remover, ControlAspect)
 public:
  static void describe(Description<Remover>& d) {
    d.doc("Removes a node.");
    d.implements<IAgentJudge>();
  }
  void rule(const Event&) override {}
  std::string judgeRequest(AgentAspect&, const PartRequest&) override {
    if (Leaf* const node = target.get()) node->parent()->remove(*node);
    return {};
  }
  std::string judgeAction(AgentAspect& agent, const Effector&, const Element&) override {
    return inAct ? judgeRequest(agent, {PartRequest::Kind::scene, "", "", agent}) : std::string();
  }
  Ref<Leaf> target;
  bool inAct = false;
};
}  // namespace

TEST_CASE("A rule may remove another one, or the agent, while it judges") {
  for (const bool inAct : {false, true})
    for (const char* target : {"/sys/server/gamecontrol/second", "/usr/scene/AgentAspect1"}) {
      AskingMatch m;
      Node& control = *m.node("/sys/server/gamecontrol").asNode();
      control.kernel().registerClass<Remover>();
      auto& rule = control.create<Remover>("Remover", "first");
      control.create("RequestAspect", "second");
      rule.target = &m.node(target);
      rule.inAct = inAct;
      m.after("(request (perceptor GPS)(name gps2)(at body))", 3);
      CHECK(control.kernel().root().find(target) == nullptr);
    }
}

TEST_CASE("A rule refuses an agent's request the first time and disqualifies the agent the second time") {
  AskingMatch m;
  Leaf& rule = m.addRule("RequestAspect");
  setProperty(rule, "allowed", Value(List{"GyroRatePerceptor"}));
  setProperty(rule, "tolerance", 1);
  const std::string first = m.after("(request (perceptor GPS)(name gps2))");
  INFO(first);
  CHECK(has(first, "(refused (name gps2) (why the rules do not allow GPS))"));
  AskingMatch open;
  CHECK(lacks(first, "(GPS ", open.after("(request (perceptor GPS)(name gps2))")));
  CHECK_FALSE(m.player.client.ended());
  m.after("(request (perceptor GPS)(name gps2))");
  CHECK(m.player.client.ended());
}

TEST_CASE("A rule in Lua refuses requests with a reason") {
  AskingMatch m;
  Leaf& rule = m.addRule("ScriptAspect");
  scripts(rule.kernel())
      .attachText(rule, R"lua(
    on("request", function(self, event)
      local agent, kind, class, name = table.unpack(event.data)
      if class == "GPS" then return "no " .. kind .. " " .. class .. " for " .. name end
    end)
  )lua",
                  "test", true);
  const std::string heard = m.after("(request (perceptor GPS)(name gps2))");
  INFO(heard);
  CHECK(has(heard, "(refused (name gps2) (why no perceptor GPS for gps2))"));
  CHECK(has(m.after("(request (perceptor GyroRatePerceptor)(name g))"), "(granted (name g))"));
}

TEST_CASE("A rule that is disabled refuses nothing") {
  AskingMatch m;
  Leaf& rule = m.addRule("RequestAspect");
  setProperty(rule, "enabled", false);
  CHECK(has(m.after("(request (perceptor GPS)(name gps2))"), "(granted (name gps2))"));
}

TEST_CASE("An agent may use an effector as often in a cycle as a rule allows") {
  AskingMatch m;
  Leaf& rule = m.addRule("ActionLimitAspect");
  setProperty(rule, "predicate", "request");
  m.after("(request (perceptor GPS)(name a))(request (perceptor GPS)(name b))");
  const std::string heard = m.after("(syn)");
  CHECK(has(heard, "(GPS (n a) "));
  CHECK(has(m.after("(request (perceptor GPS)(name b))"), "(granted (name b))"));  // in another cycle
  CHECK(lacks(heard, "(GPS (n b) ", m.after("(syn)")));
}

TEST_CASE("Without the property an agent cannot ask") {
  AskingMatch with, without(false);
  const std::string request = "(request (perceptor GPS)(name gps2))";
  CHECK(lacks(without.after(request), "granted", with.after(request)));
}
