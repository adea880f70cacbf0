#include <catch2/catch.hpp>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>

#include "process.h"
#include "temporary_folder.h"
#include "test_support.h"
#include "web_client.h"

// The web port of the programs, the way users run it.

using namespace spark::test;
using Json = nlohmann::json;
using Catch::Contains;

namespace {
std::vector<std::string> sparkhost(std::vector<std::string> more) {
  std::vector<std::string> c{(binFolder() / "sparkhost").string(), "--agent-port", "0", "--monitor-port", "0"};
  c.insert(c.end(), more.begin(), more.end());
  return c;
}

/// A host whose web server does not disconnect slow clients.
std::vector<std::string> webHost(const std::vector<std::string>& more) {
  return joined(
      sparkhost({"--set", "/sys/server/web.requestTimeout=3600", "--set", "/sys/server/web.stallTimeout=3600"}), more);
}

unsigned short portOf(const Json& firstLine) {
  const std::string link = firstLine["web"];
  REQUIRE_THAT(link, Catch::StartsWith("http://127.0.0.1:") && Catch::EndsWith("/"));
  return static_cast<unsigned short>(std::stoi(link.substr(17)));
}

const std::vector<std::string> kMatch{"--config", "soccer-sphere.lua", "--set",  "team=Red Blue",
                                      "--set",    "players=3",         "--rate", "max"};

/// The last line of a match that lasts until viewers have watched it and their requests are answered.
Json watchedMatch() {
  Process host(webHost(joined(kMatch, {"--web-port", "0"})));
  const unsigned short port = portOf(Json::parse(host.line()));
  WebClient viewer(port), curious(port);
  REQUIRE(viewer.watch() == 101);
  REQUIRE(curious.watch() == 101);
  curious.say(R"({"do":"tree","id":1,"path":"/usr"})");
  curious.say(R"({"do":"watch","id":2,"path":"/usr/scene/Ball","property":"localPos"})");
  curious.say(R"({"do":"contacts","id":3})");
  CHECK_THAT(curious.textWith("\"id\":3"), Contains("\"ok\":true") && Contains("\"contacts\":["));
  curious.textWith("\"watched\"");
  for (int i = 0; i < 5; ++i) viewer.binary();
  host.signal(SIGTERM);
  return Json::parse(host.line());
}

/// The last line of a match of this length [s] without a web server.
Json unwatchedMatch(double seconds) {
  Process host(sparkhost(joined(kMatch, {"--set", "web=false", "--duration", std::to_string(seconds)})));
  CHECK(Json::parse(host.line())["web"].is_null());
  return Json::parse(host.line());
}
}  // namespace

TEST_CASE("A match is identical to the last digit with and without viewers") {
  const Json watched = watchedMatch(), alone = unwatchedMatch(watched["simSeconds"]);
  CHECK(alone["cycles"] == watched["cycles"]);
  CHECK(alone["stateHash"] == watched["stateHash"]);
}

TEST_CASE("A second host reports and uses another port, and serves the page, the status and recorded games") {
  TemporaryFolder folder;
  const std::string game = "((time 0))(RSG 0 1)((nd))\n";
  folder.write("game one.log", game);
  Process first(webHost({"--config", "soccer-sphere.lua", "--web-port", "0"}));
  const unsigned short port = portOf(Json::parse(first.line()));
  Process second(webHost({"--config", "soccer-sphere.lua", "--web-port", std::to_string(port), "--set",
                          "webLogs=" + folder.path().string(), "--set", "team=Red"}));
  const unsigned short other = portOf(Json::parse(second.line()));
  CHECK(other != port);
  second.waitForError("port " + std::to_string(port) + " cannot be had");
  second.waitForError("#token=");

  WebClient client(other);
  CHECK_THAT(client.get("/").body, Contains("Spark"));
  CHECK(client.get("/logs/game%20one.log").body == game);
  CHECK(client.get("/logs/none.log").status == 404);
  // Players inside the host join within its first cycles. Each connection is limited to 200 requests.
  for (;;) {
    const Json status = Json::parse(WebClient::status(other));
    if (status["agents"].size() < 11) continue;
    CHECK(status["agents"][0]["path"] == "/usr/scene/AgentAspect1");
    CHECK(status["score"] == Json({0, 0}));
    break;
  }
}

TEST_CASE("The scene contains the shapes of colliders") {
  Process host(webHost({"--config", "soccer-sphere.lua", "--web-port", "0"}));
  WebClient viewer(portOf(Json::parse(host.line())));
  REQUIRE(viewer.watch() == 101);
  const Json scene = Json::parse(viewer.textWith("\"scene\""));
  bool ball = false;
  for (const Json& node : scene["nodes"]) {
    if (node.value("path", "") != "/usr/scene/Ball") continue;
    ball = true;
    REQUIRE(node["shapes"].size() == 1);
    CHECK(node["shapes"][0] ==
          Json::parse(R"({"kind":"sphere","size":[0.111],"position":[0,0,0],"rotation":[0,0,0,1]})"));
  }
  CHECK(ball);
  CHECK(scene["local"].size() % 16 == 0);
  viewer.binary();
}

TEST_CASE("A weak token is refused at the start, and an invalid address disables the web port") {
  const Finished weak =
      runToEnd(sparkhost({"--config", "soccer-sphere.lua", "--web-port", "0", "--set", "webToken=secret"}));
  CHECK(weak.code == 2);
  CHECK_THAT(weak.errors, Contains("at least 16"));
  const Finished nowhere = runToEnd(sparkhost({"--config", "soccer-sphere.lua", "--web-port", "0", "--set",
                                               "webAddress=nowhere", "--duration", "0.1", "--rate", "max"}));
  CHECK(nowhere.code == 0);
  CHECK(Json::parse(nowhere.out.substr(0, nowhere.out.find('\n')))["web"].is_null());
  CHECK_THAT(nowhere.errors, Contains("Nobody can watch in a browser") && Contains("found 'nowhere'"));
}
