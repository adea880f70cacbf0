#include <unistd.h>

#include <catch2/catch.hpp>
#include <fstream>

#include "league.h"
#include "roboviz.h"
#include "spark/script_server.h"

// One simulation records a match and another plays it: a monitor of the second must see what the first logged.

using namespace spark;
using namespace spark::test;

namespace {

struct TemporaryFile {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / fmt::format("spark-match-{}-{}.log", ::getpid(), next()++);
  static int& next() {
    static int n = 0;
    return n;
  }
  ~TemporaryFile() { std::filesystem::remove(path); }
};

/// The simulation of logplayer.lua without its network.
struct Cinema : TestHost {
  explicit Cinema(const std::filesystem::path& log) {
    const auto share = pluginFolder().parent_path() / "share" / "spark";
    scripts(kernel).addFolder(share / "lua");
    scripts(kernel).addOverride("file", log.string());
    scripts(kernel).addOverride("/sys/server/net/monitors.port", 0);
    scripts(kernel).runConfig("logplayer.lua");
    setProperty(kernel.root().require<Leaf>("/sys/server/simulation"), "rate", "max");
    connection.emplace(kernel.root().require<Node>("/sys/server/net/monitors"), 1);
    kernel.root().require<IConnectionConsumer>("/sys/server/monitor").connected(*connection);
  }
  void run(int cycles) {
    callMethod(kernel.root().require<Leaf>("/sys/server/simulation"), "runCycles", std::vector<Value>{cycles});
  }
  std::int64_t get(const char* property) {
    return getProperty(kernel.root().require<Leaf>("/sys/server/monitor/player"), property).toInteger();
  }
  std::optional<FakeConnection> connection;
};

/// Records a short match of spheres; returns the lines of the log.
std::vector<std::string> record(const std::filesystem::path& log, const std::string& encoder = "SexpMonitor") {
  TestHost host;
  scripts(host.kernel).addFolder(pluginFolder().parent_path() / "share" / "spark" / "lua");
  scripts(host.kernel)
      .run(fmt::format("host = {{ share = '{}', scenePaths = {{}} }}",
                       (pluginFolder().parent_path() / "share" / "spark").string()),
           "test");
  for (const char* port : {"agents", "monitors"})
    scripts(host.kernel).addOverride(fmt::format("/sys/server/net/{}.port", port), 0);
  scripts(host.kernel).addOverride("team", "Red Blue");
  scripts(host.kernel).addOverride("players", 3);
  scripts(host.kernel).addOverride("monitor", encoder);
  scripts(host.kernel).addOverride("monitorLog", log.string());
  scripts(host.kernel).addOverride("/sys/server/simulation.rate", "max");
  scripts(host.kernel).runConfig("soccer-sphere.lua");
  callMethod(host.kernel.root().require<Leaf>("/sys/server/simulation"), "runCycles", std::vector<Value>{1002});
  std::ifstream in(log);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

bool sameNodes(const std::vector<StrictMonitor::Node>& a, const std::vector<StrictMonitor::Node>& b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](const auto& x, const auto& y) {
           return x.type == y.type && x.matrix == y.matrix && x.mesh == y.mesh && x.materials == y.materials &&
                  x.visible == y.visible && sameNodes(x.children, y.children);
         });
}

}  // namespace

TEST_CASE("A logged match is played to a monitor record by record without losses") {
  const TemporaryFile file, json;
  const std::vector<std::string> lines = record(file.path);
  REQUIRE(lines.size() == 101);
  const bool inJson = GENERATE(false, true);
  if (inJson) REQUIRE(record(json.path, "JsonMonitor").front().starts_with("[["));
  Cinema cinema(inJson ? json.path : file.path);
  REQUIRE(cinema.get("records") == 101);
  StrictMonitor logged, seen;
  cinema.run(2);  // accepts the monitor
  for (std::size_t i = 0; i < lines.size(); ++i) {
    CAPTURE(i);
    logged.read(lines[i]);
    if (i > 0)
      for (int k = 0; k < 10; ++k) {
        if (const std::string message = cinema.connection->read(); !message.empty()) seen.read(message);
        cinema.run(1);
      }
    if (const std::string message = cinema.connection->read(); !message.empty()) seen.read(message);
    REQUIRE(cinema.get("record") == static_cast<std::int64_t>(i));
    REQUIRE(sameNodes(seen.scene, logged.scene));
    REQUIRE(seen.env == logged.env);
    REQUIRE(seen.fouls == logged.fouls);
  }
  CHECK(logged.player(true, 1) == nullptr);  // spheres have no shirts
  CHECK(logged.mesh("soccerball.obj") != nullptr);
  CHECK(logged.fulls > 6);
  CHECK(cinema.get("damaged") == 0);
  CHECK(std::stod(seen.env["time"]) > 10);
}
