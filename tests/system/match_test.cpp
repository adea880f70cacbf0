#include <catch2/catch.hpp>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "client.h"
#include "process.h"
#include "temporary_folder.h"
#include "test_support.h"

using namespace spark::test;
using Json = nlohmann::json;
using Catch::Contains;

namespace {

/// A short match of two teams over TCP in lockstep.
struct Match {
  std::string config = "soccer-sphere.lua";
  int players = 3, seed = 7;
  double seconds = 12;
  bool blueFirst = false;
  std::string redParser = "SexpParser", blueParser = "SexpParser";
  std::string socket;  ///< Unix socket of the agents; "": TCP
  std::string framing = "length";
  std::string bluePort;  ///< name of the port node that Blue connects to; "" is the first
  std::vector<std::string> arguments;

  std::unique_ptr<Process> start(Json& ports) const {
    std::vector<std::string> command{program("sparkhost"),
                                     "--config",
                                     config,
                                     "--seed",
                                     std::to_string(seed),
                                     "--sync",
                                     "--rate",
                                     "max",
                                     "--expect",
                                     std::to_string(2 * players),
                                     "--duration",
                                     std::to_string(seconds),
                                     "--monitor-port",
                                     "0",
                                     "--log-level",
                                     "warning"};
    command = joined(command, socket.empty() ? std::vector<std::string>{"--agent-port", "0"}
                                             : std::vector<std::string>{"--set", "agentSocket=" + socket});
    auto host = std::make_unique<Process>(joined(joined(command, withoutLimits()), arguments));
    ports = Json::parse(host->line());
    return host;
  }
  std::unique_ptr<Process> team(const char* name, const std::string& port, const std::string& parser) const {
    std::vector<std::string> command{program("sphere-team"),
                                     "--team",
                                     name,
                                     "--players",
                                     std::to_string(players),
                                     "--parser",
                                     parser,
                                     "--framing",
                                     framing};
    command = joined(command, {socket.empty() ? "--port" : "--socket", port});
    if (blueFirst) command.push_back("--reverse");
    return std::make_unique<Process>(command);
  }
  Json play() const {
    Json ports;
    const auto host = start(ports);
    const std::string port =
        socket.empty() ? std::to_string(ports["agentPort"].get<int>()) : ports["agentSocket"].get<std::string>();
    const std::string other = bluePort.empty() ? port : portOf(*host, bluePort);
    std::unique_ptr<Process> red, blue;
    if (blueFirst) blue = team("Blue", other, blueParser);
    red = team("Red", port, redParser);
    if (!blueFirst) blue = team("Blue", other, blueParser);
    const Json result = Json::parse(host->line());
    REQUIRE(host->wait() == 0);
    CAPTURE(host->errors(), red->errors(), blue->errors());
    REQUIRE(red->wait() == 0);
    REQUIRE(blue->wait() == 0);
    REQUIRE(result["agentsSeen"] == 2 * players);
    REQUIRE(result["simSeconds"] == Approx(seconds));
    return result;
  }
  std::string hash() const { return play()["stateHash"]; }

 private:
  static std::string portOf(Process& host, const std::string& name) {
    const Finished f = runToEnd(joined(sparkctl(host.pid()), {"get", "/sys/server/net/" + name + ".port"}));
    const std::size_t at = f.out.find("= ");
    REQUIRE(at != std::string::npos);
    return f.out.substr(at + 2, f.out.find('\n') - at - 2);
  }
};

/// The state hash in which every match with the same seed must end.
const std::string& referenceHash() {
  static const std::string hash = Match().hash();
  return hash;
}
}  // namespace

TEST_CASE("Two runs with one seed end in the same state, and another seed ends in another") {
  REQUIRE(Match().hash() == referenceHash());
  Match other;
  other.seed = 8;
  REQUIRE(other.hash() != referenceHash());
}

TEST_CASE("The order in which agents connect does not matter") {
  Match m;
  m.blueFirst = true;
  REQUIRE(m.hash() == referenceHash());
}

TEST_CASE("The number of host threads does not matter") {
  Match m;
  m.arguments = {"--set", "/sys/server/simulation.threads=4"};
  REQUIRE(m.hash() == referenceHash());
}

TEST_CASE("The order in which plugins are loaded does not matter") {
  TemporaryFolder folder;
  Match m;
  m.config = folder.write("backwards.lua", R"(
for _, name in ipairs{ "sphere-team", "soccer", "simulation", "sensors", "scene-rsg", "scene", "physics-ode", "physics", "parser-sexp", "parser-json",
                       "net-tcp", "monitor-sexp", "monitor-json", "monitor", "gamecontrol", "files", "effectors", "control" } do plugin(name) end
include "soccer-sphere.lua"
)");
  REQUIRE(m.hash() == referenceHash());
}

TEST_CASE("Teams that speak JSON play the same match") {
  Match m;
  m.arguments = {"--set", "parser=JsonParser"};
  m.redParser = m.blueParser = "JsonParser";
  REQUIRE(m.hash() == referenceHash());
}

TEST_CASE("Two ports use two message formats at the same time") {
  TemporaryFolder folder;
  Match m;
  m.config = folder.write("two-ports.lua", "include \"soccer-sphere.lua\"\nagentPort(\"json\", 0, \"JsonParser\")\n");
  m.bluePort = "json";
  m.blueParser = "JsonParser";
  REQUIRE(m.hash() == referenceHash());
}

TEST_CASE("A match over a Unix socket, or with a message per line, is the same match") {
  TemporaryFolder folder;
  Match m;
  SECTION("Unix socket") { m.socket = folder.file("agents.sock"); }
  SECTION("lines") {
    m.framing = "line";
    m.arguments = {"--set", "agentFraming=LineFraming"};
  }
  SECTION("both, in JSON") {
    m.socket = folder.file("agents.sock");
    m.framing = "line";
    m.arguments = {"--set", "agentFraming=LineFraming", "--set", "parser=JsonParser"};
    m.redParser = m.blueParser = "JsonParser";
  }
  REQUIRE(m.hash() == referenceHash());
  REQUIRE_FALSE(std::filesystem::exists(folder.file("agents.sock")));
}

TEST_CASE("Monitors receive JSON if the config selects it") {
  for (const bool json : {true, false}) {
    Match m;
    m.players = 1;
    if (json) m.arguments = {"--set", "monitor=JsonMonitor"};
    Json ports;
    const auto host = m.start(ports);
    Client monitor(ports["monitorPort"].get<unsigned short>());
    const std::string port = std::to_string(ports["agentPort"].get<int>());
    const auto red = m.team("Red", port, "SexpParser"), blue = m.team("Blue", port, "SexpParser");
    const std::string message = monitor.receive();
    CAPTURE(message.substr(0, 200));
    REQUIRE(Json::accept(message) == json);
    REQUIRE_THAT(message, Contains("FieldLength"));
    REQUIRE(Json::parse(host->line())["agentsSeen"] == 2);
  }
}

TEST_CASE("A match of behaviors inside the host is repeatable, with its goals") {
  const auto play = [] {
    const Finished f = runToEnd({program("sparkhost"), "--config", "soccer-sphere.lua", "--set", "team=Red Blue",
                                 "--set", "players=4", "--rate", "max", "--duration", "20", "--seed", "3",
                                 "--agent-port", "0", "--monitor-port", "0", "--log-level", "warning"});
    REQUIRE(f.code == 0);
    return Json::parse(f.out.substr(f.out.find('\n') + 1));
  };
  const Json a = play(), b = play();
  REQUIRE(a["agentsSeen"] == 8);
  REQUIRE(a["stateHash"] == b["stateHash"]);
  REQUIRE(a["score"] == b["score"]);
}
