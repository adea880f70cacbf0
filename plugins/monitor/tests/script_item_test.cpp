#include <catch2/catch.hpp>

#include "absence.h"
#include "api/status.h"
#include "spark/script_server.h"
#include "spark/state.h"
#include "stage.h"
#include "temporary_folder.h"

// Entries and events that a Lua script sends to monitors through a ScriptItem.

using namespace spark;
using namespace spark::test;
using Catch::Contains;

namespace {
/// A stage with a ScriptItem in place of the test item.
struct ScriptStage : Stage {
  ScriptStage() {
    scripts(kernel).run("delete '/sys/server/monitor/item' item = new('ScriptItem', '/sys/server/monitor/game')",
                        "test");
  }
  void act() { kernel.events().channel("act").emit({"", 0, 0.02, 1, nullptr}); }
  void run(const std::string& text) { scripts(kernel).run(text, "test"); }
  /// The next message to a monitor.
  std::string next(FakeConnection& connection) {
    for (Transform* part : parts) part->setLocalPos({0, 0, 0});
    kernel.events().channel("publish").emit({"", 0.5, 0.02, 2, nullptr});
    return connection.read();
  }
};
}  // namespace

TEST_CASE("A script's entries are in the first message to a monitor, and in the next message after a change") {
  ScriptStage stage;
  stage.run("item.score_left, item.play_modes, item.play_mode = 2, {'Wait', 'Fight'}, 'Fight'");
  FakeConnection& monitor = stage.connect();
  CHECK_THAT(monitor.read(), Contains("((play_mode Fight)(play_modes Wait Fight)(score_left 2)(time 0))(RSG 0 1)"));
  stage.next(monitor);
  CHECK_THAT(stage.next(monitor), Contains("((time 0.5))(RDS 0 1)"));
  stage.run("item.score_left = item.score_left + 1");
  CHECK_THAT(stage.next(monitor), Contains("((score_left 3)(time 0.5))(RDS 0 1)"));
  stage.run("item.score_right = 1.5");  // a new entry
  CHECK_THAT(stage.next(monitor), Contains("((score_right 1.5)(time 0.5))"));
  stage.run("item.score_right = nil");
  CHECK_THAT(stage.next(monitor), Contains("((time 0.5))"));
}

TEST_CASE("A script's time replaces the server's") {
  ScriptStage stage;
  stage.run("item.time = 7");
  FakeConnection& monitor = stage.connect();
  CHECK_THAT(monitor.read(), Contains("((time 7))(RSG 0 1)"));
  CHECK_THAT(stage.next(monitor), Contains("((time 7))(RDS 0 1)"));
}

TEST_CASE("A script's event is sent to each monitor once") {
  ScriptStage stage;
  FakeConnection &one = stage.connect(), &other = stage.connect();
  one.read(), other.read();
  stage.run("item:event('fell', 'Red', 3) item:event('over')");
  const std::string said = stage.next(one);
  CHECK_THAT(said, Contains("(fell Red 3)") && Contains("(over)"));
  CHECK_THAT(other.read(), Contains("(fell Red 3)"));
  CHECK(lacks(stage.next(one), "fell", said));
}

TEST_CASE("An entry that monitors could not read is refused with an error and changes nothing") {
  ScriptStage stage;
  stage.run("item.team_left = 'Red'");
  const std::pair<const char*, const char*> wrong[] = {
      {"item.team_left = 'Red Devils'", "one word without blanks, brackets and quotes, found \"Red Devils\""},
      {"item.team_left = 'a(b'", "one word"},
      {"item.team_left = ''", "one word"},
      {"item['team left'] = 'Red'", "expected the name of an entry"},
      {"item.team_left = 0/0", "a finite number"},
      {"item.team_left = {1, {'a', 'b c'}}", "one word"},
      {"item:event('goal', 1/0)", "a finite number"},
      {"item:event('a goal')", "the name of an entry"},
      {"item.entries = {score = 1, ['a b'] = 2}", "the name of an entry"},
      {"item.entries = 3", "a table of entries"}};
  for (const auto& [text, why] : wrong) {
    INFO(text);
    CHECK_THROWS_WITH(stage.run(text), Contains(why));
  }
  FakeConnection& monitor = stage.connect();
  CHECK_THAT(monitor.read(), Contains("((team_left Red)(time 0))"));
}

TEST_CASE("The entries of a script are also the game's status, under the status names") {
  ScriptStage stage;
  stage.run(
      "item.entries = { play_modes = {'Wait', 'Fight'}, play_mode = 1, score_left = 2, score_right = 0, team_left = "
      "'Red', team_right = 'Blue', time = 3, bout = 4, ['no-status'] = 5 }");
  const auto status = [&] {
    List out;
    for (const StatusEntry& e : StatusReporters().read(stage.kernel)) {
      out.push_back(List{e.name, e.value});
      if (e.name == "score") CHECK((e.parts == std::vector<std::string>{"Left", "Right"}));
    }
    return Value(out).text();
  };
  CHECK(status() == R"({{"playMode", "Fight"}, {"score", {2, 0}}, {"teams", {"Red", "Blue"}}, {"bout", 4}})");
  stage.run("item.entries = { play_mode = 'Over', score_left = 1 }");
  CHECK(status() == R"({{"playMode", "Over"}})");
  stage.run("item.entries = { play_modes = {'Wait'}, play_mode = 7 }");
  CHECK(status() == "{}");
}

TEST_CASE("A script attached to its item stores the score in it, and the score is restored with the world") {
  ScriptStage stage;
  TemporaryFolder folder;
  const std::string rule = folder.write("rule.lua",
                                        "local args = ...\n"
                                        "self.entries = { score = args.from, mode = 'Fight' }\n"
                                        "on('act', function(self) self.score = self.score + 1 end)\n");
  stage.run("item:script('" + rule + "', { from = 10 })");
  Leaf& item = stage.kernel.root().require<Leaf>("/sys/server/monitor/game");
  const auto score = [&] { return callMethod(item, "get", std::array{Value("score")}).toInteger(); };
  stage.act();
  CHECK(score() == 11);
  StateWriter saved(true);
  saveTree(item, saved);
  const auto hash = stateHash(item);
  stage.act();
  CHECK(score() == 12);
  CHECK(stateHash(item) != hash);
  StateReader reader(saved.bytes());
  loadTree(item, reader);
  CHECK(score() == 11);
  CHECK(stateHash(item) == hash);
}
