#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "../status_report.h"
#include "../stream/messages.h"
#include "fake_scene.h"
#include "spark/describe.h"
#include "test_support.h"

using namespace spark;
using namespace spark::test;
using web::StatusReport;
using Json = nlohmann::json;

namespace {

/// A game that is not soccer.
class SumoGame : public Node, public IStatus {
  SPARK_CLASS(SumoGame, Node)
 public:
  static void describe(Description<SumoGame>& d) { d.implements<IStatus>(); }
  void report(std::vector<StatusEntry>& out) const override { out.insert(out.end(), entries.begin(), entries.end()); }
  std::vector<StatusEntry> entries;
};

class Wrestler : public Node, public IAgentIdentity {
  SPARK_CLASS(Wrestler, Node)
 public:
  static void describe(Description<Wrestler>& d) { d.implements<IAgentIdentity>(); }
  const std::string& team() const override { return name_; }
  int number() const override { return 4; }

 private:
  std::string name_ = "East \"1\"";
};

class TwoAgents : public Node, public IGameControl {
  SPARK_CLASS(TwoAgents, Node)
 public:
  static void describe(Description<TwoAgents>& d) { d.implements<IGameControl>(); }
  const std::vector<AgentAspect*>& agents() const override { return all; }
  void removeAgent(AgentAspect&, bool) override {}
  void disqualify(AgentAspect&, std::string_view) override {}
  std::string judgeRequest(AgentAspect&, const PartRequest&) override { return {}; }
  int agentsSeen() const override { return 2; }
  const Predicates* percepts(const AgentAspect&) const override { return nullptr; }
  List senseNow(Node&) override { return {}; }
  double latency(const AgentAspect& agent) const override { return &agent == all[0] ? 0.0125 : std::nan(""); }
  IConnection* connection(const AgentAspect& agent) const override {
    return agent.name() == "thinks" ? thinks : agent.name() == "begins" ? begins : nullptr;
  }
  void withdrawAgents() override {}
  void restoreAgent(Node&, const std::string&, int) override {}
  std::vector<AgentAspect*> all;
  IConnection *thinks = nullptr, *begins = nullptr;
};

/// A port whose first connection has thought, and whose others have not.
class Thinkers : public Node, public IAgentTimes {
  SPARK_CLASS(Thinkers, Node)
 public:
  static void describe(Description<Thinkers>& d) { d.implements<IAgentTimes>(); }
  std::optional<AgentTimes> times(const IConnection& connection) const override {
    if (&connection == first) return AgentTimes{3, 2.25, 10, 9, 2};
    return AgentTimes{std::nan(""), std::nan(""), 10, 9, 0};
  }
  const IConnection* first = nullptr;
};

struct SumoMatch : TestHost {
  SumoMatch() : TestHost(false), report(kernel) {
    kernel.registerClass<SceneNode>();
    kernel.registerClass<Transform>();
    kernel.registerClass<AgentAspect>();
    kernel.registerClass<SumoGame>();
    kernel.registerClass<Wrestler>();
    kernel.registerClass<TwoAgents>();
    kernel.registerClass<Thinkers>();
  }
  SumoGame& game(std::vector<StatusEntry> entries) {
    auto& game = kernel.create<SumoGame>("SumoGame", "/usr/sumo");
    game.entries = std::move(entries);
    return game;
  }
  Json status() { return Json::parse(report.make(1)); }
  StatusReport report;
};

}  // namespace

TEST_CASE("the status of another game has known entries by name, and all others as name and value") {
  SumoMatch match;
  SECTION("with all known entries") {
    match.game({{"round", 3, {}},
                {"playMode", "Push", {}},
                {"score", List{2, 1, 0}, {}},
                {"teams", List{"East", "We\"st"}, {}},
                {"wind", List{0.5, HUGE_VAL, true}, {}}});
    const Json status = match.status();
    CHECK(status["playMode"] == "Push");
    CHECK(status["score"] == Json({2, 1, 0}));
    CHECK(status["teams"] == Json({"East", "We\"st"}));
    CHECK(status["status"] == Json::parse(R"([["round",3],["wind",[0.5,null,true]]])"));
    CHECK(status["agents"].empty());
  }
  SECTION("without known entries") {
    const Json nothing = match.status();
    for (const char* word : {"playMode", "score", "teams", "status"}) CHECK_FALSE(nothing.contains(word));
    // An entry may have the name of a member of the message, or an unexpected type.
    match.game({{"time", "late", {}}, {"score", 7, {}}, {"empty", List{}, {}}});
    const Json status = match.status();
    CHECK(status["time"] == 0);
    CHECK_FALSE(status.contains("score"));
    CHECK(status["status"] == Json::parse(R"([["time","late"],["score",7],["empty",[]]])"));
  }
}

TEST_CASE("team and number of an agent come from a node below it, at any depth") {
  SumoMatch match;
  auto& control = match.kernel.create<TwoAgents>("TwoAgents", "/sys/server/gamecontrol");
  for (const char* name : {"one", "two"})
    control.all.push_back(&match.kernel.create<AgentAspect>("AgentAspect", std::string("/usr/scene/") + name));
  control.all[0]->create<Transform>("Transform", "body").create("Wrestler", "anything");
  CHECK(match.status()["agents"] ==
        Json::parse(R"([{"path":"/usr/scene/one","team":"East \"1\"","number":4,"latency":12.5},
                        {"path":"/usr/scene/two","team":"","number":0,"latency":null}])"));
}

TEST_CASE("think times of an agent come from the port of its connection, if that has any") {
  SumoMatch match;
  auto& control = match.kernel.create<TwoAgents>("TwoAgents", "/sys/server/gamecontrol");
  for (const char* name : {"inside", "thinks", "begins"})
    control.all.push_back(&match.kernel.create<AgentAspect>("AgentAspect", std::string("/usr/scene/") + name));
  auto& port = match.kernel.create<Thinkers>("Thinkers", "/sys/server/thinkers");
  FakeConnection thinks(port, 1), begins(port, 2), plain(control, 3);
  control.thinks = &thinks;
  control.begins = &begins;
  port.first = &thinks;
  const Json agents = match.status()["agents"];
  CHECK_FALSE(agents[0].contains("thinking"));
  CHECK(agents[1]["thinking"] == Json::parse(R"({"last":3,"mean":2.25,"senseLatency":10,"actLatency":9,"dropped":2})"));
  CHECK(agents[2]["thinking"] ==
        Json::parse(R"({"last":null,"mean":null,"senseLatency":10,"actLatency":9,"dropped":0})"));
  control.begins = &plain;
  CHECK_FALSE(match.status()["agents"][2].contains("thinking"));
}
