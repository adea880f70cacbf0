#include "../inspection.h"

#include "../../soccer/tests/match_house.h"
#include "api/control.h"
#include "api/phases.h"
#include "spark/script_server.h"

using namespace spark;
using namespace spark::test;
using inspect::Inspection;
using Json = nlohmann::json;

namespace {

/// The simulation of lua/soccer.lua with a humanoid, without a network.
struct League : TestHost {
  explicit League(bool noise = false) : inspection(kernel) {
    ScriptServer& lua = scripts(kernel);
    lua.addFolder(SPARK_SOURCES "/lua");
    lua.run("host = { share = '" SPARK_SOURCES "', scenePaths = {}, alone = true }", "league");
    lua.addOverride("/sys/server/simulation.rate", "max");
    lua.addOverride("/sys/server/net.open", false);
    lua.addOverride("Soccer.VisionNoise", noise);
    lua.runConfig("soccer.lua");
    kernel.registerClass<Puppet>();
    player = &kernel.create<Puppet>("Puppet", "/usr/agent/player");
    player->robot = "rsg/agent/nao/nao_hetero.rsg 0";
    run(5);
    act("(init (unum 3)(teamname Red))");
    act("(beam -2 0.5 10)");
    run(20);
  }
  void run(int cycles) {
    const Value n(cycles);
    callMethod(kernel.root().require<Leaf>("/sys/server/simulation"), "runCycles", std::span(&n, 1));
  }
  void act(const std::string& actions) {
    player->next = actions;
    run(2);
  }
  Json ask(const Json& request) { return Json::parse(inspection.answer(request)); }
  /// The robot's percepts in the next cycle with vision (every third one), or in the next one without.
  Json percepts(bool seeing) {
    const auto sees = [&] {
      const auto& agent = kernel.root().require<AgentAspect>("/usr/scene/AgentAspect1");
      for (const Element e : *kernel.root().require<IGameControl>("/sys/server/gamecontrol").percepts(agent))
        if (e.head() == "See") return true;
      return false;
    };
    do run(1), inspection.observe();
    while (sees() != seeing);
    return ask({{"do", "percepts"}, {"path", "/usr/scene/AgentAspect1"}});
  }
  Inspection inspection;
  Puppet* player;
};

Vec3 vec(const Json& j) { return {j.at(0).get<double>(), j.at(1).get<double>(), j.at(2).get<double>()}; }

/// The maximum distance between seen and true positions [m]; fails if a true position is missing.
double error(const Json& percepts) {
  double maximum = 0;
  for (const Json& s : percepts["seen"]) {
    INFO(s.dump());
    REQUIRE(s.contains("true"));
    maximum = std::max(maximum, (vec(s["seen"]) - vec(s["true"])).norm());
  }
  return maximum;
}

bool ends(const Json& path, std::string_view how) { return path.get_ref<const std::string&>().ends_with(how); }

}  // namespace

TEST_CASE("contacts have colliders and position, and the force if it is measured") {
  League league;
  setProperty(league.kernel.root().require<Leaf>("/sys/server/physics"), "measureForces", true);
  league.run(100);
  const Json answer = league.ask({{"do", "contacts"}});
  REQUIRE(answer["ok"] == true);
  Vec3 onBall = Vec3::Zero();
  int feet = 0;
  for (const Json& c : answer["contacts"]) {
    CHECK(std::abs(vec(c["normal"]).norm() - 1) < 1e-3);
    if (c["solved"] == false) continue;  // a contact that is only detected
    const bool ball = ends(c["a"], "Ball/geometry") || ends(c["b"], "Ball/geometry");
    if (ball) {
      CHECK(vec(c["position"]).norm() < 0.1);
      onBall += (ends(c["a"], "Ball/geometry") ? 1 : -1) * vec(c["force"]);
    } else {
      ++feet;
      CHECK(vec(c["position"]).z() < 0.02);
    }
  }
  CHECK(feet >= 3);
  CHECK(onBall.z() == Approx(0.026 * 9.81).epsilon(0.1));
}

TEST_CASE("joints have angles and rates") {
  League league;
  const auto neck = [&] {
    const Json answer = league.ask({{"do", "joints"}, {"path", "/usr/scene/AgentAspect1"}});
    REQUIRE(answer["ok"] == true);
    CHECK(answer["joints"].size() == 22);
    for (const Json& j : answer["joints"]) {
      CHECK(j["type"] == "hinge");
      CHECK(vec(j["axes"][0]).norm() == Approx(1).margin(1e-3));
      CHECK(std::abs(vec(j["anchor"]).x() + 2) < 1);
      CHECK(j["low"] < j["high"]);
    }
    return answer["joints"][0];
  };
  const Json before = neck();
  CHECK(std::abs(vec(before["axes"][0]).z()) > 0.9);
  league.act("(he1 1)");
  league.run(10);
  const Json after = neck();
  CHECK(std::abs(after["rates"][0].get<double>()) == Approx(57.3).margin(3));
  CHECK(std::abs(after["angles"][0].get<double>() - before["angles"][0].get<double>()) > 5);
  CHECK(after["path"] == before["path"]);
}

TEST_CASE("an agent's vision is reported with the true positions of the same cycle") {
  League league;
  const Json seeing = league.percepts(true);
  REQUIRE(seeing["ok"] == true);
  REQUIRE(seeing["seen"].size() >= 4);
  CHECK(seeing["seenTime"] == seeing["time"]);
  CHECK(error(seeing) < 2e-3);
  CHECK_FALSE(seeing["lines"].empty());
  for (const Json& line : seeing["lines"])
    for (const Json& end : line) CHECK(std::abs(vec(end).z()) < 0.02);
  std::vector<std::string> names;
  for (const Json& s : seeing["seen"]) names.push_back(s["name"]);
  CHECK(std::count(names.begin(), names.end(), "B") == 1);

  REQUIRE(seeing["cones"].size() == 1);
  CHECK(seeing["cones"][0]["horizontal"] == 120);
  CHECK(seeing["cones"][0]["vertical"] == 120);
  CHECK_FALSE(seeing["cones"][0].contains("range"));
  CHECK(seeing["head"] == seeing["cones"][0]["matrix"]);
  REQUIRE(seeing["head"].size() == 16);
  CHECK(seeing["head"][0].get<double>() > 0.9);  // it faces +x
  CHECK(seeing["head"][12].get<double>() == Approx(-2).margin(0.3));

  // The robot falls and the ball moves, and the seen positions remain unchanged.
  league.act("(lle3 3)(rle3 3)(he1 2)");
  league.run(20);
  Json moving = league.percepts(true);
  CHECK(error(moving) < 2e-3);
  const Json blind = league.percepts(false);
  CHECK(blind["seenTime"] < blind["time"]);
  CHECK(error(blind) < 2e-3);
  int sees = 0;
  for (const Json& p : blind["percepts"]) sees += p[0] == "See";
  CHECK(sees == 1);

  // It is kept up to date for who goes on asking.
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (blind["seenTime"] == league.percepts(true)["seenTime"]) REQUIRE(std::chrono::steady_clock::now() < end);
}

TEST_CASE("any node of an agent selects the agent, and percepts are nested lists") {
  League league;
  std::vector<Perceptor*> all;
  league.kernel.root().require<Node>("/usr/scene/AgentAspect1").collect(all);
  const Json answer = league.ask({{"do", "percepts"}, {"path", all[0]->path()}});
  REQUIRE(answer["ok"] == true);
  REQUIRE(answer["percepts"].size() > 10);
  CHECK(answer["percepts"][0][0] == "time");
  CHECK(answer["percepts"][0][1][0] == "now");
  CHECK(answer["percepts"][0][1][1].is_number());
}

TEST_CASE("spheres have vision in all directions, and an agent without percepts has empty lists") {
  SoccerMatch match;
  match.importField();
  match.join("A", 1), match.join("B", 2);
  Inspection inspection(match.kernel);
  for (const char* agent : {"1", "2"}) {
    const std::string path = std::string("/usr/scene/AgentAspect") + agent;
    const Value off(false);
    callMethod(match.at(path + "/body/VisionPerceptor"), "addNoise", std::span(&off, 1));
    Json answer;
    for (int i = 0; i < 4 && (answer.is_null() || answer["seen"].empty()); ++i) {
      match.run(1);
      answer = Json::parse(inspection.answer({{"do", "percepts"}, {"path", path}}));
    }
    CHECK(answer["seen"].size() == 10);
    CHECK(error(answer) < 2e-3);
    CHECK(answer["cones"][0]["horizontal"] == 360);
    CHECK(answer["cones"][0]["vertical"] == 180);
    CHECK(answer["head"][0].get<double>() == Approx(agent[0] == '1' ? 1 : -1));
  }
  match.kernel.create("AgentAspect", "/usr/scene/nobody");
  const Json nothing = Json::parse(inspection.answer({{"do", "percepts"}, {"path", "/usr/scene/nobody"}}));
  CHECK(nothing["ok"] == true);
  for (const char* list : {"percepts", "seen", "lines", "cones"}) CHECK(nothing[list].empty());
  CHECK_FALSE(nothing.contains("head"));
}

TEST_CASE("a match is the same with and without inspection") {
  const auto play = [](bool inspect) {
    League league(true);
    league.act("(he1 1)(lle3 2)(rle4 -1)");
    for (int i = 0; i < 30; ++i) {
      if (inspect) {
        league.inspection.observe();
        for (const char* what : {"contacts", "joints", "percepts"})
          CHECK(league.ask({{"do", what}, {"path", "/usr/scene/AgentAspect1"}})["ok"] == true);
      }
      league.run(1);
    }
    return stateHash(league.kernel.root());
  };
  CHECK(play(true) == play(false));
}

TEST_CASE("inspection supports the removal of inspected nodes") {
  SoccerMatch match;
  match.importField();
  match.join("A", 1);
  Inspection inspection(match.kernel);
  match.run(50);  // the robot and the ball lie on the ground
  const auto contacts = [&] { return Json::parse(inspection.answer({{"do", "contacts"}}))["contacts"]; };
  CHECK_FALSE(contacts().empty());
  inspection.answer({{"do", "percepts"}, {"path", "/usr/scene/AgentAspect1"}});
  auto& scene = match.kernel.root().require<Node>("/usr/scene");
  scene.remove(match.at("/usr/scene/AgentAspect1"));
  inspection.observe();
  CHECK(contacts().empty());
  CHECK(Json::parse(inspection.answer({{"do", "percepts"}, {"path", "/usr/scene/AgentAspect1"}}))["ok"] == false);
  match.run(3);
  inspection.observe();
}

TEST_CASE("a child of the control server gives the same answers") {
  SoccerMatch match;
  match.importField();
  match.join("A", 1);
  match.kernel.plugins().use("inspect");
  auto handler = match.kernel.create("Inspector", "/usr/inspect").as<IRequestHandler>();
  Inspection inspection(match.kernel);
  handler->poll();
  for (const std::string_view what : handler->requests()) {
    const Json request{{"do", what}, {"path", "/usr/scene/AgentAspect1"}};
    CHECK(handler->answer(request.dump()) == inspection.answer(request));
  }
  CHECK(handler->requests().size() == 3);
  CHECK(Json::parse(handler->answer("junk"))["ok"] == false);
}

TEST_CASE("invalid requests get an answer with the reason") {
  SoccerMatch match;
  Inspection inspection(match.kernel);
  const std::pair<Json, const char*> cases[] = {{{{"do", "percepts"}}, "lacks a text"},
                                                {{{"do", "percepts"}, {"path", 7}}, "lacks a text"},
                                                {{{"do", "percepts"}, {"path", "/usr/scene"}}, "is no agent's"},
                                                {{{"do", "joints"}, {"path", "/nowhere"}}, "/nowhere"},
                                                {{{"do", "dance"}}, "found 'dance'"},
                                                {{{"do", 5}}, ""},
                                                {Json::array(), ""}};
  for (const auto& [request, why] : cases) {
    INFO(request.dump());
    const Json answer = Json::parse(inspection.answer(request));
    CHECK(answer["ok"] == false);
    CHECK_THAT(answer["error"].get<std::string>(), Catch::Contains(why));
  }
}
