#pragma once
/// \file
/// Shared by tests of recordings: a match that is recorded, and its simulation again.

#include <catch2/catch.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "client.h"
#include "process.h"
#include "temporary_folder.h"
#include "test_support.h"

namespace spark::test {

using Json = nlohmann::json;

/// Waits until a host has simulated at least `cycle` cycles.
inline void waitForCycle(const Process& host, std::int64_t cycle) {
  for (std::int64_t now = 0; now < cycle;) {
    const Finished f = runToEnd(joined(sparkctl(host.pid()), {"get", "/sys/server/simulation.cycle"}));
    REQUIRE(f.code == 0);
    now = std::stoll(f.out.substr(f.out.find("= ") + 2));
  }
}

/// A host that records, with two teams.
struct Recorded {
  TemporaryFolder folder;
  std::string file = folder.path() / "match.mcap";
  std::unique_ptr<Process> host, red, blue;
  Json ports;

  Recorded(const std::string& config, const std::string& team, int players, const std::vector<std::string>& arguments) {
    host = std::make_unique<Process>(joined(
        {program("sparkhost"), "--config", config, "--seed", "7", "--expect", std::to_string(2 * players),
         "--agent-port", "0", "--monitor-port", "0", "--web-port", "0", "--log-level", "error", "--record", file},
        arguments));
    ports = Json::parse(host->line());
    for (const auto& [name, process] : {std::pair{"Red", &red}, std::pair{"Blue", &blue}})
      *process = std::make_unique<Process>(std::vector<std::string>{
          program(team), "--team", name, "--port", ports["agentPort"].dump(), "--players", std::to_string(players)});
  }
  void until(std::int64_t cycle) { waitForCycle(*host, cycle); }
  Json end() {
    Json result = Json::parse(host->line());
    REQUIRE(host->wait() == 0);
    return result;
  }
};

/// The line and the exit code of sparkreplay --verify.
inline std::pair<Json, int> verify(const std::string& file) {
  const Finished f = runToEnd({program("sparkreplay"), file, "--verify"});
  INFO(f.errors);
  REQUIRE(!f.out.empty());
  return {Json::parse(f.out), f.code};
}

inline const std::vector<std::string> kLockstep{"--sync", "--rate", "max"};

}  // namespace spark::test
