#include <catch2/catch.hpp>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "process.h"
#include "temporary_folder.h"
#include "test_support.h"

// Many simulations in one process and in several processes, run the way users run them.

using namespace spark::test;
using Json = nlohmann::json;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

/// A match of two small teams inside the host, and the values that the config reports.
const char* kMatch = R"(
include "soccer-sphere.lua"
results{ pushes = 0 }
get("/usr/agent"):on("act", function() Result.pushes = Result.pushes + math.random(3) end)
)";
const std::vector<std::string> kTwoTeams{"--set",     "team=Red Blue", "--set",
                                         "players=2", "--set",         "Soccer.WaitBeforeKickOff=0.2"};

std::vector<std::string> with(std::vector<std::string> command, const std::vector<std::string>& more) {
  command.insert(command.end(), more.begin(), more.end());
  return command;
}

std::vector<std::string> batch(const std::string& config, const std::string& results,
                               const std::vector<std::string>& more = {}) {
  return with({program("sparkbatch"), "--config", config, "--results", results}, more);
}

std::vector<Json> rowsOf(const std::string& file) {
  std::ifstream in(file);
  std::vector<Json> rows;
  for (std::string line; std::getline(in, line);) rows.push_back(Json::parse(line));
  return rows;
}

/// The rows without wall-clock times.
std::vector<Json> timelessRowsOf(const std::string& file) {
  std::vector<Json> rows = rowsOf(file);
  for (Json& row : rows) row.erase("cpuSeconds"), row.erase("wallSeconds");
  return rows;
}

/// mpirun on one machine, also as root and in a container: it needs no other machine, network or privilege, and more
/// processes than processors are allowed.
std::vector<std::string> mpirun(int processes) {
  setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
  setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
  return {"mpirun", "--mca",           "plm",       "isolated",   "--mca", "pml",
          "ob1",    "--mca",           "btl",       "self,vader", "--mca", "btl_vader_single_copy_mechanism",
          "none",   "--oversubscribe", "--bind-to", "none",       "-n",    std::to_string(processes)};
}
}  // namespace

TEST_CASE("A batch gives the results of sparkhost for each of its runs with any number of threads") {
  TemporaryFolder folder;
  const std::string config = folder.write("match.lua", kMatch);
  const std::vector<std::string> sweep =
      with(kTwoTeams, {"--runs", "2", "--seed", "5", "--duration", "4", "--sweep", "Soccer.RuleHalfTime=1,120",
                       "--report", "goal=/sys/variables/Soccer.GoalWidth"});
  const std::string one = (folder.path() / "one.jsonl").string(), three = (folder.path() / "three.jsonl").string();
  const Finished alone = runToEnd(batch(config, one, with(sweep, {"--threads", "1"})));
  CAPTURE(alone.errors);
  REQUIRE(alone.code == 0);
  const Json summary = Json::parse(alone.out);
  REQUIRE(summary["runs"] == 4);
  REQUIRE(summary["done"] == 4);
  REQUIRE(summary["failed"] == 0);
  REQUIRE(summary["simSeconds"] == 16.0);
  REQUIRE(summary["megabytesPerWorld"].get<double>() > 0);
  REQUIRE(runToEnd(batch(config, three, with(sweep, {"--threads", "3"}))).code == 0);
  const std::vector<Json> rows = timelessRowsOf(one);
  REQUIRE(rows == timelessRowsOf(three));
  REQUIRE(rows.size() == 4);
  REQUIRE(rows[0]["playMode"] == "GameOver");
  REQUIRE(rows[1]["playMode"] != "GameOver");
  for (std::size_t i = 0; i < 4; ++i) {
    const Json& row = rows[i];
    CAPTURE(row.dump());
    REQUIRE(row["run"] == i + 1);
    REQUIRE(row["seed"] == 5 + i / 2);
    REQUIRE(row["Soccer.RuleHalfTime"] == (i % 2 ? 120 : 1));
    REQUIRE(row["end"] == "duration");
    REQUIRE(row["cycles"] == 200);
    REQUIRE(row["goal"] == 7.32);
    REQUIRE(row["pushes"] >= 200);
    const Finished host =
        runToEnd(with({program("sparkhost"), "--config", config, "--rate", "max", "--duration", "4", "--agent-port",
                       "0", "--monitor-port", "0", "--seed", std::to_string(5 + i / 2), "--set",
                       "Soccer.RuleHalfTime=" + std::string(i % 2 ? "120" : "1")},
                      kTwoTeams));
    REQUIRE(Json::parse(host.out.substr(host.out.find('\n') + 1))["stateHash"] == row["stateHash"]);
  }
  REQUIRE(rows[0]["stateHash"] != rows[2]["stateHash"]);
}

TEST_CASE("An error ends only its own run, which is repeated on request") {
  TemporaryFolder folder;
  const std::string config = folder.write("some.lua", R"(
include "house.lua"
files() simulation()
local n = option{ name = "n", default = 1, doc = "3 is wrong." }
if n == 3 then error("n must not be 3") end
if n == 4 then get("/sys/server/simulation"):on("act", function(self, event) if event.cycle == 7 then self:stop() end end) end
)");
  const std::string table = (folder.path() / "some.jsonl").string();
  const std::vector<std::string> more{"--duration", "1", "--sweep", "n=1,2,3,4", "--threads", "2"};
  const Finished f = runToEnd(batch(config, table, more));
  REQUIRE(f.code == 1);
  REQUIRE_THAT(f.errors, Contains("run 3 failed") && Contains("n must not be 3") && Contains("4 of 4 runs"));
  const std::vector<Json> rows = rowsOf(table);
  REQUIRE(rows.size() == 4);
  REQUIRE(rows[2]["end"] == "error");
  REQUIRE_THAT(rows[2]["error"].get<std::string>(), Contains("some.lua:5") && Contains("n must not be 3"));
  REQUIRE(rows[1]["cycles"] == 50);
  REQUIRE(rows[3]["end"] == "stopped");
  REQUIRE(rows[3]["cycles"] == 7);
  const Finished again = runToEnd(batch(config, table, with(more, {"--resume", "--retry"})));
  REQUIRE(again.code == 1);
  REQUIRE(Json::parse(again.out)["done"] == 1);
  REQUIRE(timelessRowsOf(table).size() == 4);
}

TEST_CASE("A rule or script that fails during a run makes its row an error") {
  TemporaryFolder folder;
  const std::string config = folder.write("rule.lua", R"(
include "house.lua"
files() simulation()
local n = option{ name = "n", default = 1, doc = "2 is wrong, and so is 3, once." }
on("rule", function(self, event)
  if n == 2 or n == 3 and event.cycle == 7 then nosuch() end
end)
)");
  for (const char* level : {"error", "off"}) {
    const std::string table = (folder.path() / (std::string(level) + ".jsonl")).string();
    const Finished f = runToEnd(
        batch(config, table, {"--duration", "1", "--sweep", "n=1,2,3", "--threads", "1", "--log-level", level}));
    CAPTURE(level, f.errors);
    CHECK(f.code == 1);
    CHECK(Json::parse(f.out)["failed"] == 2);
    const std::vector<Json> rows = rowsOf(table);
    REQUIRE(rows.size() == 3);
    CHECK(rows[0]["end"] == "duration");
    CHECK_FALSE(rows[0].contains("error"));
    for (const auto& [row, words] : {std::pair{rows[1], "50 faults of plugins or scripts; "},
                                     std::pair{rows[2], "1 fault of plugins or scripts; "}}) {
      CHECK(row["end"] == "error");
      CHECK(row["cycles"] == 50);
      CHECK_THAT(row["error"].get<std::string>(), Contains(words));
      if (std::string(level) == "error")
        CHECK_THAT(row["error"].get<std::string>(),
                   Contains("rule.lua:6: attempt to call a nil value (global 'nosuch')"));
    }
  }
}

TEST_CASE("Errors in the command line or the first simulation are reported before the table is created") {
  TemporaryFolder folder;
  const std::string table = (folder.path() / "t.csv").string();
  const std::string config =
      folder.write("small.lua", "include 'house.lua'\nfiles() simulation()\noption{ name = 'answer', default = 42 }\n");
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrong{
      {batch("no-such.lua", table), "no-such.lua"},
      {batch(config, table, {"--set", "anwser=1"}), "'answer'"},
      {batch(config, table, {"--sweep", "answer"}), "KEY=A,B"},
      {batch(config, table, {"--sweep", "answer=1,2", "--sweep", "answer=3"}), "twice"},
      {batch(config, table, {"--report", "score"}), "/path.property"},
      {batch(config, table, {"--retry"}), "--resume"},
      {batch(config, table, {"--seed", "-1"}),
       "--seed: expected a whole number from 0 to 18446744073709551615 (64 bits), found '-1'"},
      {batch(config, (folder.path() / "t.txt").string()), ".csv or .jsonl"},
      {batch(folder.write("none.lua", "include 'house.lua'\n"), table), "there is no /sys/server/simulation"}};
  for (const auto& [command, text] : wrong) {
    const Finished f = runToEnd(command);
    CAPTURE(f.errors);
    REQUIRE(f.code == 2);
    REQUIRE(f.out.empty());
    REQUIRE_THAT(f.errors, Contains(text));
    REQUIRE_FALSE(fs::exists(table));
  }
}

TEST_CASE("An interrupted batch ends its running simulations, keeps their rows, and resumes where it stopped") {
  TemporaryFolder folder;
  const std::string config = folder.write("match.lua", kMatch);
  const std::string straight = (folder.path() / "straight.jsonl").string(),
                    broken = (folder.path() / "broken.jsonl").string();
  const std::vector<std::string> few = with(kTwoTeams, {"--duration", "4", "--threads", "2", "--runs", "6"});
  REQUIRE(runToEnd(batch(config, straight, few)).code == 0);
  {
    // Every simulation logs its start, so the signal arrives while the first ones run.
    Process p(batch(config, broken, with(few, {"--log-level", "info"})));
    p.waitForError("run 2: ");
    p.signal(SIGINT);
    const Json summary = Json::parse(p.line());
    const int code = p.wait();
    REQUIRE(code == (summary["done"] == 6 ? 0 : 3));
    REQUIRE(rowsOf(broken).size() == summary["done"]);
  }
  std::ofstream(broken, std::ios::app) << "{\"run\":6,\"se";  // as after a power failure
  REQUIRE(rowsOf(straight).size() == 6);
  const Finished rest = runToEnd(batch(config, broken, with(few, {"--resume"})));
  CAPTURE(rest.errors);
  REQUIRE(rest.code == 0);
  REQUIRE(timelessRowsOf(broken) == timelessRowsOf(straight));
  const Finished nothing = runToEnd(batch(config, broken, with(few, {"--resume"})));
  REQUIRE(nothing.code == 0);
  REQUIRE(Json::parse(nothing.out)["done"] == 0);
  const Finished other = runToEnd(batch(config, broken, with(few, {"--resume", "--seed", "9"})));
  REQUIRE(other.code == 2);
  REQUIRE_THAT(other.errors, Contains("first seed is 1, now it would be 9"));
  const Finished again = runToEnd(batch(config, broken, few));
  REQUIRE(again.code == 2);
  REQUIRE_THAT(again.errors, Contains("--resume"));
}

TEST_CASE("A batch is not resumed with anything else than it was begun with, but with more runs") {
  TemporaryFolder folder;
  const std::string config = folder.write("match.lua", kMatch), text = kMatch,
                    other = folder.write("other.lua", text + "\n"), results = folder.file("table.jsonl"),
                    scenes = folder.path().string();
  const std::vector<std::string> begun = with(kTwoTeams, {"--duration", "0.1"});
  REQUIRE(runToEnd(batch(config, results, with(begun, {"--runs", "1"}))).code == 0);
  const auto differs = [&](const std::string& configNow, const std::vector<std::string>& more) {
    const Finished f = runToEnd(batch(configNow, results, with(more, {"--resume", "--runs", "1"})));
    std::smatch words;
    std::regex_search(f.errors, words, std::regex(" is of another batch: its (.*?) is "));
    return f.code == 2 && !words.empty() ? words.str(1) : "not refused: " + f.errors;
  };
  CHECK(differs(other, begun) == "config");
  CHECK(differs(config, with(kTwoTeams, {"--duration", "0.2"})) == "duration");
  CHECK(differs(config, with(begun, {"--seed", "9"})) == "first seed");
  CHECK(differs(config, with(begun, {"--set", "Soccer.GoalWidth=3"})) == "settings");
  CHECK(differs(config, with(begun, {"--sweep", "Soccer.GoalWidth=2,3"})) == "sweep");
  CHECK(differs(config, with(begun, {"--report", "now=/sys/server/simulation.time"})) == "reports");
  CHECK(differs(config, with(begun, {"--scene-path", scenes})) == "scene paths");
  CHECK(differs(config, with(begun, {"--plugin-path", scenes})) == "plugin paths");
  folder.write("match.lua", text + "\n");
  CHECK(differs(config, begun) == "config's text (hash)");
  folder.write("match.lua", text);
  const Finished more = runToEnd(batch(config, results, with(begun, {"--resume", "--runs", "2"})));
  CAPTURE(more.errors);
  CHECK(more.code == 0);
  CHECK(rowsOf(results).size() == 2);
}

TEST_CASE("SIGTERM abandons the running simulations") {
  TemporaryFolder folder;
  const std::string config =
      folder.write("endless.lua", "include 'house.lua'\nfiles() simulation()\nlog.info('begins')\n");
  const std::string table = (folder.path() / "t.csv").string();
  Process p(batch(config, table, {"--threads", "2", "--runs", "4", "--log-level", "info"}));
  p.waitForError("run 2: begins");
  p.signal(SIGTERM);
  REQUIRE(Json::parse(p.line())["done"] == 0);
  REQUIRE(p.wait() == 3);
}

TEST_CASE("A second signal terminates a batch whose config never returns") {
  TemporaryFolder folder;
  const std::string config = folder.write("stuck.lua", "log.info('begins')\nwhile true do end\n");
  Process p(batch(config, (folder.path() / "t.csv").string(), {"--log-level", "info"}));
  p.waitForError("begins");
  const auto gone = [&] {
    std::ostringstream text;
    text << std::ifstream("/proc/" + std::to_string(p.pid()) + "/stat").rdbuf();
    return text.str().find(") Z ") != std::string::npos;
  };
  // Several signals that arrive before the batch checks count as one.
  while (!gone()) p.signal(SIGTERM);
  REQUIRE(p.wait() == 128 + SIGTERM);
}

#ifdef SPARK_MPI
TEST_CASE("Several processes produce the same table as one") {
  TemporaryFolder folder;
  const std::string config = folder.write("match.lua", kMatch);
  const std::string one = (folder.path() / "one.jsonl").string();
  const std::vector<std::string> more = with(kTwoTeams, {"--duration", "2", "--runs", "5", "--threads", "1"});
  REQUIRE(runToEnd(batch(config, one, more)).code == 0);
  for (const int processes : {2, 3}) {
    const std::string many = (folder.path() / ("many" + std::to_string(processes) + ".jsonl")).string();
    const Finished f = runToEnd(with(mpirun(processes), batch(config, many, more)));
    CAPTURE(f.errors, f.out);
    REQUIRE(f.code == 0);
    const Json summary = Json::parse(f.out);
    REQUIRE(summary["processes"] == processes);
    REQUIRE(summary["threads"] == processes);
    REQUIRE(summary["done"] == 5);
    REQUIRE(timelessRowsOf(many) == timelessRowsOf(one));
  }
  const Finished wrong = runToEnd(with(mpirun(2), batch("no-such.lua", (folder.path() / "none.csv").string())));
  REQUIRE(wrong.code == 2);
  REQUIRE_THAT(wrong.errors, Contains("no-such.lua"));
}
#else
TEST_CASE("Without MPI a batch started by mpirun ends with an error message") {
  setenv("OMPI_COMM_WORLD_SIZE", "2", 1);
  const Finished f = runToEnd(batch("boxes.lua", "none.csv"));
  unsetenv("OMPI_COMM_WORLD_SIZE");
  REQUIRE(f.code == 2);
  REQUIRE_THAT(f.errors, Contains("built without MPI"));
}
#endif
