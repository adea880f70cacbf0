#include <tuple>

#include "api/match.h"
#include "api/status.h"
#include "match_house.h"

using namespace spark;
using namespace spark::test;

// The interfaces through which plugins and programs without knowledge of the game use soccer.

TEST_CASE("the soccer status has play mode, score and teams") {
  SoccerMatch match;
  match.importField();
  const auto& game = match.kernel.root().require<IStatus>("/sys/server/gamecontrol/GameStateAspect");
  match.setMode("PlayOn");
  const List scores{3, 1};
  callMethod(match.at("/sys/server/gamecontrol/GameStateAspect"), "setScores", scores);
  match.join("Reds", 1);
  std::vector<StatusEntry> entries;
  game.report(entries);
  REQUIRE(entries.size() == 3);
  CHECK(entries[0].name == "playMode");
  CHECK(entries[0].value == Value("PlayOn"));
  CHECK(entries[1].name == "score");
  CHECK(entries[1].value == Value(List{3, 1}));
  CHECK(entries[1].parts ==
        std::vector<std::string>{"Left", "Right"});  // the columns scoreLeft and scoreRight of a batch
  CHECK(entries[2].name == "teams");
  CHECK(entries[2].value == Value(List{"Reds", ""}));
  CHECK(entries[2].parts == entries[1].parts);
  CHECK(std::all_of(entries.begin(), entries.end(), isStatusWord));
}

TEST_CASE("a player's state gives its team and number, and sonars detect it like a goal post") {
  SoccerMatch match;
  match.importField();
  match.connect("new");
  match.join("Reds", 7);
  const auto identity = [&](int agent) { return match.stateOf(agent).as<IAgentIdentity>(); };
  REQUIRE(identity(1));
  CHECK(identity(1)->team().empty());
  CHECK(identity(1)->number() == 0);
  CHECK(identity(2)->team() == "Reds");
  CHECK(identity(2)->number() == 7);
  CHECK(match.stateOf(1).as<IEchoTarget>());
  std::vector<IEchoTarget*> targets;
  match.kernel.root().require<Node>("/usr/scene").collect(targets);
  CHECK(targets.size() == 2 + 4);  // two robots, four posts
}

TEST_CASE("soccer reads team and number from (init ...)") {
  SoccerMatch match;
  const auto* policy = match.kernel.root().require<Node>("/sys/server/gamecontrol").childOf<IJoinPolicy>();
  REQUIRE(policy);
  CHECK(policy->predicate() == "init");
  for (const auto& [text, team, number] :
       {std::tuple{"(init (unum 7)(teamname A))", "A", 7}, std::tuple{"(init (teamname B)(unum 12))", "B", 12},
        std::tuple{"(init (teamname C))", "C", 0}, std::tuple{"(init)", "", 0},
        std::tuple{"(init (unum)(teamname))", "", 0}}) {
    Predicates message;
    readSexp(text, message);
    INFO(text);
    const IJoinPolicy::Name name = policy->read(*message.begin());
    CHECK(name.team == team);
    CHECK(name.number == number);
  }
}

TEST_CASE(
    "vision perceptors parse their own percepts into things, parts of players and lines, and ignore invalid items") {
  SoccerMatch match;
  auto& agent = match.kernel.create<Node>("AgentAspect", "/usr/scene/eyes");
  Predicates percept;
  readSexp(
      "(See (B (pol 1 -20 3.5)) (F1L (pol 2 3)) (P (team Red) (id 3) (head (pol 4 5 6)) (lfoot (pol 7 8 9)))"
      " (P (team Blue) (id 11) (pol 1 2 3)) (L (pol 1 2 3) (pol 4 5 6)) (L (pol 1 2 3)) (mypos 1 2 3) x ())",
      percept);
  for (const char* eye : {"VisionPerceptor", "RestrictedVisionPerceptor"}) {
    INFO(eye);
    const auto reader = agent.create(eye, eye).as<ISightReader>();
    REQUIRE(reader);
    ISightReader::Sightings seen;
    reader->read(*percept.begin(), seen);
    std::string text;
    for (const auto& t : seen.things)
      text += fmt::format("{}:{},{},{};", t.name, t.at.distance, t.at.horizontalDeg, t.at.verticalDeg);
    CHECK(text == "B:1,-20,3.5;P Red 3 head:4,5,6;P Red 3 lfoot:7,8,9;P Blue 11:1,2,3;");
    REQUIRE(seen.lines.size() == 1);
    CHECK(seen.lines[0].from.horizontalDeg == 2);
    CHECK(seen.lines[0].to.distance == 4);
  }
}
