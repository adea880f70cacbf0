// Remote nodes: a rule in a process of its own judges a match.
#include <catch2/catch.hpp>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>

#include "absence.h"
#include "recorded.h"

using namespace spark::test;
using Catch::Contains;

namespace {
constexpr const char* kToken = "a-long-secret-word";

std::vector<std::string> match(const std::string& clock, const std::vector<std::string>& more) {
  return joined({program("sparkhost"), "--config", "soccer-sphere.lua", "--seed", "7", "--rate", "max", "--agent-port",
                 "0", "--monitor-port", "0", "--web-port", "0", "--set", "team=Red Blue", "--set", "players=4", "--set",
                 "shotClock=" + clock},
                more);
}

/// A match whose referee is in another process.
struct Refereed {
  Process host;
  std::string address;
  Process referee;

  explicit Refereed(const std::vector<std::string>& more)
      : host(match("elsewhere", joined({"--set", "remoteAddress=127.0.0.1:0", "--set",
                                        std::string("remoteToken=") + kToken, "--set", "remoteExpect=1"},
                                       more))),
        address(listening()),
        referee({program("sparkhost"), "--config", "referee.lua", "--set", "match=" + address, "--set",
                 std::string("token=") + kToken}) {}
  std::string listening() {
    const std::string said = "mount this one at ";
    host.waitForError(said);
    const std::string all = host.errors();
    const std::size_t from = all.find(said) + said.size();
    return all.substr(from, all.find_first_of("#\n", from) - from);
  }
  Json end() {
    host.line();  // the ports
    Json result = Json::parse(host.line());
    REQUIRE(host.wait() == 0);
    return result;
  }
};
}  // namespace

TEST_CASE("A rule in another process judges a match as the same rule inside, to the last bit") {
  TemporaryFolder folder;
  const std::string file = folder.path() / "match.mcap";
  const std::vector<std::string> length{"--duration", "40"};
  Process inside(match("here", length));
  inside.line();
  const Json here = Json::parse(inside.line());
  REQUIRE(inside.wait() == 0);
  REQUIRE(count(inside.errors(), "shot clock: ") >= 1);

  Refereed elsewhere(joined(length, {"--record", file}));
  const Json there = elsewhere.end();
  CHECK(elsewhere.referee.wait() == 0);
  CHECK(there["stateHash"] == here["stateHash"]);
  CHECK(there["cycles"] == here["cycles"]);
  CHECK(count(elsewhere.referee.errors(), "shot clock: ") == count(inside.errors(), "shot clock: "));

  // Command lines are in recordings as they are, secrets are not. (What is said at the port: remote's own tests.)
  const std::string texts = textsOf(file);
  CHECK_THAT(texts, Contains("shotClock=elsewhere"));
  CHECK(lacks(texts, kToken, textsWith(kToken, false)));
  // The recording holds what the referee did: the same match is simulated again without it.
  const Finished again = runToEnd({program("sparkreplay"), file, "--verify"});
  CHECK(again.code == 0);
  CHECK(Json::parse(again.out)["differs"].is_null());
}

TEST_CASE("A referee that is killed costs the match one event and one line") {
  TemporaryFolder folder;
  std::ofstream(folder.path() / "match.lua") << R"(
include "soccer-sphere.lua"
get("/sys/server/remote"):on("remoteLost", function(self, event) print("lost " .. event.data[1]) end)
)";
  Refereed match({"--config", folder.path() / "match.lua"});
  match.host.waitForError("referee (127.0.0.1");
  match.referee.signal(SIGKILL);
  match.host.waitForError("lost referee");
  match.host.signal(SIGTERM);
  match.end();
  CHECK(count(match.host.errors(), "lost referee") == 1);
  CHECK(count(match.host.errors(), "remote host referee") == 2);  // it came, and it went
  CHECK_THAT(match.host.errors(), Contains("is gone: the connection ended"));
  match.referee.wait();
}
