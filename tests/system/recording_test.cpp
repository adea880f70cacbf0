// Recordings: sparkhost --record, and sparkreplay --verify, which simulates the same run again.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "../../plugins/monitor-web/tests/piece_reader.h"
#include "client.h"
#include "input_codec.h"
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
  CHECK(line["states"] == 4);  // at the start, after 10 and 20 s, at the end
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

TEST_CASE("A host may be killed at any instant: each file opens, says what is missing, and is simulated again") {
  std::mt19937 random(5);
  for (int i = 0; i < 20; ++i) {
    TemporaryFolder folder;
    const std::string file = folder.path() / "run.mcap";
    Process running({program("sparkhost"), "--config", "soccer-sphere.lua", "--set", "team=Red Blue", "--set",
                     "players=2", "--rate", "max", "--agent-port", "0", "--monitor-port", "0", "--web-port", "0",
                     "--log-level", "error", "--record", file});
    running.line();
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 1'000'000));
    running.signal(SIGKILL);
    CHECK(running.wait() == 128 + SIGKILL);
    const auto [line, code] = verify(file);
    INFO(line.dump());
    CHECK(code == 0);
    CHECK(line["states"] > 0);
    CHECK(line["differs"].is_null());
    REQUIRE(line["lacks"].size() == 1);
    CHECK_THAT(line["lacks"][0].get<std::string>(), Contains("the recording was cut off"));
    const Finished on = runToEnd({program("sparkhost"), "--from", file, "--duration", "0.02", "--web-port", "0",
                                  "--agent-port", "0", "--monitor-port", "0", "--log-level", "error"});
    CHECK(on.code == 0);
  }
}

TEST_CASE("A recording with a damaged chunk is simulated up to the damage, and on from the next state") {
  Recorded match("soccer-sphere.lua", "sphere-team", 2,
                 joined(joined(kLockstep, withoutLimits()), {"--duration", "25"}));
  match.end();
  std::string bytes = textOf(match.file);
  const auto chunks = spark::mcap::Reader(match.file).chunks();
  const auto chunk = chunks.at(chunks.size() / 3);
  for (std::size_t i = 0; i < 50; ++i) bytes[chunk.offset + chunk.length / 2 + i] ^= 0x55;
  std::ofstream(match.file, std::ios::binary) << bytes;
  const auto [line, code] = verify(match.file);
  CHECK(code == 0);
  const double lost = static_cast<double>(chunk.begin) * 50e-9;  // the cycle at which it begins
  const double next = 500 * std::ceil(lost / 500);               // that of the next state
  CHECK(std::abs(line["cycles"].get<double>() - (1250 - (next - lost))) < 2.5);
  CHECK(line["differs"].is_null());
  REQUIRE(line["lacks"].size() == 2);
  CHECK_THAT(line["lacks"][0].get<std::string>(), Contains("s is damaged: "));
  CHECK_THAT(line["lacks"][1].get<std::string>(), Contains(fmt::format("to {:.0f}, after which it goes on", next)));
  // Also where the chunk was met before, in the search for a state.
  const std::string within = std::to_string(static_cast<double>(chunk.end) * 1e-9 + 0.5);
  const Finished sought = runToEnd({program("sparkreplay"), match.file, "--verify", "--from", within});
  CHECK(sought.code == 0);
  CHECK(Json::parse(sought.out)["cycles"] == line["cycles"]);
  CHECK(Json::parse(sought.out)["lacks"] == line["lacks"]);
}

TEST_CASE("A damaged piece of inputs is a hole, up to the next state that can be read, also one in its chunk") {
  using namespace spark;
  const bool stateIsDamaged = GENERATE(false, true);
  Recorded match("soccer-sphere.lua", "sphere-team", 2,
                 joined(joined(kLockstep, withoutLimits()), {"--duration", "25"}));
  match.end();
  mcap::Reader from(match.file);
  std::string bytes;
  {
    mcap::Writer to([&bytes](std::string_view more) { bytes += more; }, "test");
    for (const auto& [number, channel] : from.channels()) to.channel({number, channel.topic, channel.encoding});
    to.metadata("spark", from.metadataOf("spark"));
    for (const auto& a : from.attachments()) to.attachment(a.time, a.name, a.mediaType, from.read(a));
    for (const auto& chunk : from.chunks())
      from.forEach(chunk, [&](const mcap::Message& m) {
        std::string data(m.data);
        if (m.channel == from.channelOf(recorder::kInputs) && m.time == 9'800'000'000) data = "\x01";
        if (stateIsDamaged && m.channel == from.channelOf(recorder::kStates) && m.time == 10'000'000'000)
          data.resize(100);
        to.message(m.channel, m.time, data);
        return true;
      });
    to.finish();
  }
  std::ofstream(match.file, std::ios::binary) << bytes;
  const auto [line, code] = verify(match.file);
  INFO(line.dump());
  CHECK(code == 0);
  CHECK(line["differs"].is_null());
  // Cycles 490 to 500 are lost, or 490 to 1000.
  const int lost = stateIsDamaged ? 511 : 11;
  CHECK(std::abs(line["cycles"].get<int>() - (1250 - lost)) <= 1);
  REQUIRE(line["lacks"].size() == (stateIsDamaged ? 3 : 2));
  CHECK_THAT(line["lacks"][0].get<std::string>(), Contains("what follows cycle 4") && Contains("inputs are"));
  if (stateIsDamaged) CHECK_THAT(line["lacks"][1].get<std::string>(), Contains("the state at 10.000 s: "));
  CHECK_THAT(line["lacks"].back().get<std::string>(),
             Contains(stateIsDamaged ? "to 1000, after which it goes on" : "to 500, after which it goes on"));
}

TEST_CASE("One changed byte of an input is found: the cycle, and by the next state node and property") {
  using namespace spark;
  Recorded match("soccer-sphere.lua", "sphere-team", 2,
                 joined(joined(kLockstep, withoutLimits()), {"--duration", "15"}));
  match.end();
  // The same file, but for one digit of an agent's message.
  mcap::Reader from(match.file);
  std::string bytes;
  std::int64_t changedAt = 0;
  {
    mcap::Writer to([&bytes](std::string_view more) { bytes += more; }, "test");
    for (const auto& [number, schema] : from.schemas()) to.schema(schema);
    for (const auto& [number, channel] : from.channels()) to.channel(channel);
    to.metadata("spark", from.metadataOf("spark"));
    for (const auto& a : from.attachments()) to.attachment(a.time, a.name, a.mediaType, from.read(a));
    recorder::InputReader reader;
    recorder::InputWriter writer;
    for (const auto& chunk : from.chunks())
      from.forEach(chunk, [&](const mcap::Message& m) {
        std::string data(m.data);
        if (m.channel == from.channelOf(recorder::kInputs)) {
          std::vector<recorder::OwnInput> inputs;
          reader.read(m.data, inputs);
          for (auto i = inputs.begin(); i != inputs.end() && m.time > 6'000'000'000 && changedAt == 0; ++i) {
            const std::size_t drive = i->kind == Input::Kind::message ? i->text.find("(drive ") : std::string::npos;
            if (drive == std::string::npos) continue;
            char& digit = i->text[i->text.find_first_of("123456789", drive)];
            digit = digit == '1' ? '2' : '1';
            changedAt =
                std::find_if(i, inputs.end(), [](const auto& in) { return in.kind == Input::Kind::cycle; })->number;
          }
          writer.restart();
          data = writer.write(inputs).at(0);
        }
        to.message(m.channel, m.time, data);
        return true;
      });
    to.finish();
  }
  REQUIRE(changedAt > 300);
  std::ofstream(match.file, std::ios::binary) << bytes;
  const auto [line, code] = verify(match.file);
  INFO(line.dump());
  CHECK(code == 1);
  const auto cycle = line["differs"]["cycle"].get<std::int64_t>();
  CHECK(cycle >= changedAt);
  CHECK(cycle <= changedAt + 10);
  CHECK_THAT(line["differs"]["what"].get<std::string>(), Contains("/"));
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

namespace {
/// sparkreplay that plays a file and stands still.
struct Replay {
  std::unique_ptr<Process> process;
  unsigned short port = 0;
  explicit Replay(std::vector<std::string> command) : process(std::make_unique<Process>(std::move(command))) {
    port = static_cast<unsigned short>(Json::parse(process->line())["monitorPort"].get<int>());
  }
  /// What a monitor gets that connects when it shows a time: words and numbers. Another time than before.
  std::vector<std::string> at(double seconds) {
    const Finished set = runToEnd(
        joined(sparkctl(process->pid()), {"set", "/sys/server/monitor/player.time", fmt::format("{}", seconds)}));
    REQUIRE(set.code == 0);
    // A frame may be under way that was made before.
    for (;;) {
      std::vector<std::string> words = split(Client(port).receive());
      const auto time = std::find(words.begin(), words.end(), "time");
      REQUIRE(time + 1 < words.end());
      if (std::exchange(shown, time[1]) != time[1]) return words;
    }
  }
  static std::vector<std::string> split(const std::string& message) {
    std::vector<std::string> out(1);
    for (const char c : message) {
      const bool bracket = c == '(' || c == ')';
      if ((bracket || c == ' ') && !out.back().empty()) out.emplace_back();
      if (bracket) out.back() = c, out.emplace_back();
      if (!bracket && c != ' ') out.back() += c;
    }
    return out;
  }
  std::string shown = "0";  ///< time in the game that it showed last
};

/// The first word that differs; numbers may by a few quanta of the recording.
std::string firstDifference(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    if (a[i] == b[i]) continue;
    char *endA = nullptr, *endB = nullptr;
    const double x = std::strtod(a[i].c_str(), &endA), y = std::strtod(b[i].c_str(), &endB);
    if (*endA != 0 || *endB != 0 || std::abs(x - y) > 0.006)
      return fmt::format("{} {} {} against {} at {}", a[i - (i > 0)], a[i], i + 1 < a.size() ? a[i + 1] : "", b[i], i);
  }
  return a.size() == b.size() ? "" : fmt::format("{} words against {}", a.size(), b.size());
}
}  // namespace

TEST_CASE("A recording plays to monitors as the monitor log of the same match does, at any time") {
  Recorded match("soccer.lua", "humanoid-team", 1,
                 joined(kLockstep, {"--duration", "8", "--set", "Soccer.AutomaticKickOff=true", "--set",
                                    "Soccer.WaitBeforeKickOff=1"}));
  match.end();
  const std::string log = match.folder.path() / "match.log";
  REQUIRE(runToEnd({program("sparkreplay"), match.file, "--export", log}).code == 0);
  Replay recording({program("sparkreplay"), match.file, "--play", "--speed", "0", "--monitor-port", "0", "--web-port",
                    "0", "--log-level", "error"});
  Replay text({program("sparkhost"), "--config", "logplayer.lua", "--set", "file=" + log, "--set", "speed=0",
               "--monitor-port", "0", "--web-port", "0", "--log-level", "error"});
  // The log has a record each 0.2 s from 0.04 s on, the recording a frame each 0.08 s.
  const double first = 0.04;
  for (const double t : {4.24, 0.64, 6.24}) {
    INFO("at " << t << " s");
    CHECK(firstDifference(recording.at(t), text.at(t - first)) == "");
  }
}

TEST_CASE("A recording plays forwards and backwards, and begins where it is told") {
  Recorded match("soccer-sphere.lua", "sphere-team", 1,
                 joined(joined(kLockstep, withoutLimits()), {"--duration", "6"}));
  match.end();
  const auto timesFrom = [&](const std::vector<std::string>& arguments) {
    Replay player(joined({program("sparkreplay"), match.file, "--play", "--monitor-port", "0", "--web-port", "0",
                          "--log-level", "error"},
                         arguments));
    std::vector<double> out;
    Client monitor(player.port);
    while (out.size() < 4) {
      monitor.receive();
      const Finished time =
          runToEnd(joined(sparkctl(player.process->pid()), {"get", "/sys/server/monitor/player.time"}));
      const double t = std::stod(time.out.substr(time.out.find("= ") + 2));
      if (out.empty() || t != out.back()) out.push_back(t);
    }
    return out;
  };
  // So slowly that a busy machine does not miss all of it.
  const auto forwards = timesFrom({"--from", "2", "--speed", "0.1"}), backwards = timesFrom({"--speed", "-0.1"});
  CHECK(std::is_sorted(forwards.begin(), forwards.end()));
  CHECK(forwards.front() >= 1.9);
  CHECK(std::is_sorted(backwards.rbegin(), backwards.rend()));
  CHECK(backwards.front() > 3);
}

TEST_CASE("A recording without frames is not played") {
  TemporaryFolder folder;
  const std::string file = folder.path() / "boxes.mcap";
  REQUIRE(runToEnd({program("sparkhost"), "--config", "boxes.lua", "--rate", "max", "--duration", "1", "--set",
                    "web=false", "--log-level", "error", "--record", file})
              .code == 0);
  const Finished played = runToEnd({program("sparkreplay"), file, "--play", "--monitor-port", "0", "--web-port", "0"});
  CHECK(played.code == 2);
  CHECK_THAT(played.errors, Contains("has no frames to show"));
}
