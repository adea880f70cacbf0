#include <catch2/catch.hpp>

#include "frame_text.h"
#include "recorded_session.h"

// What monitors get while recorded sessions are played again: the same messages at the same time, full or not, node by node, with the same
// numbers as long as nothing has hit the ground too hard.

using namespace spark;
using namespace spark::test;

namespace {

struct Session {
  Recording recording;
  std::vector<std::string> frames;

  /// `ownScenes`: the project's field and robots; else the original ones.
  explicit Session(const std::string& name, int cycles = 1 << 20, bool ownScenes = true)
      : recording(referenceFolder() / "captures" / (name + ".jsonl")) {
    League league(ownScenes ? "" : "rsg/agent/nao/soccer.rsg", ownScenes ? "" : referenceFolder() / "scenes-reference");
    Replay replay(league, recording);
    replay.play(std::min(cycles, recording.cycles));
    frames = std::move(replay.frames);
  }
  const std::string& recorded(std::size_t i) const { return recording.frames.at(i); }
  /// What the first `count` messages differ in, with the message's number.
  std::string difference(std::size_t count, double tolerance) const {
    for (std::size_t i = 0; i < count; ++i) {
      if (i >= frames.size() || i >= recording.frames.size()) return "there are only " + std::to_string(i) + " messages";
      if (const std::string d = test::difference(recorded(i), frames[i], tolerance); !d.empty()) return "message " + std::to_string(i) + ", " + d;
    }
    return {};
  }
};

/// Counts where a text stands.
int count(const std::string& text, const std::string& what) {
  int n = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

void skipWithoutReference() {
  if (referenceFolder().empty()) std::exit(77);
}

}  // namespace

TEST_CASE("sessions of one robot give the recorded messages from the first full one on") {
  skipWithoutReference();
  struct Row {
    const char* name;
    std::size_t messages;
  };
  const Row row = GENERATE(Row{"nao0-rest", 151}, Row{"nao0-all-joints", 60}, Row{"nao3-legs", 80});
  const bool ownScenes = GENERATE(true, false);
  const Session session(std::string("mainline/") + row.name, static_cast<int>(2 * row.messages), ownScenes);
  INFO(row.name << (ownScenes ? " with our own scenes" : " with the original scenes"));
  CHECK(session.difference(row.messages, 1e-3) == "");
}

TEST_CASE("a ball that a trainer throws is in the messages at most one monitor period from where it was recorded") {
  skipWithoutReference();
  const Session session("mainline/ball-bounce-and-roll");
  CHECK(session.difference(22, 1e-3) == "");
  const auto starts = [](const std::vector<std::string>& frames) {
    std::size_t i = 0;
    while (i < frames.size() && entry(frames[i], "play_mode") != "3") ++i;
    return static_cast<int>(i);
  };
  CHECK(std::abs(starts(session.frames) - starts(session.recording.frames)) <= 1);
  // Shapes say who moved and by how much: only the ball moves, more than 5 mm in each message, until it lies.
  for (std::size_t i = 24; i < session.recording.frames.size() && i < session.frames.size(); ++i) {
    CAPTURE(i);
    REQUIRE(std::abs(count(session.frames[i], "(SLT") - count(session.recorded(i), "(SLT")) <= 1);
  }
}

TEST_CASE("four robots of two teams: the full messages of connecting, loading, joining and being killed, and a marker") {
  skipWithoutReference();
  const Session session("mainline/four-agents");
  REQUIRE(session.frames.size() + 1 >= session.recording.frames.size());
  // The robots burst apart in another way each time, so only the shapes of full messages are compared.
  for (std::size_t i = 0; i < 4; ++i) {
    INFO("message " << i);
    CHECK(FrameText(session.recorded(i)).shape == FrameText(session.frames[i]).shape);
  }
  CHECK(count(session.frames[4], "(setVisible ") == count(session.recorded(4), "(setVisible "));
  CHECK(count(session.frames[5], "(setVisible ") == 0);

  const auto from = [](const std::vector<std::string>& frames, auto wanted) {
    std::size_t i = 6;
    while (i < frames.size() && !wanted(frames[i])) ++i;
    REQUIRE(i < frames.size());
    return frames[i];
  };
  const auto marked = [](const std::string& m) { return !isFull(m) && m.find("(setVisible ") != std::string::npos; };
  const std::string markRecorded = from(session.recording.frames, marked), mark = from(session.frames, marked);
  CHECK(count(mark, "(nd(nd SMN (setVisible 1)))") == count(markRecorded, "(nd(nd SMN (setVisible 1)))"));
  CHECK(count(mark, "(setVisible ") == 1);
  CHECK(FrameText(from(session.recording.frames, isFull)).shape == FrameText(from(session.frames, isFull)).shape);
}
