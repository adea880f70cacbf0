// What players get wrong: one line in the log for each kind, with the number of the agent.
#include "match_house.h"

using namespace spark;
using namespace spark::test;

namespace {

/// A match with a goalie A1 and a player A2 that makes mistakes, and B1 far away.
struct Mistakes : SoccerMatch {
  Puppet &goalie, &player, &opponent;
  Mistakes() : goalie(first()), player(join("A", 2)), opponent(join("B", 1)) {
    placeBall(0, 0);
    placeAgent(1, -50, 0);
    placeAgent(2, -20, 10);
    placeAgent(3, 30, 10);
    text.clear();
  }
  Puppet& first() {
    importField();
    return join("A", 1);
  }
  /// Number of log lines about the agent that contain `what`.
  int lines(int agent, const std::string& what) {
    std::istringstream all(text);
    int n = 0;
    for (std::string line; std::getline(all, line);)
      n += line.find(fmt::format("agent {} (", agent)) != std::string::npos && line.find(what) != std::string::npos;
    return n;
  }
  /// Sends `actions` three times as A2, and expects one line in all, which contains `what`.
  void expectOneLine(const std::string& actions, const std::string& what) {
    INFO(actions << "\n" << text);
    text.clear();
    for (int i = 0; i < 3; ++i) act(player, actions);
    INFO(text);
    CHECK(lines(2, what) == 1);
    CHECK(lines(2, "") == 1);
  }
};

}  // namespace

TEST_CASE("a message that cannot be said is one line in the log", "[soccer]") {
  Mistakes h;
  h.expectOneLine("(say 123456789012345678901)", "say: expected at most 20 bytes, found 21: nobody hears it");
  const std::string before = h.player.all;
  h.expectOneLine("(say one two)", "say: expected one word, found 2: only the first is said");
  CHECK(h.player.all.find("self one)") != std::string::npos);
  CHECK(lacks(before, "hear", h.player.all));
  h.expectOneLine("(say)", "say: expected one word, found none");
  h.expectOneLine("(say (a))", "say: expected one word, found a list");
  h.expectOneLine("(say \xc3\xa9)", "say: expected printable characters without blanks and brackets, found byte 195");
  h.expectOneLine("(say \"\")", "say: expected one word, found an empty one");
  // Of the same kinds as before.
  h.text.clear();
  h.act(h.player, "(say 1234567890123456789012)(say \x80)(say one two three)");
  CHECK(h.lines(2, "") == 0);
  h.act(h.goalie, "(say 123456789012345678901)");
  CHECK(h.lines(1, "say: expected at most 20 bytes, found 21") == 1);
}

TEST_CASE("a beam at the wrong time, beyond the limits or without a team is one line in the log", "[soccer]") {
  Mistakes h;
  h.expectOneLine("(beam 5 0 0)", "beam: expected x from -52 to 0, found 5: it is clamped");
  h.expectOneLine("(beam -5 -40 0)", "beam: expected y from -34 to 34, found -40: it is clamped");
  h.expectOneLine("(beam -5 0)", "beam: expected a number as argument 3, found none");
  h.expectOneLine("(beam -5 0 0 0)", "beam: expected 3 arguments, found 4: the others are ignored");
  h.expectOneLine("(beam -5 0 x)", "beam: expected a number as argument 3, found 'x', which counts as 0");
  h.setMode("PlayOn");
  h.expectOneLine("(beam -5 0 0)", "beam: expected a mode before a kick-off or after a goal, found PlayOn");
  Puppet& stranger = h.connect("stranger");
  h.text.clear();
  for (int i = 0; i < 3; ++i) h.act(stranger, "(beam -5 0 0)(say hi)(drive 1 0 0)(kick 0 10)(catch)");
  for (const char* predicate : {"beam", "say", "drive", "kick", "catch"})
    CHECK(h.lines(4, fmt::format("{}: expected a player of a team, found none: it needs (init ...) first",
                                 predicate)) == 1);
}

TEST_CASE("a kick, catch or pass that is not possible is one line in the log", "[soccer]") {
  Mistakes h;
  h.setMode("PlayOn");
  h.expectOneLine("(kick 0 10)", "kick: expected the ball within 0.37 m, found it at 22.3");
  h.expectOneLine("(kick 10)", "kick: expected a number as argument 2, found none");
  h.expectOneLine("(catch)", "catch: expected the goalie, number 1, found number 2");
  h.expectOneLine("(catch 1)", "catch: expected no arguments, found 1: they are ignored");
  h.expectOneLine("(drive 1 0)", "drive: expected a number as argument 3, found none");
  h.expectOneLine("(pantilt 1)", "pantilt: expected a number as argument 2, found none");
  setProperty(h.stateOf(2), "battery", 0);
  h.expectOneLine("(drive 9 0 0)", "drive: expected a battery with enough energy, found 0.00 % left");
  h.act(h.player, "(drive 0 0 0)");
  h.text.clear();
  for (int i = 0; i < 3; ++i) h.act(h.goalie, "(catch)");
  CHECK(h.lines(1, "catch: expected the ball in the own penalty area, found it elsewhere") == 1);
  h.placeBall(-45, 0);
  h.placeAgent(1, -50, 0);
  for (int i = 0; i < 3; ++i) h.act(h.goalie, "(catch)");
  INFO(h.text);
  CHECK(h.lines(1, "catch: expected the ball within 2.33 m, found it at 5") == 1);
}

TEST_CASE("a kick that just misses the ball, or comes while one is under way, is play and no mistake", "[soccer]") {
  Mistakes h;
  h.setMode("PlayOn");
  h.text.clear();
  h.placeBall(10, 0);
  h.placeAgent(2, 10 - 0.6, 0);
  h.act(h.player, "(kick 0 10)");
  CHECK(getProperty(h.at("/usr/scene/AgentAspect2/body/KickEffector"), "stepsLeft").toInteger() == 0);
  h.placeAgent(2, 10 - 0.34, 0);
  for (int i = 0; i < 3; ++i) h.act(h.player, "(kick 0 10)");
  CHECK(h.lines(2, "") == 0);
}

TEST_CASE("a pass that is refused is one line in the log, for each reason", "[soccer]") {
  Mistakes h;
  // The robots of 2004 have no pass effector.
  for (int agent : {1, 2, 3})
    h.kernel.create("PassEffector", fmt::format("/usr/scene/AgentAspect{}/body/PassEffector", agent));
  h.run(2);
  h.expectOneLine("(pass)", "pass: expected the mode PlayOn, found another");
  h.setMode("PlayOn");
  h.run(50);
  h.expectOneLine("(pass)", "pass: expected a player within PassModeMaxBallDist of the ball");
  h.ball().setVelocity(Vec3(5, 0, 0));
  h.expectOneLine("(pass)", "pass: expected a ball of at most PassModeMaxBallSpeed, found a faster one");
  setProperty(h.at("/sys/server/gamecontrol/SoccerRuleAspect/PassModeRule"), "enabled", false);
  h.expectOneLine("(pass)", "pass: expected an enabled PassModeRule, found a disabled one");
}

TEST_CASE("an init with other parts is executed and is one line in the log", "[soccer]") {
  SoccerMatch h;
  h.importField();
  Puppet& a = h.connect("a");
  const auto [action, line] = GENERATE(table<std::string, std::string>(
      {{"(init (unum seven)(teamname A))", "expected a number as unum, found 'seven', which counts as 0"},
       {"(init (unum 1)(teamname A)(role goalie))",
        "expected (unum n) and (teamname t), found 'role', which is ignored"},
       {"(init (unum)(teamname A))", "expected one word after 'unum', found 0"},
       {"(init A (unum 1)(teamname A))", "expected (unum n) and (teamname t), found 'A', which is ignored"}}));
  h.text.clear();
  h.act(a, action);
  h.run(1);
  INFO(h.text);
  CHECK(h.text.find("agent 1 (/usr/agent/a): init: " + line) != std::string::npos);
  CHECK(h.text.find("agent 1: plays for 'A' (left) with number 1") != std::string::npos);
}

TEST_CASE("an init that is refused for the same reason in every cycle is one line in the log", "[soccer]") {
  SoccerMatch h;
  h.importField();
  h.join("A", 1);
  Puppet& b = h.connect("b");
  h.text.clear();
  for (int i = 0; i < 5; ++i) h.act(b, "(init (unum 1)(teamname A))");
  h.run(1);
  CHECK(count(h.text, "agent 2: init refused: number 1 of team 'A' is taken") == 1);
  h.act(b, "(init)");
  h.run(1);
  CHECK(count(h.text, "agent 2: init refused: expected (teamname <name>) with a name, found none") == 1);
}

TEST_CASE("what players do right leaves no line in the log", "[soccer]") {
  Mistakes h;
  int warnings = 0;
  h.kernel.log().setSink([&](Level level, std::string_view line) {
    warnings += level >= Level::warning;
    h.text.append(line).append("\n");
  });
  h.act(h.player, "(beam -10 5 0)(say hello)(pantilt 5 5)(syn)");
  h.setMode("PlayOn");
  h.placeBall(10, 0);
  h.placeAgent(2, 10 - 0.35, 0);
  h.act(h.player, "(kick 30 10)(drive 1 2 0)(say 12345678901234567890)(syn)");
  h.run(20);
  CHECK(warnings == 0);
  CHECK(h.lines(2, "") == 0);
  h.expectOneLine("(kick 10)", "kick: expected a number as argument 2, found none");
  CHECK(warnings == 1);
}
