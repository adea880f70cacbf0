#include <catch2/catch.hpp>
#include <csignal>
#include <nlohmann/json.hpp>

#include "absence.h"
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
  std::string red = "Red", blue = "Blue", timer = "fixed 3", level = "warning";
  int players = 4, seconds = 20;
  bool tcp = false;  ///< teams of spheres that are made for the plain loop

  /// The agent database as a file.
  std::string database() const {
    std::string xml = "<agentdb>";
    for (const auto& [type, line] : {std::pair{"red", red}, std::pair{"blue", blue}})
      xml += "<agent_type_external name='" + std::string(type) + "'><timer>" + timer + "</timer><working_dir>" +
             binFolder().string() + "</working_dir>" +
             (tcp ? "<protocol>tcp</protocol><exec_line>sphere-team --port {port} --number {number} --robot "
                    "rsg/agent/sphere_2004.rsg --team "
                  : "<exec_line>spades-agent ") +
             line + "</exec_line></agent_type_external>";
    return folder.write("agentdb.xml", xml + "</agentdb>");
  }
  std::vector<std::string> command() const {
    const std::string count = "players=" + std::to_string(players), duration = std::to_string(seconds);
    return joined({program("sparkhost"), "--config", "soccer-2004.lua", "--set", "agents=red blue", "--set", count,
                   "--rate", "max", "--duration", duration, "--seed", "3", "--set", "web=false", "--monitor-port", "0",
                   "--log-level", level},
                  arguments);
  }
  Finished play() const { return runToEnd(joined(command(), {"--set", "agentDatabase=" + database()})); }
  /// The match with the agents under a communication server: its result, and the host's log.
  std::pair<Json, std::string> underServer() const {
    Process host(joined(command(), {"--set", "commPort=0", "--set", "commServers=1"}));
    const std::string port = std::to_string(Json::parse(host.line())["commPort"].get<int>());
    Process server({program("sparkcomm"), "--port", port, "--database", database()});
    const Json result = Json::parse(host.line());
    REQUIRE(host.wait() == 0);
    REQUIRE(server.wait() == 0);
    return {result, host.errors()};
  }
  Json result() {
    const Finished f = play();
    CAPTURE(f.errors);
    REQUIRE(f.code == 0);
    return Json::parse(f.out.substr(f.out.find('\n') + 1));
  }
};

/// The log of a match in which an agent hangs.
const std::string& logWithLoss() {
  static const std::string log = [] {
    OldMatch m;
    m.seconds = 4;
    m.blue = "Blue hang 5";
    m.arguments = {"--set", "/sys/server/spades.mostThought=5"};
    return m.play().errors;
  }();
  return log;
}

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

TEST_CASE("A match of 2004 goes on from its middle: agents are started again and come back to their robots") {
  OldMatch m;
  const std::string file = m.folder.file("match.mcap"), again = m.folder.file("again.mcap");
  m.arguments = {"--record", file};
  m.result();
  const auto verify = [](const std::string& recording, const char* from) {
    const Finished f =
        runToEnd({program("sparkreplay"), recording, "--verify", "--from", from, "--log-level", "error"});
    CAPTURE(f.errors);
    REQUIRE(f.code == 0);
    REQUIRE(Json::parse(f.out)["differs"].is_null());
  };
  std::remove(m.folder.file("agentdb.xml").c_str());  // a recording is simulated again without programs
  verify(file, "10");
  m.database();
  const auto goOn = [&] {
    std::remove(again.c_str());
    return runToEnd({program("sparkhost"), "--from", file, "--at", "10", "--duration", "20", "--record", again, "--set",
                     "agentDatabase=" + m.folder.file("agentdb.xml"), "--log-level", "info"});
  };
  const Finished f = goOn();
  CAPTURE(f.errors);
  REQUIRE(f.code == 0);
  CHECK_THAT(f.errors, Contains("agent 8 (agent 7 (blue)) is back"));
  CHECK(count(f.errors, "is back") == 8);
  CHECK(lacks(f.errors, "is lost", logWithLoss()));
  const Json result = Json::parse(f.out.substr(f.out.find('\n') + 1));
  CHECK(result["agentsSeen"] == 8);
  CHECK(result["simSeconds"] == Approx(20));
  verify(again, "0");
  const Finished twin = goOn();
  CHECK(Json::parse(twin.out.substr(twin.out.find('\n') + 1))["stateHash"] == result["stateHash"]);
}

TEST_CASE("An agent that hangs in a match of 2004 is lost alone, at the same step each time") {
  OldMatch m;
  m.seconds = 4;
  m.blue = "Blue hang 5";
  m.arguments = {"--set", "/sys/server/spades.mostThought=5"};
  const Finished f = m.play();
  REQUIRE(f.code == 0);
  CHECK_THAT(f.errors, Contains("agent 4 (blue) is lost at step ") && Contains("it thinks for more than 5 s"));
  const Json first = Json::parse(f.out.substr(f.out.find('\n') + 1));
  REQUIRE(first["agentsSeen"] == 8);
  REQUIRE(m.result()["stateHash"] == first["stateHash"]);
}

TEST_CASE("Agents of two communication servers play the same match as those of the host") {
  OldMatch m;
  const std::string reference = m.result()["stateHash"];
  m.level = "info";
  m.arguments = {"--set", "commPort=0", "--set", "commServers=2", "--set", "commToken=0123456789abcdef"};
  Process host(m.command());
  const std::string port = std::to_string(Json::parse(host.line())["commPort"].get<int>());
  const auto server = [&](const char* name) {
    return std::vector<std::string>{program("sparkcomm"), "--port", port, "--database",
                                    m.database(),         "--name", name, "--token",
                                    "0123456789abcdef"};
  };
  std::vector<std::string> stranger = server("stranger");
  stranger.back() = "guessed-by-chance";
  const Finished refused = runToEnd(stranger);
  CHECK(refused.code == 1);
  CHECK_THAT(refused.errors, Contains("refused: its token is wrong"));
  Process one(server("one"));
  host.waitForError("Communication server one is there");
  const Finished twin = runToEnd(server("one"));
  CHECK(twin.code == 1);
  CHECK_THAT(twin.errors, Contains("refused: there is a server 'one' already: give this one another --name"));
  Process two(server("two"));
  const Json result = Json::parse(host.line());
  CAPTURE(host.errors(), one.errors(), two.errors());
  REQUIRE(host.wait() == 0);
  REQUIRE(one.wait() == 0);
  REQUIRE(two.wait() == 0);
  REQUIRE(result["agentsSeen"] == 8);
  REQUIRE(result["stateHash"] == reference);
}

TEST_CASE("Teams made for plain TCP play under SPADES, in the host and under a communication server") {
  OldMatch m;
  m.tcp = true;
  m.arguments = {"--set", "createEffector=SceneEffector", "--set", "Soccer.LongNames=false"};
  const Finished f = m.play();
  REQUIRE(f.code == 0);
  CHECK(lacks(f.errors, "is lost", logWithLoss()));
  const Json reference = Json::parse(f.out.substr(f.out.find('\n') + 1));
  REQUIRE(reference["agentsSeen"] == 8);
  REQUIRE(reference["playMode"] == "PlayOn");
  REQUIRE(m.result()["stateHash"] == reference["stateHash"]);
  REQUIRE(m.underServer().first["stateHash"] == reference["stateHash"]);
}

TEST_CASE("Agents of a communication server are not started with think time in instructions, and it says why") {
  OldMatch m;
  m.timer = "default";
  m.seconds = 1;
  m.arguments = {"--set", "thinkTime=InstructionThinkTime"};
  const auto [result, log] = m.underServer();
  CHECK(result["agentsSeen"] == 0);
  CHECK_THAT(log, Contains("no more agents of type 'blue' are started: communication servers measure CPU time, "
                           "not instructions; use CpuThinkTime, or the timer 'jiffies', instead"));
}

TEST_CASE("A communication server that is killed takes its agents with it, and the match goes on") {
  OldMatch m;
  m.seconds = 600;
  m.level = "info";
  m.arguments = {"--set", "commPort=0", "--set", "commServers=2", "--set", "/sys/server/spades.away=0.2"};
  Process host(m.command());
  const std::string port = std::to_string(Json::parse(host.line())["commPort"].get<int>());
  const auto server = [&](const char* name) {
    return std::vector<std::string>{program("sparkcomm"), "--port", port, "--database", m.database(), "--name", name};
  };
  Process one(server("one"));
  Process two(server("two"));
  host.waitForError("8 agents take part");
  two.signal(SIGKILL);
  const Json result = Json::parse(host.line());
  REQUIRE(host.wait() == 0);
  CHECK(result["simSeconds"] == Approx(600));
  CHECK_THAT(host.errors(), Contains("Communication server two is away") && Contains("is away for more than 0.2 s"));
  CHECK(one.wait() == 0);
}
