// Snapshots: sparkctl snapshot, sparkhost --from and sparkreplay --from. A run that goes on has the hashes of one that
// was not interrupted.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "absence.h"
#include "client.h"
#include "process.h"
#include "spark/predicates.h"
#include "temporary_folder.h"
#include "test_support.h"

using namespace spark::test;
using Json = nlohmann::json;
using Catch::Contains;

namespace {

/// Cycles that are compared behind a snapshot; the acceptance takes more.
int cyclesBehind() {
  const char* const n = std::getenv("SPARK_SNAPSHOT_CYCLES");
  return n ? std::stoi(n) : 300;
}

struct World {
  std::string name;
  std::vector<std::string> arguments;
  double until = 2;     ///< s, when the snapshot is taken
  std::string after{};  ///< text of a script that follows the config
};

std::vector<World> worlds() {
  std::vector<World> out;
  for (const std::string solver : {"dense", "articulated"})
    out.push_back({"boxes, " + solver, {"--config", "boxes.lua", "--set", "solver=" + solver}});
  for (const std::string engine : {"BulletEngine", "MujocoEngine"})
    out.push_back({"boxes, " + engine, {"--config", "boxes.lua", "--set", "engine=" + engine}});
  out.push_back({"boxes, exactReplay", {"--config", "boxes.lua", "--set", "/sys/server/physics.exactReplay=true"}});
  // Humanoids that fall: nobody holds them up.
  const std::string falling = R"lua(
include "soccer.lua"
plugin "humanoid-team"
for side, name in ipairs{ "Red", "Blue" } do
  local agent = new("ScriptBehavior", "/usr/agent/" .. name)
  agent:on("start", function(self) self.actions = "(scene rsg/agent/nao/nao_hetero.rsg " .. side .. ")" end)
  agent:on("think", function(self)
    self.actions = string.format("(init (unum %d)(teamname %s))(he1 %f)", side, name, math.random() - 0.5)
  end)
end
)lua";
  for (const std::string solver : {"solver=dense", "solver=articulated", "engine=BulletEngine", "engine=MujocoEngine"})
    out.push_back({"falling humanoids, " + solver, {"--set", solver}, 0.6, falling});
  out.push_back({"falling humanoids, dense without exactReplay",
                 {"--set", "solver=dense", "--set", "exactReplay=false"},
                 0.6,
                 falling});
  out.push_back({"a rolling ball and a free kick half way", {}, 3, R"(
include "soccer-sphere.lua"
get("/sys/server/simulation"):on("rule", function(self, event)
  local rule = get("/sys/server/gamecontrol/GameStateAspect")
  if event.cycle == 5 then rule.playMode = "PlayOn" end
  if event.cycle == 10 then get("/usr/scene/Ball/physics").velocity = { 3, 1, 0 } end
  if event.cycle == 120 then rule.playMode = "free_kick_left" end
end)
)"});
  const std::vector<std::string> teams{
      "--set", "team=Red Blue", "--set", "Soccer.AutomaticKickOff=true", "--set", "Soccer.WaitBeforeKickOff=1"};
  out.push_back(
      {"the spheres' team inside the host", joined({"--config", "soccer-sphere.lua", "--set", "players=3"}, teams), 8});
  out.push_back(
      {"the humanoids' team inside the host", joined({"--config", "soccer.lua", "--set", "players=2"}, teams), 6});
  out.push_back({"wrestlers that a script makes when they join", {"--config", "sumo.lua", "--set", "bouts=0"}, 9});
  out.push_back({"what a script makes and removes", {}, 2, R"(
include "boxes.lua"
state.made = {}
get("/sys/server/simulation"):on("rule", function(self, event)
  if event.cycle % 20 == 0 then
    local thing = get("/usr/scene"):new("Transform", "thing")
    thing:setLocalPos(math.random(), math.random(), 4)
    thing:new("RigidBody", "body"):setSphereTotal(1, 0.2)
    local ball = thing:new("SphereCollider", "ball")
    ball.radius = 0.2
    ball:new("ContactJointHandler", "surface").contactMu = 0.3
    state.made[#state.made + 1] = thing
  end
  if event.cycle % 50 == 0 then delete(table.remove(state.made, 1)) end
  if event.cycle == 90 then get("/usr/scene/world").gravity = { 0, 0.5, -5 } end
end)
)"});
  return out;
}

/// Lines "cycle hash configuration" of a run's file.
std::vector<std::string> linesOf(const std::filesystem::path& file) {
  std::vector<std::string> out;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) out.push_back(line);
  return out;
}

void runHost(const std::vector<std::string>& arguments) {
  const Finished f =
      runToEnd(joined({program("sparkhost"), "--web-port", "0", "--log-level", "error", "--rate", "max"}, arguments));
  INFO(f.errors);
  REQUIRE(f.code == 0);
  CHECK(f.errors.empty());
}

/// The lines of `whole` from the cycle on with which `rest` begins.
std::vector<std::string> tail(const std::vector<std::string>& whole, const std::vector<std::string>& rest) {
  REQUIRE(!rest.empty());
  REQUIRE(rest.size() < whole.size());
  return {whole.end() - static_cast<std::ptrdiff_t>(rest.size()), whole.end()};
}

}  // namespace

TEST_CASE("A run goes on from a state with the hashes of one that was not interrupted") {
  for (const World& world : worlds()) {
    INFO(world.name);
    TemporaryFolder folder;
    std::vector<std::string> build = world.arguments;
    if (!world.after.empty()) build = joined({"--config", folder.write("world.lua", world.after)}, build);
    const std::string end = std::to_string(world.until + 0.02 * cyclesBehind());
    const std::string file = folder.path() / "run.mcap";
    const auto whole = folder.path() / "whole", rest = folder.path() / "rest";
    runHost(joined(build, {"--duration", end, "--hashes", whole}));
    runHost(joined(build, {"--duration", std::to_string(world.until), "--record", file}));
    runHost({"--from", file, "--duration", end, "--hashes", rest});
    const auto lines = linesOf(rest);
    CHECK(lines.size() == static_cast<std::size_t>(cyclesBehind()));
    CHECK(tail(linesOf(whole), lines) == lines);
  }
}

TEST_CASE("sparkctl writes a snapshot of a running simulation, from which another one goes on, again and again") {
  TemporaryFolder folder;
  const auto hashes = folder.path() / "hashes", first = folder.path() / "first", second = folder.path() / "second";
  const std::string file = folder.path() / "a.mcap", again = folder.path() / "b.mcap";
  Process running({program("sparkhost"), "--config", "soccer-sphere.lua", "--set", "team=Red Blue", "--set",
                   "players=2", "--agent-port", "0", "--monitor-port", "0", "--web-port", "0", "--log-level", "error",
                   "--hashes", hashes});
  running.line();
  const auto ask = [&](const std::vector<std::string>& what) {
    const Finished f = runToEnd(joined(sparkctl(running.pid()), what));
    INFO(f.errors);
    REQUIRE(f.code == 0);
  };
  ask({"call", "/sys/server/monitor.command", "(playMode PlayOn)"});
  ask({"snapshot", file});
  ask({"set", "/sys/server/simulation.rate", "max"});
  ask({"set", "/sys/server/simulation.duration", "20"});
  running.line();
  REQUIRE(running.wait() == 0);
  runHost({"--from", file, "--duration", "20", "--hashes", first});
  CHECK(tail(linesOf(hashes), linesOf(first)).back().substr(0, 21) == linesOf(first).back().substr(0, 21));
  // The file of a run that went on itself.
  runHost({"--from", file, "--duration", "10", "--record", again});
  runHost({"--from", again, "--duration", "20", "--hashes", second});
  CHECK(tail(linesOf(first), linesOf(second)) == linesOf(second));
}

TEST_CASE("A match over the network goes on from its states, with the recorded messages") {
  TemporaryFolder folder;
  const std::string file = folder.path() / "match.mcap";
  Process running(joined({program("sparkhost"),
                          "--config",
                          "soccer-sphere.lua",
                          "--seed",
                          "7",
                          "--expect",
                          "6",
                          "--agent-port",
                          "0",
                          "--monitor-port",
                          "0",
                          "--web-port",
                          "0",
                          "--log-level",
                          "error",
                          "--record",
                          file,
                          "--sync",
                          "--rate",
                          "max",
                          "--duration",
                          "25"},
                         withoutLimits()));
  const Json ports = Json::parse(running.line());
  std::vector<std::unique_ptr<Process>> teams;
  for (const char* name : {"Red", "Blue"})
    teams.push_back(std::make_unique<Process>(std::vector<std::string>{program("sphere-team"), "--team", name, "--port",
                                                                       ports["agentPort"].dump(), "--players", "3"}));
  running.line();
  REQUIRE(running.wait() == 0);
  for (const auto& [from, cycles] : {std::pair{"12", 750}, {"20", 250}}) {
    const Finished f = runToEnd({program("sparkreplay"), file, "--verify", "--from", from, "--log-level", "error"});
    INFO(f.errors);
    CHECK(f.code == 0);
    const Json line = Json::parse(f.out);
    CHECK(line["cycles"] == cycles);
    CHECK(line["differs"].is_null());
  }
}

TEST_CASE("Agents come back to their robots in a match that goes on") {
  TemporaryFolder folder;
  const std::string file = folder.path() / "match.mcap";
  const std::vector<std::string> ports{"--agent-port", "0", "--monitor-port", "0",
                                       "--web-port",   "0", "--log-level",    "info"};
  const auto play = [&](Process& host, const std::string& extra) {
    const Json line = Json::parse(host.line());
    const auto port = static_cast<unsigned short>(line["agentPort"].get<int>());
    Client one(port), two(port);
    // In another order than their numbers.
    for (auto& [client, unum] : {std::pair<Client*, int>{&two, 7}, {&one, 3}}) {
      client->send("(scene rsg/agent/sphere.rsg)");
      client->send(fmt::format("(init (unum {})(teamname Red))(syn)", unum));
    }
    for (int i = 0; i < 60; ++i)
      for (Client* client : {&one, &two}) {
        client->receive();
        client->send("(drive 20 0 0)(syn)" + (i == 0 ? extra : ""));
      }
    host.signal(SIGTERM);
    const Json result = Json::parse(host.line());
    REQUIRE(host.wait() == 0);
    return result;
  };
  Process first(joined({program("sparkhost"), "--config", "soccer-sphere.lua", "--expect", "2", "--sync", "--rate",
                        "max", "--record", file},
                       joined(ports, withoutLimits())));
  const Json before = play(first, "(fly)");
  const std::string again = folder.path() / "again.mcap";
  Process second(joined({program("sparkhost"), "--from", file, "--record", again}, ports));
  const Json after = play(second, "");
  CHECK(after["agentsSeen"] == 2);
  CHECK(after["cycles"].get<int>() > before["cycles"].get<int>() + 50);
  CHECK_THAT(second.errors(), Contains("is back"));
  for (const char* word : {"joins", "warning"}) CHECK(lacks(second.errors(), word, first.errors()));
  // Connections of the second run are numbered as those of the first: they are others.
  const Finished verified = runToEnd({program("sparkreplay"), again, "--verify", "--log-level", "error"});
  INFO(verified.errors);
  CHECK(verified.code == 0);
  CHECK(Json::parse(verified.out)["differs"].is_null());
}

TEST_CASE("In a full game whose players have no names, clients go on as those who were there, in their order") {
  TemporaryFolder folder;
  const std::string file = folder.path() / "sumo.mcap", again = folder.path() / "again.mcap";
  const auto fight = [&](const std::vector<std::string>& arguments) {
    Process host(joined(joined({program("sparkhost")}, arguments),
                        {"--agent-port", "0", "--monitor-port", "0", "--web-port", "0"}));
    const auto port = static_cast<unsigned short>(Json::parse(host.line())["agentPort"].get<int>());
    Client one(port), two(port);
    for (int i = 0; i < 30; ++i)
      for (Client* client : {&one, &two}) {
        client->send("(push 0.5 0.1)(syn)");
        if (i > 0) client->receive();
      }
    host.signal(SIGTERM);
    host.line();
    REQUIRE(host.wait() == 0);
    return host.errors();
  };
  const std::string first = fight({"--config", "sumo.lua", "--set", "players=0", "--sync", "--record", file});
  const Finished alone = runToEnd({program("sparkhost"), "--from", file, "--duration", "30", "--rate", "max",
                                   "--agent-port", "0", "--monitor-port", "0", "--web-port", "0"});
  CHECK_THAT(alone.errors, Contains("Nobody plays 2 of the robots: agent 1, agent 2.") && Contains("--expect 2"));
  const std::string log = fight({"--from", file, "--record", again});
  CHECK_THAT(log, Contains("agent 1 (127.0.0.1"));
  CHECK(count(log, "is back") == 2);
  CHECK(lacks(log, "joins", first));
  const Finished verified = runToEnd({program("sparkreplay"), again, "--verify", "--log-level", "error"});
  INFO(verified.errors);
  CHECK(Json::parse(verified.out)["differs"].is_null());
}

TEST_CASE("No file that is read, and nothing but a file, is written over") {
  TemporaryFolder folder;
  const std::string file = folder.path() / "run.mcap", link = folder.path() / "link.mcap";
  runHost({"--config", "boxes.lua", "--duration", "1", "--record", file});
  const std::string bytes = textOf(file);
  std::filesystem::create_symlink(file, link);
  const auto refused = [](const std::vector<std::string>& command, const char* why) {
    const Finished f = runToEnd(command);
    CHECK(f.code == 2);
    CHECK_THAT(f.errors, Contains(why));
  };
  const std::string replay = program("sparkreplay"), host = program("sparkhost");
  refused({replay, file, "--export", link}, "it is the recording that is read");
  refused({host, "--from", file, "--duration", "2", "--record", link}, "it is what the run goes on from");
  refused({host, "--from", file, "--duration", "2", "--hashes", file}, "it is what the run goes on from");
  refused({replay, file, "--export", folder.path() / "none" / "x.log"}, "No such file or directory");
  refused({replay, file, "--export", folder.path() / "t.csv", "--property", "/usr/scene.nothing"},
          "there was no /usr/scene.nothing at any time");
  CHECK(textOf(file) == bytes);

  const std::string live = folder.path() / "live.mcap";
  Process running({host, "--config", "sumo.lua", "--agent-port", "0", "--monitor-port", "0", "--web-port", "0",
                   "--log-level", "error", "--record", live});
  running.line();
  const auto snapshot = [&](const std::string& to) {
    return runToEnd(joined(sparkctl(running.pid()), {"snapshot", to}));
  };
  CHECK_THAT(snapshot(live).errors, Contains("the recording of this run is there"));
  CHECK_THAT(snapshot(folder.path()).errors, Contains("something else than a file is there"));
  CHECK_THAT(snapshot(folder.path() / "none" / "s.mcap").errors, Contains("No such file or directory"));
  CHECK(snapshot(folder.path() / "s.mcap").code == 0);
  running.signal(SIGTERM);
  running.line();
  CHECK(running.wait() == 0);
  CHECK(runToEnd({replay, live, "--verify"}).code == 0);
}

TEST_CASE("A batch branches from a state: the recorded seed goes on as the run did, others go other ways") {
  TemporaryFolder folder;
  const std::string file = folder.path() / "run.mcap", results = folder.path() / "branches.jsonl";
  const std::vector<std::string> match{"--config", "soccer-sphere.lua", "--set", "team=Red Blue", "--set", "players=2"};
  const auto hashes = folder.path() / "hashes";
  runHost(joined(match, {"--duration", "14", "--record", file, "--hashes", hashes}));
  const Finished f =
      runToEnd({program("sparkbatch"), "--from", file, "--at", "10", "--runs", "2", "--seed", "1", "--sweep",
                "/usr/scene/world.gravity={0,0,-9.81},{0,0,-3}", "--duration", "14", "--results", results});
  INFO(f.errors);
  REQUIRE(f.code == 0);
  std::set<std::string> states;
  for (const std::string& line : linesOf(results)) {
    const Json row = Json::parse(line);
    states.insert(row["stateHash"]);
    if (row["run"] == 1) CHECK_THAT(linesOf(hashes).back(), Contains(row["stateHash"].get<std::string>()));
    CHECK(row["cycles"] == 700);
  }
  CHECK(states.size() == 4);
}

TEST_CASE("Parts of a recording are exported: a recording of its own, a table, a monitor log") {
  TemporaryFolder folder;
  const std::string file = folder.path() / "run.mcap", part = folder.path() / "part.mcap",
                    table = folder.path() / "ball.csv", log = folder.path() / "game.log",
                    played = folder.path() / "again.log";
  runHost({"--config", "soccer-sphere.lua", "--set", "team=Red Blue", "--set", "players=2", "--duration", "25", "--set",
           "monitorLog=" + log, "--record", file});
  const auto exported = [&](const std::vector<std::string>& arguments) {
    const Finished f = runToEnd(joined({program("sparkreplay"), file, "--log-level", "error"}, arguments));
    INFO(f.errors);
    REQUIRE(f.code == 0);
    return Json::parse(f.out)["written"].get<int>();
  };
  CHECK(exported({"--export", part, "--from", "12", "--to", "22"}) > 600);
  const Finished again = runToEnd({program("sparkreplay"), part, "--verify"});
  INFO(again.out << again.errors);
  CHECK(again.code == 0);
  CHECK(Json::parse(again.out)["cycles"] == 600);  // from the state at 10 s on

  CHECK(exported({"--export", table, "--from", "12", "--to", "13", "--property", "/usr/scene/Ball.localPos",
                  "--property", "/sys/server/gamecontrol/GameStateAspect.playMode"}) == 51);
  const auto rows = linesOf(table);
  CHECK(rows.at(0) == "time,/usr/scene/Ball.localPos,/sys/server/gamecontrol/GameStateAspect.playMode");
  CHECK(rows.size() == 52);
  CHECK(std::count(rows[1].begin(), rows[1].end(), ',') == 4);

  CHECK(exported({"--export", played}) > 100);
  CHECK(textOf(played) == textOf(log));
  const std::string none = folder.path() / "none.csv", noLog = folder.path() / "none.log";
  const std::pair<std::vector<std::string>, const char*> wrong[] = {
      {{"--export", none, "--property", "ball"}, "expected /path.property for a column, found 'ball'"},
      {{"--export", none}, "a table needs columns: --property /path.property, once for each"},
      {{"--export", noLog, "--property", "/a.b"}, "--property is for tables: --export FILE.csv"},
      {{"--export", none, "--property", "/a.b", "--from", "13", "--to", "12"}, "expected --to not before --from"}};
  for (const auto& [arguments, why] : wrong) {
    const Finished f = runToEnd(joined({program("sparkreplay"), file}, arguments));
    CHECK(f.code == 2);
    CHECK_THAT(f.errors, Contains(why));
  }
  CHECK(fs::exists(table));
  CHECK_FALSE(fs::exists(none));
  CHECK_FALSE(fs::exists(noLog));
}

TEST_CASE("What is no snapshot, or no longer fits, is refused with a reason") {
  TemporaryFolder folder;
  const auto refused = [&](const std::vector<std::string>& arguments) {
    const Finished f = runToEnd(joined({program("sparkhost"), "--log-level", "error"}, arguments));
    CHECK(f.code == 2);
    return f.errors;
  };
  CHECK_THAT(refused({"--from", folder.write("text", "no MCAP at all")}), Contains("text"));
  const std::string file = folder.path() / "run.mcap";
  runHost({"--config", "boxes.lua", "--duration", "1", "--record", file});
  CHECK_THAT(refused({"--from", file, "--at", "-1"}), Contains("has no state up to -1 s"));
  CHECK_THAT(refused({"--from", file, "--config", "boxes.lua"}), Contains("--config"));
  CHECK_THAT(refused({"--from", file, "--set", "scene=rsg/boxspheres/nothing.rsg"}), Contains("nothing.rsg"));
  std::string bytes = textOf(file);
  for (std::size_t i = 0; i < bytes.size(); i += 40) bytes[i] = static_cast<char>(bytes[i] ^ 0x11);
  refused({"--from", folder.write("damaged.mcap", bytes)});
}
