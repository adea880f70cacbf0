// Recordings: sparkhost --record, and sparkreplay --verify, which simulates the same run again.
#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <map>

#include "../../plugins/monitor-web/tests/piece_reader.h"
#include "absence.h"
#include "mcap.h"
#include "recorded.h"

using namespace spark::test;
using Catch::Contains;

TEST_CASE("A match in lockstep is simulated again from its recording, to the last bit") {
  Recorded match("soccer-sphere.lua", "sphere-team", 3,
                 joined(joined(kLockstep, withoutLimits()), {"--duration", "25"}));
  const Json result = match.end();
  const auto [line, code] = verify(match.file);
  CHECK(code == 0);
  CHECK(line["cycles"] == 1250);
  CHECK(line["states"] == 4);  // at the start, after 10 and 20 s, at the end
  CHECK(line["differs"].is_null());
  CHECK(line["lacks"].empty());
  const Json about = Json::parse(runToEnd({program("sparkreplay"), match.file}).out);
  CHECK(about["seconds"] == Approx(25));
  CHECK_THAT(about["files"].dump(), Contains("script:soccer-sphere.lua") && Contains("file:rsg/agent/sphere.rsg"));
}

TEST_CASE("A recording has the requests that came, and a secret among their arguments not") {
  const std::string word = "a-long-secret-word", secret = textsWith(word, true);
  CHECK_THAT(secret, Contains("/usr/remote") && Contains("listen"));
  CHECK(lacks(secret, word, textsWith(word, false)));
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

TEST_CASE("A recording shows browsers, and programs that know /tf, the poses of the simulation") {
  using namespace spark;
  Recorded match("soccer.lua", "humanoid-team", 2,
                 joined(joined(kLockstep, withoutLimits()), {"--duration", "6", "--set", "Soccer.AutomaticKickOff=true",
                                                             "--set", "Soccer.WaitBeforeKickOff=1"}));
  match.end();
  mcap::Reader reader(match.file);
  // Where transforms are, in /tf and in the pieces, by milliseconds and path.
  std::map<std::int64_t, std::map<std::string, Pose>> expected, found;
  struct Scene {
    std::vector<web::Mount> mounts;
    std::vector<std::string> paths;
    std::vector<int> parents;  ///< -1: none
  };
  std::map<std::uint32_t, Scene> scenes;
  for (const auto& chunk : reader.chunks())
    reader.forEach(chunk, [&](const mcap::Message& m) {
      if (m.channel == reader.channelOf("/tf")) {
        std::map<std::string, Pose>& poses = expected[m.time / 1'000'000];
        const Json places = Json::parse(m.data);
        for (const Json& t : places["transforms"]) {
          const Json &p = t["translation"], &q = t["rotation"];
          Pose pose{Vec3(p["x"], p["y"], p["z"]), rotationOf(std::array<double, 4>{q["w"], q["x"], q["y"], q["z"]})};
          if (t["parent_frame_id"] != "world") pose = compose(poses.at(t["parent_frame_id"]), pose);
          poses[t["child_frame_id"]] = pose;
        }
      }
      if (m.channel == reader.channelOf("/monitor/scenes")) {
        const web::test::ReadPiece message(m.data);
        Scene& scene = scenes[message.shape];
        const Json described = Json::parse(message.texts.at(0));
        std::vector<int> numbers;  // of the nodes, among transforms
        for (const Json& node : described["nodes"]) {
          const int parent = node["parent"];
          numbers.push_back(static_cast<int>(scene.mounts.size()));
          if (node["kind"] != "transform") continue;
          web::Mount mount;
          if (node.contains("on")) {
            mount.on = node["on"];
            for (int k = 0; k < 3; ++k) mount.pin[k] = node["pin"][static_cast<std::size_t>(k)];
          }
          scene.mounts.push_back(mount);
          scene.paths.push_back(node["path"]);
          scene.parents.push_back(parent < 0 ? -1 : numbers[static_cast<std::size_t>(parent)]);
        }
      }
      if (m.channel != reader.channelOf("/monitor")) return true;
      const web::test::ReadPiece piece(m.data);
      const Scene& scene = scenes.at(piece.shape);
      web::test::FrameReader frames(scene.mounts.size());
      frames.mounts = scene.mounts;
      for (const std::string& frame : piece.frames) {
        frames.take(frame);
        std::vector<Pose> worlds;
        for (std::size_t i = 0; i < scene.paths.size(); ++i) {
          const int parent = scene.parents[i];
          const Pose local = frames.poseOf(i);
          worlds.push_back(parent < 0 ? local : compose(worlds[static_cast<std::size_t>(parent)], local));
          found[std::llround(frames.time * 1000)][scene.paths[i]] = worlds.back();
        }
      }
      return true;
    });
  int compared = 0, limbs = 0;
  for (const auto& [time, poses] : expected)
    for (const auto& [path, pose] : poses)
      if (const auto frame = found.find(time); frame != found.end() && frame->second.contains(path)) {
        INFO(time << ' ' << path);
        CHECK((frame->second[path].position - pose.position).norm() < 0.005);
        CHECK((frame->second[path].rotation - pose.rotation).cwiseAbs().maxCoeff() < 0.01);
        ++compared;
        limbs += path.ends_with("/rfoot") || path.ends_with("/llowerarm");
      }
  CHECK(compared >= 100);
  CHECK(limbs >= 12);
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
