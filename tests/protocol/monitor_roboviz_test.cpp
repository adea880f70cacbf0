#include <catch2/catch.hpp>

#include "league.h"
#include "roboviz.h"

// The requirements of RoboViz as a checklist, in a match of Naos. If one is not met, RoboViz throws or draws nothing.

using namespace spark;
using namespace spark::test;

namespace {

/// Naos of all types in two teams, and a monitor.
struct Match {
  League league;
  StrictMonitor monitor;
  FakeConnection& connection;
  std::vector<FakeConnection*> agents;

  Match() : connection(league.connectMonitor()) { take(); }
  void take() {
    if (const std::string message = connection.read(); !message.empty()) monitor.read(message);
  }
  void run(int cycles) {
    for (int i = 0; i < cycles; ++i) {
      league.run();
      take();
      for (FakeConnection* a : agents) a->read();
    }
  }
  void join(const std::string& team, int unum, int type) {
    agents.push_back(&league.connectAgent());
    league.fromAgent(*agents.back(), fmt::format("(scene rsg/agent/nao/nao_hetero.rsg {})", type));
    run(6);
    league.fromAgent(*agents.back(), fmt::format("(init (unum {})(teamname {}))", unum, team));
    run(6);
  }
  void say(const std::string& command) {
    REQUIRE(command.size() < 128);  // RoboViz sends no longer commands
    league.fromMonitor(connection, command);
    run(2);
  }
};

}  // namespace

TEST_CASE("The first message comes with the connection, is full, and has every entry that RoboViz needs") {
  Match m;
  CHECK(m.monitor.fulls == 1);
  for (const char* key : {"FieldLength",
                          "FieldWidth",
                          "FieldHeight",
                          "GoalWidth",
                          "GoalDepth",
                          "GoalHeight",
                          "FreeKickDistance",
                          "WaitBeforeKickOff",
                          "AgentRadius",
                          "BallRadius",
                          "BallMass",
                          "RuleGoalPauseTime",
                          "RuleKickInPauseTime",
                          "RuleHalfTime",
                          "PassModeMinOppBallDist",
                          "PassModeDuration",
                          "time",
                          "half",
                          "score_left",
                          "score_right",
                          "play_mode"})
    CHECK(m.monitor.env.count(key) == 1);
  CHECK(m.monitor.playModes.size() == 21);
  CHECK(m.monitor.env.count("team_left") == 0);
  const auto* ball = m.monitor.mesh("soccerball.obj");
  REQUIRE(ball);
  CHECK(ball->visible);
  CHECK(ball->scale[0] == Approx(0.042));
  for (const char* own : {"field.obj", "skybox.obj", "leftsoccergoal.obj", "rightsoccergoal.obj"})
    CHECK(m.monitor.mesh(own));
}

TEST_CASE("Players get number, color, head and body below a top-level node of their own once they have a team") {
  Match m;
  int before = m.monitor.fulls;
  const auto grew = [&] { return std::exchange(before, m.monitor.fulls) < m.monitor.fulls; };
  for (int type = 0; type < 5; ++type) {
    m.join("Red", type + 1, type);
    CHECK(grew());
    m.join("Blue", 11 - type, type);
    CHECK(grew());
  }
  CHECK(m.monitor.env["team_left"] == "Red");
  CHECK(m.monitor.env["team_right"] == "Blue");
  for (int type = 0; type < 5; ++type)
    for (const bool left : {true, false}) {
      const auto* top = m.monitor.player(left, left ? type + 1 : 11 - type);
      INFO("type " << type << (left ? " left" : " right"));
      REQUIRE(top);
      CHECK(StrictMonitor::playersBelow(*top).size() == 1);
      const auto mesh = [&](const std::regex& name) {
        return StrictMonitor::find({*top}, [&](const auto& n) {
                 return StrictMonitor::isMesh(n) && n.visible && std::regex_match(n.mesh, name);
               }) != nullptr;
      };
      CHECK(mesh(std::regex(".*head\\.obj")));
      CHECK(mesh(std::regex("models/naobody" + std::to_string(type) + "\\.obj")));
      CHECK(mesh(std::regex(".*body.*\\.obj")));
    }
  // Every visible mesh has (setVisible 1); only the markers are hidden.
  int hidden = 0, shown = 0;
  StrictMonitor::find(m.monitor.scene, [&](const auto& n) {
    if (StrictMonitor::isMesh(n)) ++(n.visible ? shown : hidden);
    return false;
  });
  CHECK(hidden == 10);
  CHECK(shown > 10 * 20);
}

TEST_CASE("Diffs have the shape of the last full message through all changes of the tree") {
  Match m;
  m.join("Red", 1, 0);
  m.join("Blue", 1, 4);
  m.run(100);
  const int fulls = m.monitor.fulls, diffs = m.monitor.diffs;
  m.run(50);
  CHECK(m.monitor.fulls == fulls);
  CHECK(m.monitor.diffs == diffs + 25);  // one per 0.04 s
  m.say("(kill (unum 1)(team Right))");
  m.run(4);
  CHECK(m.monitor.fulls > fulls);
  CHECK(!m.monitor.player(false, 1));
  m.league.kernel.root().require<IConnectionConsumer>("/sys/server/gamecontrol").disconnected(*m.agents[0]);
  m.run(4);
  CHECK(!m.monitor.player(true, 1));
}

TEST_CASE("The commands of RoboViz are accepted in its format, and a full state follows its request") {
  Match m;
  m.join("Red", 3, 0);
  m.say("(kickOff Left)");
  CHECK(m.monitor.playModes.at(std::stoul(m.monitor.env["play_mode"])) == "KickOff_Left");
  const int fulls = m.monitor.fulls;
  m.say("(reqfullstate)");
  CHECK(m.monitor.fulls == fulls + 1);
  m.say("(playMode PlayOn)");
  CHECK(m.monitor.playModes.at(std::stoul(m.monitor.env["play_mode"])) == "PlayOn");
  const double time = std::stod(m.monitor.env["time"]);
  m.run(2);
  CHECK(std::stod(m.monitor.env["time"]) == Approx(time + 0.04));
  m.say("(ball (pos 3.00 -2.00 0.04) (vel 0.00 0.00 0.00))");
  m.say("(agent (team Left)(unum 3)(pos -2.00 1.00 0.40))");
  m.say("(dropBall)");
  m.say("(time 0)");
  CHECK(std::stod(m.monitor.env["time"]) <= 0.08);
  m.say("(playMode free_kick_left)");
  CHECK(m.monitor.playModes.at(std::stoul(m.monitor.env["play_mode"])) == "free_kick_left");
  m.say("(killsim)");
  CHECK(m.league.kernel.stopRequested());
}

TEST_CASE("Each foul is reported once, numbered from 1, with a type that RoboViz knows") {
  Match m;
  m.join("Red", 1, 0);
  m.say("(playMode PlayOn)");
  Leaf& referee = m.league.at("/sys/server/gamecontrol/SoccerRuleAspect");
  for (int type = 0; type < 8; ++type) callMethod(referee, "reportFoul", std::vector<Value>{type, "left", 1});
  m.run(6);
  REQUIRE(m.monitor.fouls.size() == 8);
  for (int i = 0; i < 8; ++i) CHECK(m.monitor.fouls[static_cast<std::size_t>(i)] == std::array<int, 4>{i + 1, i, 1, 1});
}
