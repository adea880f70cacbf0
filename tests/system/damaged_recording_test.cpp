// Recordings of hosts that were killed or whose disk was full, and files that were damaged or changed later.
#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <random>

#include "input_codec.h"
#include "mcap.h"
#include "recorded.h"

using namespace spark::test;
using Catch::Contains;

namespace {
/// Writes a recording anew, with `change(topic, message)` as the data of each message.
template <class Change>
void rewrite(const std::string& file, Change change) {
  using namespace spark;
  std::string bytes;
  mcap::Reader from(file);
  {
    mcap::Writer to([&bytes](std::string_view more) { bytes += more; }, "test");
    for (const auto& [number, schema] : from.schemas()) to.schema(schema);
    for (const auto& [number, channel] : from.channels()) to.channel(channel);
    to.metadata("spark", from.metadataOf("spark"));
    for (const auto& a : from.attachments()) to.attachment(a.time, a.name, a.mediaType, from.read(a));
    for (const auto& chunk : from.chunks())
      from.forEach(chunk, [&](const mcap::Message& m) {
        to.message(m.channel, m.time, change(from.channels().at(m.channel).topic, m));
        return true;
      });
    to.finish();
  }
  std::ofstream(file, std::ios::binary) << bytes;
}
}  // namespace

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
    waitForCycle(running, static_cast<std::int64_t>(random() % 4000));
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
  rewrite(match.file, [&](std::string_view topic, const mcap::Message& m) {
    std::string data(m.data);
    if (topic == recorder::kInputs && m.time == 9'800'000'000) data = "\x01";
    if (stateIsDamaged && topic == recorder::kStates && m.time == 10'000'000'000) data.resize(100);
    return data;
  });
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
  // The same file except for one digit of an agent's message.
  std::int64_t changedAt = 0;
  recorder::InputReader reader;
  recorder::InputWriter writer;
  rewrite(match.file, [&](std::string_view topic, const mcap::Message& m) {
    if (topic != recorder::kInputs) return std::string(m.data);
    std::vector<recorder::OwnInput> inputs;
    reader.read(m.data, inputs);
    for (auto i = inputs.begin(); i != inputs.end() && m.time > 6'000'000'000 && changedAt == 0; ++i) {
      const std::size_t drive = i->kind == Input::Kind::message ? i->text.find("(drive ") : std::string::npos;
      if (drive == std::string::npos) continue;
      char& digit = i->text[i->text.find_first_of("123456789", drive)];
      digit = digit == '1' ? '2' : '1';
      changedAt = std::find_if(i, inputs.end(), [](const auto& in) { return in.kind == Input::Kind::cycle; })->number;
    }
    writer.restart();
    return writer.write(inputs).at(0);
  });
  REQUIRE(changedAt > 300);
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
