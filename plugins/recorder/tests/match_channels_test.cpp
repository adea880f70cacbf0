#include "match_channels.h"

#include <catch2/catch.hpp>
#include <map>
#include <nlohmann/json.hpp>

#include "mcap.h"
#include "temporary_folder.h"
// The reader of the web server's tests, which reads as a viewer does.
#include "../../monitor-web/tests/piece_reader.h"

using namespace spark;
using namespace spark::recorder;
using spark::web::test::FrameReader;
using spark::web::test::ReadPiece;
using Json = nlohmann::json;

namespace {

constexpr double kStep = 0.02;

/// Where the ball is at a time.
Matrix poseAt(double time) {
  Matrix m = Matrix::Identity();
  m(0, 3) = static_cast<float>(time);
  m(1, 3) = static_cast<float>(0.1 * time * time);
  return m;
}

/// A monitor server whose ball rolls.
class Server : public IMonitorServer {
 public:
  void requestFullState() override {}
  const MonitorFrame& frame() const override { return newest_.frame; }
  const NewestFrame& newest() const override { return newest_; }
  std::string command(std::string_view, std::string_view) override { return {}; }

  void makeFrame(std::int64_t cycle) {
    const double time = kStep * static_cast<double>(cycle);
    MonitorFrame& f = newest_.frame;
    f.cycle = cycle;
    f.shape = shape;
    f.nodes.assign(bodies, {});
    for (FrameNode& node : f.nodes) node.local = poseAt(time);
    f.env = {};
    f.env.put(EnvPolicy::always, "time", time);
    f.env.put(EnvPolicy::change, "score_left", score);
    newest_.keys = {{}, {1, static_cast<std::uint64_t>(score)}};
    if (std::exchange(foul, false)) {
      f.env.put(EnvPolicy::once, "foul", 3);
      newest_.keys.emplace_back();
    }
    ++newest_.serial;
  }

  std::uint64_t shape = 1;
  std::size_t bodies = 2;
  int score = 0;
  bool foul = false;

 private:
  NewestFrame newest_;
};

/// A recording of what the server shows.
struct Match {
  explicit Match(double frames = 12.5) : channels(std::in_place, *recording, frames) {}
  void play(double until) {
    for (; kStep * static_cast<double>(cycle) < until - 1e-9;) {
      if (++cycle % 2 == 0) server.makeFrame(cycle);
      channels->take(server, cycle, kStep * static_cast<double>(cycle), true);
    }
  }
  void end() {
    channels->finish(static_cast<mcap::Time>(cycle) * 20'000'000);
    recording.reset();
    mcap::Reader reader(file);
    CHECK(reader.lacks().empty());
    for (const auto& chunk : reader.chunks())
      reader.forEach(chunk, [&](const mcap::Message& m) {
        messages[reader.channels().at(m.channel).topic].emplace_back(m.time, m.data);
        return true;
      });
  }
  std::vector<ReadPiece> pieces() {
    std::vector<ReadPiece> out;
    for (const auto& [time, data] : messages["/monitor"]) out.emplace_back(data);
    return out;
  }

  test::TemporaryFolder folder;
  std::string file = folder.path() / "a.mcap";
  std::optional<Recording> recording{std::in_place, file, "test"};
  std::optional<MatchChannels> channels;
  Server server;
  std::int64_t cycle = 0;
  std::map<std::string, std::vector<std::pair<mcap::Time, std::string>>> messages;
};

}  // namespace

TEST_CASE("A recording has the match in pieces, which decode to the poses of the simulation") {
  Match m;
  m.play(11);
  m.end();
  const std::vector<ReadPiece> pieces = m.pieces();
  REQUIRE(pieces.size() == 6);
  int frames = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    CHECK(pieces[i].complete);
    CHECK(pieces[i].shape == 1);
    if (i > 0) CHECK(pieces[i].from == pieces[i - 1].to);
    CHECK(pieces[i].texts.front().find("\"full\":true") != std::string::npos);
    FrameReader reader(m.server.bodies);
    for (const std::string& frame : pieces[i].frames) {
      reader.take(frame);
      for (std::size_t k = 0; k < m.server.bodies; ++k) CHECK(reader.isNear(k, poseAt(reader.time)));
      ++frames;
    }
    CHECK(reader.time == pieces[i].to);
    // The time by which a reader finds it.
    CHECK(static_cast<double>(m.messages["/monitor"][i].first) * 1e-9 == Approx(pieces[i].to));
  }
  CHECK(pieces.front().from == Approx(0.04));
  CHECK(pieces.back().to > 10.9);
  CHECK(frames == 138 + 5);  // the first frame of a piece is the last one of the piece before
  REQUIRE(m.messages["/monitor/scenes"].size() == 1);
  const ReadPiece scene(m.messages["/monitor/scenes"][0].second);
  CHECK(scene.isScene);
  CHECK(Json::parse(scene.texts.at(0))["nodes"].size() == 2);
}

TEST_CASE("A recording lists changes and events, also those between its frames") {
  Match m(2);
  m.play(1.1);
  m.server.foul = true;
  m.play(3);
  m.server.score = 1;
  m.play(6);
  m.end();
  REQUIRE(m.messages["/monitor/outline"].size() == 1);
  const Json outline = Json::parse(m.messages["/monitor/outline"][0].second);
  REQUIRE(outline.size() == 3);
  CHECK(outline[0]["full"] == true);
  CHECK(outline[1]["entry"] == Json({"foul", 3}));
  CHECK(outline[1]["time"] == Approx(1.12));
  CHECK(outline[2]["entries"] == Json::parse(R"([["score_left",1]])"));
  CHECK(m.pieces().front().frames.size() == 5);
  // The same one by one, for readers of events.
  const auto& events = m.messages["/events"];
  REQUIRE(events.size() == 3);
  CHECK(Json::parse(events[0].second)["entries"] == Json::parse(R"([["score_left",0]])"));
  CHECK(Json::parse(events[1].second)["entry"] == Json({"foul", 3}));
  CHECK(Json::parse(events[2].second)["entries"] == Json::parse(R"([["score_left",1]])"));
}

TEST_CASE("A new scene begins a new piece, and scenes that change all the time are not all recorded") {
  Match m;
  m.play(3);
  m.server.shape = 2, m.server.bodies = 3;
  m.play(5);
  for (int i = 0; i < 25; ++i) ++m.server.shape, m.play(5 + 0.04 * (i + 1));
  m.end();
  const std::vector<ReadPiece> pieces = m.pieces();
  CHECK(pieces.at(0).shape == 1);
  CHECK(pieces.at(1).shape == 1);
  CHECK(pieces.at(2).shape == 2);
  CHECK(pieces.at(1).to == pieces.at(2).from);
  const std::size_t scenes = m.messages["/monitor/scenes"].size();
  CHECK((scenes >= 3 && scenes <= 5));
}

TEST_CASE("A simulation that is set back goes on in the recording from there") {
  Match m;
  m.play(3);
  m.cycle = 50;
  m.play(4);
  m.end();
  const std::vector<ReadPiece> pieces = m.pieces();
  REQUIRE(pieces.size() == 3);
  CHECK(pieces[1].from == Approx(1.04));
  CHECK(pieces[2].to == Approx(4).margin(0.1));
}
