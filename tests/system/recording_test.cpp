// Recordings: sparkhost --record, and sparkreplay --verify, which simulates the same run again.
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "client.h"
#include "mcap.h"
#include "process.h"
#include "temporary_folder.h"
#include "test_support.h"

using namespace spark::test;
using Json = nlohmann::json;
using Catch::Contains;

namespace {

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
  /// Waits until the host has simulated that many cycles.
  void until(std::int64_t cycles) {
    for (std::int64_t cycle = 0; cycle < cycles;) {
      const Finished f = runToEnd(joined(sparkctl(host->pid()), {"get", "/sys/server/simulation.cycle"}));
      REQUIRE(f.code == 0);
      cycle = std::stoll(f.out.substr(f.out.find("= ") + 2));
    }
  }
  Json end() {
    Json result = Json::parse(host->line());
    REQUIRE(host->wait() == 0);
    return result;
  }
};

/// The line and the exit code of sparkreplay --verify.
std::pair<Json, int> verify(const std::string& file) {
  const Finished f = runToEnd({program("sparkreplay"), file, "--verify"});
  INFO(f.errors);
  REQUIRE(!f.out.empty());
  return {Json::parse(f.out), f.code};
}

const std::vector<std::string> kLockstep{"--sync", "--rate", "max"};
}  // namespace

TEST_CASE("A match in lockstep is simulated again from its recording, to the last bit") {
  Recorded match("soccer-sphere.lua", "sphere-team", 3,
                 joined(joined(kLockstep, withoutLimits()), {"--duration", "25"}));
  const Json result = match.end();
  const auto [line, code] = verify(match.file);
  CHECK(code == 0);
  CHECK(line["cycles"] == 1250);
  CHECK(line["states"] == 3);  // at the start, after 10 and 20 s
  CHECK(line["differs"].is_null());
  CHECK(line["lacks"].empty());
  const Json about = Json::parse(runToEnd({program("sparkreplay"), match.file}).out);
  CHECK(about["seconds"] == Approx(25));
  CHECK_THAT(about["files"].dump(), Contains("script:soccer-sphere.lua") && Contains("file:rsg/agent/sphere.rsg"));
}

TEST_CASE("A match in real time with a trainer, sparkctl and a leaving team is simulated again, to the last bit") {
  Recorded match("soccer.lua", "humanoid-team", 1, {"--rate", "real"});
  {
    Client trainer(static_cast<unsigned short>(match.ports["monitorPort"].get<int>()));
    trainer.send("(playMode PlayOn)(ball (pos 1 2 0.5)(vel 1 0 0))");
    const Finished set = runToEnd(joined(sparkctl(match.host->pid()), {"set", "/usr/scene/world.gravity", "{0,0,-5}"}));
    CHECK(set.code == 0);
    match.until(20);
    match.red->signal(SIGKILL);
    match.until(60);
  }
  match.host->signal(SIGTERM);
  const Json result = match.end();
  const auto [line, code] = verify(match.file);
  CHECK(line["cycles"] == result["cycles"]);
  CHECK(line["differs"].is_null());
  CHECK(line["lacks"].empty());
  CHECK(code == 0);
}

TEST_CASE("With MuJoCo in real time a model takes over when it did, in the recording's simulation too") {
  Recorded match("soccer.lua", "humanoid-team", 2,
                 {"--rate", "real", "--set", "engine=MujocoEngine", "--set", "/sys/server/physics/engine.atOnce=0"});
  match.until(100);
  match.host->signal(SIGTERM);
  const Json result = match.end();
  const auto [line, code] = verify(match.file);
  CHECK(line["cycles"] == result["cycles"]);
  CHECK(line["differs"].is_null());
}

TEST_CASE("A host that was killed leaves a recording that can be simulated up to its last chunk") {
  Recorded match("soccer-sphere.lua", "sphere-team", 2, {"--rate", "max", "--sync", "--duration", "100000"});
  while (std::filesystem::file_size(match.file) < 200'000) match.until(100);
  match.host->signal(SIGKILL);
  CHECK(match.host->wait() == 128 + SIGKILL);
  const auto [line, code] = verify(match.file);
  CHECK(code == 0);
  CHECK(line["cycles"] > 0);
  CHECK(line["differs"].is_null());
  REQUIRE(line["lacks"].size() == 1);
  CHECK_THAT(line["lacks"][0].get<std::string>(), Contains("the recording was cut off"));
}

TEST_CASE("A recording with a damaged chunk is simulated up to the damage, which is named") {
  Recorded match("soccer-sphere.lua", "sphere-team", 2,
                 joined(joined(kLockstep, withoutLimits()), {"--duration", "20"}));
  match.end();
  std::string bytes = textOf(match.file);
  const auto chunk = spark::mcap::Reader(match.file).chunks().at(10);
  for (std::size_t i = 0; i < 50; ++i) bytes[chunk.offset + chunk.length / 2 + i] ^= 0x55;
  std::ofstream(match.file, std::ios::binary) << bytes;
  const auto [line, code] = verify(match.file);
  CHECK(code == 0);
  const double before = static_cast<double>(chunk.begin) * 50e-9;  // cycles
  CHECK(before > 1);
  CHECK(std::abs(line["cycles"].get<double>() - before) < 2.5);
  CHECK(line["differs"].is_null());
  REQUIRE(line["lacks"].size() == 1);
  CHECK_THAT(line["lacks"][0].get<std::string>(), Contains("s is damaged: "));
}

TEST_CASE("A disk that is full ends the recording, not the run") {
  const Finished f = runToEnd({program("sparkhost"), "--config", "boxes.lua", "--rate", "max", "--duration", "3",
                               "--web-port", "0", "--record", "/dev/full"});
  CHECK(f.code == 0);
  CHECK_THAT(f.errors, Contains("the recording /dev/full ends") && Contains("No space left on device"));
  CHECK(Json::parse(f.out.substr(f.out.rfind("{\"cycles\"")))["cycles"] == 150);
}

TEST_CASE("A simulation that differs from its recording is named, with cycle, node and property") {
  TemporaryFolder folder;
  const std::string config = folder.write("twin.lua", R"(
include "boxes.lua"
get("/sys/server/simulation"):on("rule", function(self, event)
  state.cycles = event.cycle
  if event.cycle == 30 and get("/sys/host/tape").class == "InputPlayer" then
    get("/usr/scene/world").gravity = { 0, 0, -9 }
  end
end)
)");
  const std::string file = folder.path() / "run.mcap";
  CHECK(runToEnd({program("sparkhost"), "--config", config, "--rate", "max", "--duration", "11", "--web-port", "0",
                  "--log-level", "error", "--record", file})
            .code == 0);
  const auto [line, code] = verify(file);
  CHECK(code == 1);
  CHECK(line["differs"]["cycle"] == 30);
  CHECK_THAT(line["differs"]["what"].get<std::string>(),
             Contains("/usr/scene/world.gravity: {0.0, 0.0, -9.0} against {0.0, 0.0, -9.81}"));
}

TEST_CASE("A recording holds its scripts and scenes, and playing it leaves other files alone") {
  TemporaryFolder folder;
  const std::string config = folder.write("mine.lua", R"(
include "soccer-sphere.lua"
get("/sys/server/simulation"):attachScript("count.lua", { from = 5 })
get("/sys/server/scene"):attachScript("again.lua", { from = 6 })    -- the same text
)");
  const std::string counting =
      "local args = ...\nstate.n = args.from\non('rule', function() state.n = state.n + 1 end)";
  const std::string scripts[] = {folder.write("count.lua", counting), folder.write("again.lua", counting)};
  const std::string file = folder.path() / "run.mcap", log = folder.path() / "game.log";
  CHECK(runToEnd({program("sparkhost"),
                  "--config",
                  config,
                  "--rate",
                  "max",
                  "--duration",
                  "3",
                  "--web-port",
                  "0",
                  "--agent-port",
                  "0",
                  "--monitor-port",
                  "0",
                  "--log-level",
                  "error",
                  "--set",
                  "team=Red Blue",
                  "--set",
                  "monitorLog=" + log,
                  "--record",
                  file})
            .code == 0);
  const std::string written = textOf(log);
  CHECK(written.size() > 1000);
  folder.write("mine.lua", "this is no Lua");
  for (const std::string& script : scripts) std::filesystem::remove(script);
  const auto [line, code] = verify(file);
  CHECK(code == 0);
  CHECK(line["cycles"] == 150);
  CHECK(line["lacks"].empty());
  CHECK(textOf(log) == written);
}

TEST_CASE("A second recording of a run is whole as well") {
  TemporaryFolder folder;
  const std::string second = folder.path() / "second.mcap";
  const std::string config = folder.write("twice.lua", R"(
include "boxes.lua"
get("/sys/server/simulation"):on("act", function(self, event)
  local tape = get "/sys/host/tape"
  if event.cycle == 20 then tape:finish() tape:record(")" + second +
                                                           R"(", { "--config", "twice.lua" }) end
end)
)");
  CHECK(runToEnd({program("sparkhost"), "--config", config, "--rate", "max", "--duration", "1", "--web-port", "0",
                  "--log-level", "error", "--record", folder.path() / "first.mcap"})
            .code == 0);
  const Json about = Json::parse(runToEnd({program("sparkreplay"), second}).out);
  CHECK(about["seconds"] == Approx(1));
  CHECK(about["lacks"].empty());
  CHECK_THAT(about["files"].dump(), Contains("script:boxes.lua"));
}

TEST_CASE("What is no recording, and what cannot be written, is refused") {
  TemporaryFolder folder;
  const Finished none = runToEnd({program("sparkreplay"), folder.write("x.mcap", "nothing")});
  CHECK(none.code == 2);
  CHECK_THAT(none.errors, Contains("is no recording: expected an MCAP file"));
  const Finished f =
      runToEnd({program("sparkhost"), "--config", "boxes.lua", "--record", folder.path() / "no" / "x.mcap"});
  CHECK(f.code == 2);
  CHECK_THAT(f.errors, Contains("cannot write the recording"));
}
