// One seed is one match: a minute of two teams over TCP, run in several ways, has the same hashes from start to end.
// `tools/accept reproducible` takes all ways, ten minutes, and other compilers.
#include <catch2/catch.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <thread>

#include "client.h"
#include "process.h"
#include "temporary_folder.h"
#include "test_support.h"

using namespace spark::test;
using Json = nlohmann::json;

namespace {

/// How a match is run. The defaults are the plainest way.
struct Way {
  int threads = 1;
  bool backwards = false;  ///< plugins are loaded in another order, Blue connects first, the last player first
  bool watched = false;    ///< by a monitor and a browser
  bool busy = false;       ///< beside a busy thread
};

/// The hashes of a match.
struct Hashes {
  std::vector<std::string> states;       ///< "cycle hash" each
  std::set<std::string> configurations;  ///< all that occurred
};

/// A busy thread, as long as it lives.
struct Busy {
  std::jthread thread{[](const std::stop_token& stop) {
    while (!stop.stop_requested()) continue;
  }};
};

/// A client that reads all it gets.
struct Reader {
  explicit Reader(int port) : client(static_cast<unsigned short>(port)), thread([this] { client.waitForClose(); }) {}
  Client client;
  std::jthread thread;  ///< ends when the host has ended
};

Hashes play(const std::string& league, int players, const std::vector<std::string>& arguments, const Way& way) {
  TemporaryFolder folder;
  std::string config = league + ".lua";
  if (way.backwards)
    config = folder.write("backwards.lua", R"(
for _, name in ipairs{ "soccer", "simulation", "sensors", "scene-rsg", "scene-mjcf", "scene", "physics-articulated", "physics-ode", "physics",
                       "parser-sexp", "parser-json", "net-tcp", "monitor-sexp", "monitor-json", "monitor", "gamecontrol", "files", "effectors",
                       "control" } do plugin(name) end
include ")" + config + "\"\n");
  const std::filesystem::path file = folder.path() / "hashes";
  std::optional<Busy> busy;
  if (way.busy) busy.emplace();
  Hashes out;
  {
    std::vector<std::unique_ptr<Reader>> readers;
    Process host(joined(joined({program("sparkhost"),
                                "--config",
                                config,
                                "--seed",
                                "7",
                                "--sync",
                                "--rate",
                                "max",
                                "--expect",
                                std::to_string(2 * players),
                                "--duration",
                                "60",
                                "--agent-port",
                                "0",
                                "--monitor-port",
                                "0",
                                "--web-port",
                                "0",
                                "--log-level",
                                "warning",
                                "--hashes",
                                file,
                                "--hash-every",
                                "25",
                                "--set",
                                "/sys/server/simulation.threads=" + std::to_string(way.threads)},
                               withoutLimits()),
                        arguments));
    const Json ports = Json::parse(host.line());
    std::unique_ptr<Process> spectator;
    if (way.watched) {
      readers.push_back(std::make_unique<Reader>(ports["monitorPort"].get<int>()));
      const std::string link = ports["web"];
      const auto colon = link.rfind(':');
      spectator = std::make_unique<Process>(std::vector<std::string>{
          program("web-spectators"), "--port", link.substr(colon + 1, link.find('/', colon) - colon - 1)});
    }
    const std::string team = league == "soccer-sphere" ? "sphere-team" : "humanoid-team";
    std::vector<std::unique_ptr<Process>> teams;
    for (const char* name : way.backwards ? std::array{"Blue", "Red"} : std::array{"Red", "Blue"}) {
      std::vector<std::string> command{
          program(team), "--team", name, "--port", ports["agentPort"].dump(), "--players", std::to_string(players)};
      if (way.backwards) command.push_back("--reverse");
      teams.push_back(std::make_unique<Process>(command));
    }
    const Json result = Json::parse(host.line());
    REQUIRE(host.wait() == 0);
    CAPTURE(host.errors());
    REQUIRE(result["agentsSeen"] == 2 * players);
    REQUIRE(result["simSeconds"] == Approx(60));
  }
  std::istringstream lines(textOf(file));
  for (std::string cycle, state, configuration; lines >> cycle >> state >> configuration;) {
    out.states.push_back(cycle + " " + state);
    out.configurations.insert(configuration);
  }
  REQUIRE(out.states.size() == 120);
  return out;
}

const std::vector<std::string> kDense{"--set", "solver=dense", "--set", "/sys/server/physics.exactReplay=false"};
const std::vector<std::string> kExact{"--set", "solver=dense", "--set", "/sys/server/physics.exactReplay=true"};
const std::vector<std::string> kArticulated{"--set", "solver=articulated"};
const std::vector<std::string> kSoonPlaying{"--set", "Soccer.AutomaticKickOff=true", "--set",
                                            "Soccer.WaitBeforeKickOff=2"};

/// Plays in the plainest way and in all these, and compares.
void compare(const std::string& league, int players, const std::vector<std::string>& arguments,
             const std::vector<Way>& ways) {
  const Hashes first = play(league, players, arguments, Way());
  CHECK(first.configurations.size() == 1);
  for (const Way& way : ways) {
    CAPTURE(league, arguments, way.threads, way.backwards, way.watched, way.busy);
    const Hashes other = play(league, players, arguments, way);
    CHECK(other.states == first.states);
    CHECK(other.configurations.size() == 1);
    if (way.threads == 1 && !way.backwards) CHECK(other.configurations == first.configurations);
  }
}
}  // namespace

TEST_CASE("A minute of a sphere match is the same in each way") {
  compare("soccer-sphere", 11, kDense, {{2, true, true, true}, {1, false, true, false}});
  compare("soccer-sphere", 11, kExact, {{4, false, true, false}});
  compare("soccer-sphere", 11, kArticulated, {{2, true, false, false}});
}

TEST_CASE("A minute of a humanoid match is the same in each way") {
  compare("soccer", 2, joined(kSoonPlaying, kDense), {{4, true, false, true}});
  compare("soccer", 2, joined(kSoonPlaying, kExact), {{2, false, true, false}, {1, true, false, false}});
  compare("soccer", 2, joined(kSoonPlaying, kArticulated), {{2, true, true, false}});
}
