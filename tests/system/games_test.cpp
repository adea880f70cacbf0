#include <catch2/catch.hpp>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>

#include "client.h"
#include "process.h"
#include "temporary_folder.h"
#include "test_support.h"
#include "web_client.h"

// The score of a game other than soccer is shown in the same places.

using namespace spark::test;
using Json = nlohmann::json;
using Catch::Contains;

namespace {
const char* kSumo = R"(
include "house.lua"
files() scene() simulation()
agents{} monitors{} web() control()
plugin "sumo"
new("SumoBoard", "/usr/sumo")
)";

/// `program` with the sumo config and the plugin that it needs.
std::vector<std::string> sumo(const char* name, const TemporaryFolder& folder, std::vector<std::string> more) {
  const std::string plugins = (binFolder().parent_path() / "tests" / "game-plugins").string();
  more.insert(more.begin(), {program(name), "--config", folder.write("sumo.lua", kSumo), "--plugin-path", plugins});
  return more;
}
}  // namespace

TEST_CASE("A buggy drives laps, by a driver inside and by one over TCP, which do the same") {
  const auto result = [](Process& host) {
    const Json line = Json::parse(host.line());
    CHECK(host.wait() == 0);
    CHECK(line["status"]["lap"] == 1);
    CHECK(line["faults"] == 0);
    return line["status"]["best"].get<double>();
  };
  const std::vector<std::string> common{
      program("sparkhost"), "--config", "buggy.lua",  "--set", "laps=1",      "--rate", "max", "--agent-port", "0",
      "--monitor-port",     "0",        "--web-port", "0",     "--log-level", "warning"};
  Process inside(common);
  inside.line();
  const double best = result(inside);
  CHECK(best > 10);
  CHECK(best < 40);
  CHECK(inside.errors() == "");
  Process outside(joined(common, {"--set", "drivers=0", "--sync", "--log-level", "info"}));
  const Json ports = Json::parse(outside.line());
  {
    Client first(ports["agentPort"].get<unsigned short>());  // which leaves again
    first.send("(syn)");
    CHECK_THAT(first.receive(), Contains("LDR"));
  }
  outside.waitForError("leaves.");
  Process driver({program("buggy-driver"), "--port", ports["agentPort"].dump()});
  CHECK(result(outside) == Approx(best).margin(0.5));
  CHECK(driver.wait() == 0);
}

TEST_CASE("The score of another game is in the status line, in the page's status, and in the host's last line") {
  TemporaryFolder folder;
  Process host(sumo("sparkhost", folder, {"--agent-port", "0", "--monitor-port", "0", "--web-port", "0"}));
  const Json ports = Json::parse(host.line());
  const std::string link = ports["web"];
  const Json status =
      Json::parse(WebClient::status(static_cast<unsigned short>(std::stoi(link.substr(link.rfind(':') + 1)))));
  CHECK(status["playMode"] == "Push");
  CHECK(status["teams"] == Json({"East", "West"}));
  REQUIRE(status["score"].size() == 2);
  const Json others = status["status"];
  CHECK(others[0][0] == "round");
  CHECK(others[0][1] == status["score"][0].get<int>() + status["score"][1].get<int>());
  CHECK(others[1] == Json::parse(R"(["grip",[0.5,"belt"]])"));

  host.waitForError(", Push ");
  CHECK_THAT(host.errors(), Contains(", teams East West, round ") && Contains(", grip 0.5 belt, 0 agents"));
  host.signal(SIGTERM);
  const Json result = Json::parse(host.line());
  CHECK(result["playMode"] == "Push");
  const int rounds = result["cycles"].get<int>() / 10;  // won in turn
  CHECK(result["score"] == Json({(rounds + 1) / 2, rounds / 2}));
  CHECK(result["status"] == Json({{"round", rounds}, {"grip", {0.5, "belt"}}}));
  CHECK(host.wait() == 0);
}

TEST_CASE("A batch of another game writes the score to the table's columns") {
  TemporaryFolder folder;
  const std::string table = (folder.path() / "sumo.csv").string();
  const Finished run = runToEnd(sumo("sparkbatch", folder, {"--runs", "2", "--duration", "1", "--results", table}));
  CAPTURE(run.errors);
  REQUIRE(run.code == 0);
  std::ifstream file(table);
  std::string head, row;
  std::getline(file, head), std::getline(file, row);
  CHECK_THAT(head, Contains(",stateHash,playMode,score1,score2,teams1,teams2,round,gripStrength,gripPlace,"));
  CHECK_THAT(row, Contains(",Push,3,2,East,West,5,0.5,belt,"));
}

TEST_CASE("The score of a game written only in Lua is in a batch's columns and in the host's last line") {
  TemporaryFolder folder;
  const std::string config = folder.write("lua.lua", R"(
include "house.lua"
files() scene() simulation()
status{ score = {0, 0}, teams = {"East", "West"} }
on("rule", function(self, event) if event.cycle % 10 == 0 then Status.score = {Status.score[1] + 1, 0} end end)
)"),
                    table = (folder.path() / "lua.jsonl").string();
  const Finished run = runToEnd(
      {program("sparkbatch"), "--config", config, "--runs", "1", "--seed", "3", "--duration", "1", "--results", table});
  CAPTURE(run.errors);
  REQUIRE(run.code == 0);
  std::ifstream file(table);
  std::string line;
  std::getline(file, line);
  const Json row = Json::parse(line);
  CHECK(row["score1"] == 5);
  CHECK(row["score2"] == 0);
  CHECK(row["teams2"] == "West");
  const Finished host =
      runToEnd({program("sparkhost"), "--config", config, "--rate", "max", "--seed", "3", "--duration", "1"});
  const Json result = Json::parse(host.out.substr(host.out.find('\n') + 1));
  CHECK(result["score"] == Json({5, 0}));
  CHECK(result["teams"] == Json({"East", "West"}));
  CHECK(result["stateHash"] == row["stateHash"]);
}

namespace {
/// sparkhost with the sumo game of lua/, which is written in Lua alone.
std::vector<std::string> luaSumo(std::vector<std::string> more) {
  std::vector<std::string> out{
      program("sparkhost"), "--config",       "sumo.lua", "--rate", "max", "--agent-port", "0", "--set",
      "web=false",          "--monitor-port", "0"};
  out.insert(out.end(), more.begin(), more.end());
  return out;
}
}  // namespace

TEST_CASE("A game with perceptors, effectors, rule and players in Lua alone is played to its end") {
  const auto play = [](const char* seed) {
    const Finished run = runToEnd(luaSumo({"--seed", seed, "--set", "bouts=3"}));
    INFO(run.errors);
    REQUIRE(run.code == 0);
    CHECK_THAT(run.errors, Contains("bout 3 took"));
    return Json::parse(run.out.substr(run.out.find('\n') + 1));
  };
  const Json result = play("7");
  CHECK(result["playMode"] == "Over");
  CHECK(result["teams"] == Json({"Red", "Blue"}));
  CHECK(result["status"]["bout"] == 3);
  CHECK(result["score"][0].get<int>() + result["score"][1].get<int>() > 0);
  CHECK(result["faults"] == 0);
  const Json again = play("7");
  CHECK(again["score"] == result["score"]);
  CHECK(again["stateHash"] == result["stateHash"]);
  CHECK(play("8")["stateHash"] != result["stateHash"]);
}

TEST_CASE("Each bout of a game in Lua has its own limit of time, after which it is a draw") {
  const Finished run = runToEnd(luaSumo({"--set", "bouts=4", "--set", "limit=0.5"}));
  INFO(run.errors);
  REQUIRE(run.code == 0);
  for (int bout = 1; bout <= 4; ++bout)
    CHECK_THAT(run.errors, Contains("bout " + std::to_string(bout) + " took 0.50 s: 0:0"));
}

TEST_CASE("An agent over TCP plays against one inside in a game in Lua") {
  Process host(luaSumo({"--sync", "--set", "players=1", "--set", "bouts=2", "--set", "limit=5"}));
  Client agent(Json::parse(host.line())["agentPort"].get<unsigned short>());
  agent.send("(syn)");
  std::string percepts;
  try {
    for (int i = 0;; ++i) {
      percepts = agent.receive();
      agent.send(i == 3 ? "(push fast)(syn)" : "(push 1 0)(syn)");
    }
  } catch (const boost::system::system_error&) {
    // The game is over.
  }
  const Json result = Json::parse(host.line());
  CHECK(host.wait() == 0);
  CHECK_THAT(percepts, Contains("(opponent (bearing ") && Contains(") (distance ") && Contains("(middle (bearing "));
  CHECK_THAT(host.errors(),
             Contains("push: expected (push forwards turning), two numbers from -1 to 1, found 1 value"));
  CHECK(result["playMode"] == "Over");
  CHECK(result["status"]["bout"] == 2);
}
