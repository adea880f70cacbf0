#include <catch2/catch.hpp>
#include <csignal>
#include <memory>
#include <nlohmann/json.hpp>

#include "process.h"
#include "test_support.h"

using namespace spark::test;
using Catch::Contains;
using Json = nlohmann::json;

namespace {

std::unique_ptr<Process> startHost(const std::vector<std::string>& more) {
  std::vector<std::string> command{program("sparkhost"),
                                   "--config",
                                   "soccer.lua",
                                   "--agent-port",
                                   "0",
                                   "--monitor-port",
                                   "0",
                                   "--set",
                                   "Soccer.AutomaticKickOff=true",
                                   "--set",
                                   "Soccer.WaitBeforeKickOff=2"};
  return std::make_unique<Process>(joined(joined(command, withoutLimits()), more));
}

std::unique_ptr<Process> startTeam(const char* name, const Json& ports, int players) {
  return std::make_unique<Process>(std::vector<std::string>{program("humanoid-team"), "--team", name, "--port",
                                                            std::to_string(ports["agentPort"].get<int>()), "--players",
                                                            std::to_string(players)});
}
}  // namespace

TEST_CASE("Twenty-two humanoids play a short match in lockstep to its end without a warning in the log") {
  const auto server = startHost({"--sync", "--rate", "max", "--expect", "22", "--seed", "7", "--log-level", "warning",
                                 "--set", "Soccer.RuleHalfTime=20", "--duration", "52"});
  const Json ports = Json::parse(server->line());
  const auto red = startTeam("Red", ports, 11), blue = startTeam("Blue", ports, 11);
  const Json result = Json::parse(server->line());
  CAPTURE(server->errors(), red->errors(), blue->errors());
  REQUIRE(server->wait() == 0);
  REQUIRE(red->wait() == 0);
  REQUIRE(blue->wait() == 0);
  REQUIRE(result["playMode"] == "GameOver");
  REQUIRE(result["agentsSeen"] == 22);
  REQUIRE(result["messagesDropped"] == 0);
  REQUIRE(server->errors().empty());
  REQUIRE_THAT(red->errors(), Contains("GameOver"));
}

TEST_CASE("A match of a humanoid team is repeatable") {
  const auto play = [] {
    const auto server = startHost(
        {"--sync", "--rate", "max", "--expect", "6", "--seed", "3", "--log-level", "error", "--duration", "15"});
    const Json ports = Json::parse(server->line());
    const auto red = startTeam("Red", ports, 3), blue = startTeam("Blue", ports, 3);
    return Json::parse(server->line())["stateHash"].get<std::string>();
  };
  REQUIRE(play() == play());
}

TEST_CASE("In real time the status line reports whether the cycle time was kept") {
  const auto server = startHost({"--rate", "real", "--log-level", "info"});
  const Json ports = Json::parse(server->line());
  const auto red = startTeam("Red", ports, 2);
  server->waitForError("x real time, ");
  server->signal(SIGTERM);
  const Json result = Json::parse(server->line());
  REQUIRE(server->wait() == 0);
  const bool late = result["lateCycles"] > 0;
  REQUIRE(late == (result["lostSeconds"].get<double>() > 0));
  const std::string said = server->errors();
  const bool held = said.find("x real time, on time") != std::string::npos,
             lost = said.find("late cycles") != std::string::npos;
  REQUIRE((held || lost));
  if (lost) REQUIRE(late);
}
