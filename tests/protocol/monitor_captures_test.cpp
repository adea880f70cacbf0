#include <catch2/catch.hpp>

#include "absence.h"
#include "frame_text.h"
#include "recorded_session.h"

// Monitor messages while recorded sessions are replayed: the same messages at the same time, full or not, node by node,
// with the same numbers where the recording had no randomness.

using namespace spark;
using namespace spark::test;

namespace {

struct Session {
  Recording recording;
  std::vector<std::string> frames;

  /// `ownScenes`: use the project's field and robots instead of the original ones.
  explicit Session(const std::string& name, int cycles = 1 << 20, bool ownScenes = true)
      : recording(referenceFolder() / "captures" / (name + ".jsonl")) {
    const bool spl = name.starts_with("spl/");
    if (spl) paintGoals();
    League league(ownScenes ? "" : "rsg/agent/nao/soccer.rsg", ownScenes ? "" : referenceFolder() / "scenes-reference",
                  {{"compat", spl ? "F" : "M"}, {"/sys/server/gamecontrol.sync", false}});
    Replay replay(league, recording);
    replay.play(std::min(cycles, recording.cycles));
    frames = std::move(replay.frames);
  }
  /// The goal meshes of the SPL are white. Otherwise the recordings show the same field.
  void paintGoals() {
    for (std::string& frame : recording.frames)
      for (const char* paint : {"naogoalnet yellow", "naogoalnet sky-blue"})
        if (const std::size_t at = frame.find("naogoalnet white"); at != std::string::npos)
          frame.replace(at, 16, paint);
  }
  const std::string& recorded(std::size_t i) const { return recording.frames.at(i); }
  /// The first difference within the first `count` messages, with the message's number.
  std::string difference(std::size_t count, double tolerance) const {
    for (std::size_t i = 0; i < count; ++i) {
      if (i >= frames.size() || i >= recording.frames.size())
        return "there are only " + std::to_string(i) + " messages";
      if (const std::string d = test::difference(recorded(i), frames[i], tolerance); !d.empty())
        return "message " + std::to_string(i) + ", " + d;
    }
    return {};
  }
};

/// The lines of a file.
std::vector<std::string> linesOf(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<std::string> out;
  for (std::string line; std::getline(in, line);) out.push_back(line);
  return out;
}

/// The effects of a command that eight messages show: changes of the environment except time, full messages, markers.
struct Effects {
  std::string env;
  int fulls = 0, marks = 0;
  std::string moved;  ///< the first message in which a whole robot moved

  void add(const std::string& message) {
    if (isFull(message)) {
      ++fulls;
      return;
    }
    const std::size_t end = message.find(')') + 1;  // of (time t)
    env += message.substr(end, message.find(")(RDS") - end);
    marks += count(message, "(setVisible ");
    if (moved.empty() && count(message, "(SLT") > 15) moved = message.substr(message.find("(SLT"));
  }
};

/// Two robots of the SPL server at rest, and a trainer.
struct Rehearsal {
  League league{"", {}, {{"compat", "F"}, {"/sys/server/gamecontrol.sync", false}}};
  FakeConnection& monitor = league.connectMonitor();
  std::vector<FakeConnection*> agents;

  Rehearsal() {
    monitor.read();
    join("RefA", 1, "(beam -1.5 0.47 0)");
    join("RefB", 2, "(beam -1.5 1 0)");
    for (int i = 0; i < 120; ++i) next();
  }
  void join(const char* team, int unum, const char* beam) {
    agents.push_back(&league.connectAgent());
    league.fromAgent(*agents.back(), "(scene rsg/agent/nao/nao.rsg)(syn)");
    for (int i = 0; i < 3; ++i) next();
    league.fromAgent(*agents.back(), fmt::format("(init (unum {})(teamname {}))(syn)", unum, team));
    for (int i = 0; i < 3; ++i) next();
    league.fromAgent(*agents.back(), beam);
  }
  /// The next message, "" if no message is due.
  std::string next() {
    league.run(2);
    for (FakeConnection* a : agents) a->read();
    return monitor.read();
  }
};

void skipWithoutReference() {
  if (referenceFolder().empty()) std::exit(77);
}

}  // namespace

TEST_CASE("A message with another number, node or entry differs from the recorded one") {
  const std::string recorded = "((time 1.50))(RSG 0 1)((nd TRF (SLT 1 0 0.25)) ";
  CHECK(difference(recorded, recorded, 0) == "");
  CHECK(difference(recorded, "((time 1.50))(RSG 0 1)((nd TRF (SLT 1 0 0.26)) ", 0.02) == "");
  for (const char* const other :
       {"((time 1.50))(RSG 0 1)((nd TRF (SLT 1 0 0.26)) ", "((time 1.50))(RSG 0 1)((nd TRF (SLT 1 0)) ",
        "((time 1.50))(RSG 0 1)((nd (SLT 1 0 0.25)) ", "((time nan))(RSG 0 1)((nd TRF (SLT 1 0 0.25)) "})
    CHECK(difference(recorded, other, 1e-5) != "");
}

TEST_CASE("Sessions of one robot give the recorded messages from the first full one on") {
  skipWithoutReference();
  struct Row {
    const char* name;
    std::size_t messages;
  };
  const Row row =
      GENERATE(Row{"mainline/nao0-rest", 151}, Row{"mainline/nao0-all-joints", 147}, Row{"mainline/nao3-legs", 150},
               Row{"spl/nao0-rest", 150}, Row{"spl/nao0-all-joints", 150}, Row{"spl/nao3-legs", 150});
  const bool ownScenes = GENERATE(true, false);
  const Session session(row.name, static_cast<int>(2 * row.messages), ownScenes);
  INFO(row.name << (ownScenes ? " with our own scenes" : " with the original scenes"));
  CHECK(session.difference(row.messages, 1e-5) == "");
}

TEST_CASE("A ball moved by a trainer takes the recorded path and starts at most one monitor period off") {
  skipWithoutReference();
  const Session session(GENERATE("mainline/ball-bounce-and-roll", "spl/ball-bounce-and-roll"));
  CHECK(session.difference(20, 1e-5) == "");
  const auto starts = [](const std::vector<std::string>& frames) {
    std::size_t i = 0;
    while (i < frames.size() && entry(frames[i], "play_mode") != "3") ++i;
    return static_cast<int>(i);
  };
  CHECK(std::abs(starts(session.frames) - starts(session.recording.frames)) <= 1);
  // Only the ball moves.
  const auto path = [](const std::vector<std::string>& frames) {
    std::vector<std::string> out;
    for (std::size_t i = 20; i < frames.size(); ++i)
      if (const std::size_t at = frames[i].find("(SLT"); at != std::string::npos)
        out.push_back(frames[i].substr(at, frames[i].find(')', at) - at));
    return out;
  };
  const auto recorded = path(session.recording.frames), found = path(session.frames);
  REQUIRE(recorded.size() > 150);
  REQUIRE(found.size() >= recorded.size());
  for (std::size_t i = 0; i < recorded.size(); ++i) {
    CAPTURE(i);
    REQUIRE(difference(recorded[i] + " ", found[i] + " ", 1e-5) == "");
  }
}

TEST_CASE("Four robots of two teams give the recorded full messages and marker") {
  skipWithoutReference();
  const Session session("mainline/four-agents");
  REQUIRE(session.frames.size() + 1 >= session.recording.frames.size());
  // The robots separate differently each time, so only the shapes of full messages are compared.
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

TEST_CASE("Each command of the recorded trainer has the recorded effect within eight messages") {
  skipWithoutReference();
  const auto folder = referenceFolder() / "captures" / "spl";
  const auto recorded = linesOf(folder / "monitor-trainer-commands.txt");
  Rehearsal rehearsal;
  int commands = 0;
  for (const std::string& line : linesOf(folder / "monitor-trainer-commands.sent.txt")) {
    const std::size_t blank = line.find(' '), at = std::stoul(line);
    const std::string command = line.substr(blank + 1);
    INFO(at << " " << command);
    // In the recording the random choice was the right team.
    rehearsal.league.fromMonitor(rehearsal.monitor, command == "(kickOff None)" ? "(kickOff Right)" : command);
    if (command == "(killsim)") {
      rehearsal.league.run(2);
      CHECK(rehearsal.league.kernel.stopRequested());
      break;
    }
    Effects expected, found;
    for (std::size_t i = 0; i < 8; ++i) {
      if (at + i < recorded.size()) expected.add(recorded[at + i]);
      if (const std::string message = rehearsal.next(); !message.empty()) found.add(message);
    }
    CHECK(found.env == expected.env);
    CHECK(found.fulls == expected.fulls);
    CHECK(found.marks == expected.marks);
    ++commands;
    if (expected.moved.empty()) continue;
    const FrameText there(expected.moved), here(found.moved);
    REQUIRE(here.numbers.size() > 16);
    // The torso. After a kick-off its height depends on how the robot came to rest. If the command turned it, its
    // posture determines whether it is moved out of the circle.
    const bool kickOff = command.starts_with("(kickOff"),
               turned = command.find("(move") != std::string::npos || command.find("(rot") != std::string::npos;
    for (std::size_t i = turned ? 13 : 12; i < (kickOff ? 14u : 15u); ++i)
      CHECK(here.numbers[i] == Approx(there.numbers[i]).margin(0.06));
  }
  CHECK(commands == 34);
}
