// docs/referee.md is complete, and its examples work.
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include "../play_mode.h"
#include "api/command_check.h"
#include "match_house.h"

using namespace spark;
using namespace spark::test;

namespace {

std::string page() {
  std::ifstream file(SPARK_SCENES "/../docs/referee.md");
  REQUIRE(file);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// The commands in the first column of the page's tables.
std::vector<std::string> examples(const std::string& page) {
  std::vector<std::string> out;
  std::istringstream lines(page);
  const std::regex example("`(\\([a-zA-Z].*?\\))`");
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("| `(", 0) != 0) continue;
    const std::string column = line.substr(0, line.find(" |", 2));
    for (std::sregex_iterator it(column.begin(), column.end(), example), end; it != end; ++it) out.push_back((*it)[1]);
  }
  return out;
}

/// A match with one player on each side; the left one is selected.
struct Page : SoccerMatch {
  Page() {
    importField();
    join("A", 1), join("B", 1);
    trainer("(select (unum 1)(team Left))");
  }
  std::string check(const std::string& text) {
    Predicates p;
    readSexp(text, p);
    for (const Element e : p)
      if (std::string why = kernel.root().require<ICommandCheck>("/sys/server/monitor/TrainerCommandParser").check(e);
          !why.empty())
        return why;
    return {};
  }
};

}  // namespace

TEST_CASE("the page of the referee names all commands and all play modes, and its examples have an effect",
          "[soccer]") {
  Page h;
  const std::string text = page();
  std::set<std::string> named, known{"reqfullstate", "killsim", "init", "getAck"};
  for (const std::string& example : examples(text)) {
    INFO(example);
    CHECK(h.check(example).empty());
    named.insert(example.substr(1, example.find_first_of(" )") - 1));
  }
  const Value commands = h.get("/sys/server/monitor/TrainerCommandParser", "commands");
  for (const Value& name : commands.toList()) known.insert(name.toString());
  CHECK(named == known);
  for (const char* mode : soccer::kPlayModeNames) {
    INFO(mode);
    CHECK(text.find(std::string("`") + mode + "`") != std::string::npos);
  }
}

TEST_CASE("checking a command changes nothing", "[soccer]") {
  Page h;
  const std::uint64_t before = stateHash(h.kernel.root());
  for (const std::string& example : examples(page())) h.check(example);
  CHECK(stateHash(h.kernel.root()) == before);
  CHECK(h.kernel.root().find<Node>("/usr/scene/AgentAspect1"));
}

TEST_CASE("a command that has no effect, or ignores a part, is answered with the reason and its grammar", "[soccer]") {
  const auto [command, reason] = GENERATE(table<const char*, const char*>({
      {"(kickOff Foo)", "expected Left, Right or None, found 'Foo'. The command is (kickOff Left|Right|None)"},
      {"(kickOff)", "expected Left, Right or None, found ''"},
      {"(playMode Goal_left)", "expected a play mode, found 'Goal_left'. Did you mean 'Goal_Left'?"},
      {"(playMode PlayOn now)", "expected 1 argument, found 2: the rest is ignored"},
      {"(dropBall 1 2)", "expected 0 arguments, found 2"},
      {"(kickOff Left Right)", "expected 1 argument, found 2"},
      {"(time 5 6)", "expected 1 argument, found 2"},
      {"(ball (pos 1 2 3)(pos 4 5 6))", "found 'pos' again, which is ignored"},
      {"(score (left 1)(right 2)(left 3))", "found 'left' again, which is ignored"},
      {"(kill (unum 1)(team Left) now)", "found 'now', which is ignored"},
      {"(agent (unum 1)(team Left)(battery 500))", "expected 0 to 100 after battery, found 500: it is clamped"},
      {"(agent (unum 1)(team Left Right)(pos 1 2 3))", "expected (team Left) or (team Right)"},
      {"(ball 1 2 3)", "expected (pos x y z) or (vel x y z)"},
      {"(ball (pos 1 2)(vel 1 0 0))", "expected 3 numbers"},
      {"(ball (pos 1 2 3)(speed 1))", "found 'speed', which is ignored"},
      {"(agent (unum 1)(team Left)(pos 1 2 nan))", "expected (pos x y z), (move x y z deg)"},
      {"(agent (unum 9)(team Left)(pos 1 2 3))", "no such player"},
      {"(kill (unum 9)(team Right))", "no such player"},
      {"(time -1)", "expected a time"},
      {"(score 5 4)", "expected (left a)(right b)"},
      {"(score (left 5)(right -4))", "both 0 or more"},
  }));
  Page h;
  INFO(command);
  CHECK_THAT(h.check(command), Catch::Contains(reason));
}

TEST_CASE("commands about selected players are answered when none is selected", "[soccer]") {
  Page h;
  h.trainer("(select (unum -1))");
  for (const char* command : {"(agent)", "(kill)", "(repos)"}) {
    INFO(command);
    CHECK_THAT(h.check(command), Catch::Contains("no such player"));
  }
}
