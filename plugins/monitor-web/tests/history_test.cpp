#include "../history.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <random>

#include "piece_reader.h"

using namespace spark;
using namespace spark::web;
using spark::web::test::FrameReader;
using spark::web::test::ReadPiece;
using Json = nlohmann::json;

namespace {

/// A match in which a ball rolls at 1 m/s.
struct Match {
  explicit Match(double seconds = 300, std::size_t bytes = 64u << 20) : history(seconds, bytes) { newScene(1); }
  void newScene(std::uint32_t number) {
    shape = number;
    s.scene = std::make_shared<SceneDescription>();
    scene.begin(s);
    history.takeScene(shape, "{\"type\":\"scene\",\"shape\":" + std::to_string(shape) + "}");
  }
  /// A cycle later.
  void cycle() {
    s.time = 0.02 * ++cycles;
    s.transforms.assign(static_cast<std::size_t>(bodies), Matrix::Identity());
    for (Matrix& m : s.transforms) m(0, 3) = static_cast<float>(s.time);
    for (Matrix& m : s.transforms)
      for (int k = 1; restless && k < 3; ++k) m(k, 3) = static_cast<float>(random() % 1000) * 0.01f;
    s.visible.assign(s.transforms.size(), 1);
    s.environment.predicates.clear();
    s.environment.entries.clear();
    s.environment.put(EnvPolicy::full, "FieldLength", 30.0);
    s.environment.put(EnvPolicy::always, "time", s.time);
    s.environment.put(EnvPolicy::change, "score_left", score);
    s.keys = {{}, {}, {1, static_cast<std::uint64_t>(score)}};
    s.events.clear();
    s.eventTimes.clear();
    if (foul > 0) s.events.open("foul").add(std::exchange(foul, 0)).close(), s.eventTimes.push_back(s.time);
    if (loud) s.events.open("sound").add("bump").add(1).close(), s.eventTimes.push_back(s.time);
    history.take(s, shape, scene);
  }
  void play(double seconds) {
    for (int i = 0; i < std::lround(seconds / 0.02); ++i) cycle();
  }
  ReadPiece at(double time) { return ReadPiece(*history.pieceAt(time)); }
  /// Where the ball was, as a viewer finds it.
  double ballAt(double time) {
    const ReadPiece piece = at(time);
    FrameReader reader(static_cast<std::size_t>(bodies));
    for (const std::string& frame : piece.frames) {
      FrameReader next = reader;
      next.take(frame);
      if (next.time > time + 1e-9) break;
      reader = next;
    }
    return std::ldexp(reader.quantised[0][0], -reader.positionBits);
  }

  History history;
  Snapshot s;
  FrameScene scene;
  std::uint32_t shape = 0;
  std::minstd_rand random{7};
  bool restless = false;
  int cycles = 0, bodies = 3, score = 0, foul = 0;
  bool loud = false;
};

}  // namespace

TEST_CASE("Any instant of the last minutes is in one piece") {
  Match m;
  CHECK(m.history.empty());
  CHECK(m.history.pieceAt(1) == nullptr);
  CHECK(m.history.outline(1 << 20) == "[]");
  m.play(100);
  CHECK(m.history.from() == Approx(0.02));
  CHECK(m.history.to() > 99.9);
  for (double time = 0.1; time < 99.9; time += 0.37) {
    INFO(time);
    CHECK(std::abs(m.ballAt(time) - time) < 0.09);
  }
  CHECK(m.at(-1e300).from == m.history.from());
  CHECK(m.at(1e300).to == m.history.to());
}

TEST_CASE("A piece ends with the first frame of the next one, and only the last one is not complete") {
  Match m;
  m.play(30);
  ReadPiece piece = m.at(0);
  int pieces = 1;
  while (piece.complete) {
    const ReadPiece next = m.at(piece.to);
    CHECK(next.from == piece.to);
    CHECK(piece.to - piece.from == Approx(2).margin(0.1));
    CHECK(piece.frames.front()[0] == 1);
    CHECK(piece.texts.front().find("\"full\":true") != std::string::npos);
    ++pieces;
    piece = next;
  }
  CHECK(piece.to == m.history.to());
  CHECK((pieces >= 14 && pieces <= 16));
  // The piece that grows is compressed once for all viewers that request it at the same time.
  CHECK(m.history.pieceAt(30) == m.history.pieceAt(29.9));
  const auto before = m.history.pieceAt(30);
  m.play(0.1);
  CHECK(m.history.pieceAt(30) != before);
}

TEST_CASE("Frames are taken at simulated times, and every event is kept") {
  Match m;
  for (int i = 1; i <= 50; ++i) {
    m.foul = i;
    m.cycle();
  }
  const ReadPiece piece = m.at(0.5);
  CHECK((piece.frames.size() >= 12 && piece.frames.size() <= 14));
  int fouls = 0;
  for (const std::string& text : piece.texts) fouls += text.find("foul") != std::string::npos;
  CHECK(fouls == 49);  // the first one came before the first frame
}

TEST_CASE("What is older than the time to keep is removed, and what needs more memory than allowed") {
  Match m(10);
  m.play(60);
  CHECK(m.history.from() > 45.9);
  CHECK(m.history.from() <= 50);

  const std::size_t most = 1 << 20;
  Match big(3600, most);
  big.bodies = 4000;
  big.restless = true;
  for (int i = 0; i < 500; ++i) {
    big.cycle();
    CHECK(big.history.bytes() <= most + (1 << 20));  // and the piece that grows
  }
  CHECK(big.history.from() > 0.1);
}

TEST_CASE("A new scene begins a new piece, and is kept as long as one has it") {
  Match m(10);
  m.play(5);
  m.bodies = 5;
  m.newScene(2);
  m.play(5);
  CHECK(m.at(4).shape == 1);
  const ReadPiece second = m.at(9);
  CHECK(second.shape == 2);
  CHECK(m.at(4.99).to == m.at(5.1).from);  // no gap
  const ReadPiece scene(*m.history.scene(1));
  CHECK(scene.isScene);
  CHECK(scene.texts.at(0) == "{\"type\":\"scene\",\"shape\":1}");
  m.play(20);
  CHECK(m.history.scene(1) == nullptr);
  CHECK(m.history.scene(2) != nullptr);
  CHECK(m.history.scene(7) == nullptr);
}

TEST_CASE("A simulation that is set back begins anew") {
  Match m;
  m.play(50);
  m.cycles = 1000;
  m.play(5);
  CHECK(m.history.from() == Approx(20.02));
  CHECK(m.history.to() == Approx(25).margin(0.1));
  CHECK(std::abs(m.ballAt(22) - 22) < 0.09);
  CHECK(m.history.scene(1) != nullptr);
}

TEST_CASE("The outline has what happened, without the clock and sounds") {
  Match m(20);
  m.loud = true;
  m.play(1);
  m.score = 1;
  m.play(20);
  m.foul = 3;
  m.score = 2;
  m.play(20);
  const Json outline = Json::parse(m.history.outline(1 << 20));
  REQUIRE(outline.size() == 3);
  CHECK(outline[0]["full"] == true);
  CHECK(outline[0]["entries"] == Json::parse(R"([["FieldLength",30],["time",20.02],["score_left",1]])"));
  CHECK(outline[1]["entry"] == Json::parse(R"(["foul",3])"));
  CHECK(outline[2]["entries"] == Json::parse(R"([["score_left",2]])"));
  CHECK(outline[2]["time"].get<double>() == Approx(21.02).margin(0.08));
  for (int i = 0; i < 2000; ++i) {
    m.foul = i + 1;
    m.cycle();
  }
  const std::string limited = m.history.outline(20000);
  CHECK((limited.size() > 10000 && limited.size() <= 21000));
  CHECK(Json::parse(limited).back()["entry"] == Json::parse(R"(["foul",2000])"));
}
