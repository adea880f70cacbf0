#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "process.h"
#include "temporary_folder.h"
#include "test_support.h"

using namespace spark::test;
using Json = nlohmann::json;
using Catch::Contains;

namespace {

/// A short match of the league of 2004 with agents in C that the host starts.
struct OldMatch {
  TemporaryFolder folder;
  std::vector<std::string> arguments;
  std::string red = "Red", blue = "Blue", timer = "fixed 3";
  int players = 4, seconds = 20;

  Finished play() {
    std::string xml = "<agentdb>";
    for (const auto& [type, line] : {std::pair{"red", red}, std::pair{"blue", blue}})
      xml += "<agent_type_external name='" + std::string(type) + "'><timer>" + timer + "</timer><working_dir>" +
             binFolder().string() + "</working_dir><exec_line>spades-agent " + line +
             "</exec_line></agent_type_external>";
    return runToEnd(joined({program("sparkhost"),
                            "--config",
                            "soccer-2004.lua",
                            "--set",
                            "agents=red blue",
                            "--set",
                            "players=" + std::to_string(players),
                            "--set",
                            "agentDatabase=" + folder.write("agentdb.xml", xml + "</agentdb>"),
                            "--rate",
                            "max",
                            "--duration",
                            std::to_string(seconds),
                            "--seed",
                            "3",
                            "--set",
                            "web=false",
                            "--monitor-port",
                            "0",
                            "--log-level",
                            "warning"},
                           arguments));
  }
  Json result() {
    const Finished f = play();
    CAPTURE(f.errors);
    REQUIRE(f.code == 0);
    return Json::parse(f.out.substr(f.out.find('\n') + 1));
  }
};

}  // namespace

TEST_CASE("A match of the league of 2004 with agents of its time is repeatable, and its recording simulates again") {
  OldMatch m;
  m.arguments = {"--record", m.folder.file("match.mcap")};
  const Json first = m.result();
  REQUIRE(first["agentsSeen"] == 8);
  REQUIRE(first["simSeconds"] == Approx(20));
  REQUIRE(first["faults"] == 0);
  const Finished again = runToEnd({program("sparkreplay"), m.folder.file("match.mcap"), "--verify"});
  CAPTURE(again.errors);
  REQUIRE(again.code == 0);
  REQUIRE(Json::parse(again.out)["differs"].is_null());
  m.arguments.clear();
  const Json second = m.result();
  REQUIRE(second["stateHash"] == first["stateHash"]);
  m.timer = "fixed 12";
  REQUIRE(m.result()["stateHash"] != first["stateHash"]);
}

TEST_CASE("An agent that hangs in a match of 2004 is lost alone, at the same step each time") {
  OldMatch m;
  m.seconds = 4;
  m.blue = "Blue hang 5";
  m.arguments = {"--set", "/sys/server/spades.mostThought=0.3"};
  const Finished f = m.play();
  REQUIRE(f.code == 0);
  CHECK_THAT(f.errors, Contains("agent 4 (blue) is lost at step ") && Contains("it thinks for more than 0.3 s"));
  const Json first = Json::parse(f.out.substr(f.out.find('\n') + 1));
  REQUIRE(first["agentsSeen"] == 8);
  REQUIRE(m.result()["stateHash"] == first["stateHash"]);
}
