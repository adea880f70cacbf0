#include <catch2/catch.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "client.h"
#include "process.h"
#include "test_support.h"

// As many monitors as the audience of a tournament may open, and one that never reads.

using namespace spark::test;

TEST_CASE("A hundred monitors get their messages during a match although one monitor never reads") {
  Process host({(binFolder() / "sparkhost").string(), "--config", "soccer-sphere.lua", "--set", "team=Red Blue",
                "--set", "players=4", "--rate", "max", "--agent-port", "0", "--monitor-port", "0", "--log-level",
                "warning", "--set", "/sys/host/watchdog.after=0"});
  const auto port = nlohmann::json::parse(host.line())["monitorPort"].get<unsigned short>();
  Client deaf(port);
  std::vector<std::unique_ptr<Client>> crowd;
  for (int i = 0; i < 100; ++i) crowd.push_back(std::make_unique<Client>(port));
  double last = 0;
  for (int round = 0; last < 1; ++round)
    for (auto& monitor : crowd) {
      const std::string message = monitor->receive();
      REQUIRE((message.find(")(RSG 0 1)(") != std::string::npos) >= (round == 0));  // the first one is the full scene
      const std::size_t at = message.find("(time ");
      REQUIRE(at != std::string::npos);
      last = std::max(last, std::stod(message.substr(at + 6)));
    }
  crowd.front()->send("(killsim)");
  host.line();
  CHECK(host.wait() == 0);
  // How far the match goes until then differs from machine to machine; that two players want the ball is no matter
  // here.
  std::istringstream log(host.errors());
  for (std::string line; std::getline(log, line);) CHECK_THAT(line, Catch::Contains("kick: expected the ball"));
}
