// Restarts, goals and the time of play.
#include "match_house.h"

using namespace spark;
using namespace spark::test;

namespace {

/// Two players per team: A1 A2 are agents 1 and 2, B1 B2 agents 3 and 4. In PlayOn, all far from the ball.
struct Match : SoccerMatch {
  Match() {
    importField();
    join("A", 1), join("A", 2), join("B", 1), join("B", 2);
    setMode("PlayOn");
    aside();
    placeBall(0, 0);
    run(1);
  }
  void aside() { placeAgent(1, -30, 20), placeAgent(2, -30, -20), placeAgent(3, 30, 20), placeAgent(4, 30, -20); }
  /// The agent touches the ball, then the ball is moved to x, y.
  void lastTouchThenBallAt(int agent, double x, double y) {
    touch(agent);
    aside();
    placeBall(x, y);
    run(1);
  }
};

}  // namespace

TEST_CASE("before the kick-off the ball is held and the time of play does not advance", "[soccer]") {
  SoccerMatch h;
  h.importField();
  h.join("A", 1);
  h.placeBall(5, 5);
  h.ball().setVelocity(Vec3(3, 0, 0));
  h.run(2);
  CHECK(h.mode() == "BeforeKickOff");
  CHECK(h.ball().state().position.isApprox(Vec3(0, 0, 0.111), 1e-6));
  CHECK(h.gameTime() == 0);
}

TEST_CASE("without agents no match starts", "[soccer]") {
  SoccerMatch h;
  h.importField();
  h.set("AutomaticKickOff", true);
  h.set("WaitBeforeKickOff", 0.1);
  h.run(20);
  CHECK(h.mode() == "BeforeKickOff");
}

TEST_CASE("an automatic kick-off comes after the waiting time, for the left team", "[soccer]") {
  SoccerMatch h;
  h.set("AutomaticKickOff", true);
  h.set("WaitBeforeKickOff", 1.0);
  h.importField();
  h.join("A", 1);
  h.run(20);
  CHECK(h.mode() == "BeforeKickOff");
  h.run(50);
  CHECK(h.mode() == "KickOff_Left");
  CHECK(h.gameTime() > 0);
}

TEST_CASE("at a kick-off players are kept in their halves and out of the circle, and a touch starts play", "[soccer]") {
  Match h;
  h.placeAgent(1, 20, 10);  // A in B's half
  h.placeAgent(3, -20, 0);  // B in A's half
  h.placeAgent(4, 5, 0);    // B in the circle
  CHECK(h.trainer("(kickOff Left)").empty());
  h.run(1);
  CHECK(h.bodyOf(1).state().position.x() == Approx(-10).margin(0.1));
  CHECK(h.bodyOf(3).state().position.x() > 0);
  CHECK(h.bodyOf(4).state().position.head<2>().norm() > 9.15);
  h.run(5);
  CHECK(h.mode() == "KickOff_Left");
  h.touch(2);
  CHECK(h.mode() == "PlayOn");
}

TEST_CASE("a ball in the goal box is a goal, and the other side kicks off", "[soccer]") {
  Match h;
  h.lastTouchThenBallAt(2, 53, 1);
  CHECK(h.mode() == "Goal_Left");
  CHECK(h.score() == "{1, 0}");
  h.runSeconds(2.9);
  CHECK(h.mode() == "Goal_Left");
  h.runSeconds(0.2);
  CHECK(h.mode() == "KickOff_Right");
  CHECK(h.ball().state().position.head<2>().norm() < 0.01);
  h.setMode("PlayOn");
  h.lastTouchThenBallAt(3, -53, -2);
  CHECK(h.mode() == "Goal_Right");
  CHECK(h.score() == "{1, 1}");
}

TEST_CASE("without the recorder a ball that crosses the goal line inside the goal is a goal, and beside it is not",
          "[soccer]") {
  Match h;
  h.set("RightGoalRecorder", "nowhere");
  h.connect("Bystander");  // changes the tree, so that paths are looked up again
  const double y = GENERATE(2.0, 5.0);
  h.touch(2);
  h.aside();
  h.placeBall(52.2, y, 0.3);
  h.ball().setVelocity(Vec3(20, 0, 0));
  h.run(1);
  CHECK(h.mode() == (y < 3 ? "Goal_Left" : "goal_kick_right"));
}

TEST_CASE("a ball over the touch line gives a kick-in to the other team", "[soccer]") {
  Match h;
  h.lastTouchThenBallAt(1, 10, 33.9);
  h.ball().setVelocity(Vec3(0, 20, 0));
  h.run(1);
  CHECK(h.mode() == "KickIn_Right");
  // After the pause the ball is fixed inside the line and the other team is kept away.
  h.placeAgent(1, 9, 33);
  h.runSeconds(1.1);
  const Vec3 b = h.ball().state().position;
  CHECK(b.x() == Approx(10).margin(0.1));
  CHECK(b.y() == Approx(34 - 0.111).margin(0.001));
  CHECK((h.bodyOf(1).state().position - b).norm() > 9);
  CHECK(h.mode() == "KickIn_Right");
  h.touch(4);
  CHECK(h.mode() == "PlayOn");
}

TEST_CASE("a ball over the goal line gives a goal kick or a corner kick", "[soccer]") {
  Match h;
  SECTION("a touch by the attackers gives a goal kick") {
    h.lastTouchThenBallAt(2, 52.3, 20);
    CHECK(h.mode() == "goal_kick_right");
    h.placeAgent(1, 45, 3);  // an opponent inside the area
    h.runSeconds(1.1);
    CHECK(h.ball().state().position.x() == Approx(51).margin(0.01));
    CHECK(h.bodyOf(1).state().position.x() < 52 - 16.5);
    h.touch(3);
    CHECK(h.mode() == "goal_kick_right");
    h.aside();
    h.placeBall(30, 0);
    h.run(1);
    CHECK(h.mode() == "PlayOn");
  }
  SECTION("a touch by the defenders gives a corner kick") {
    h.lastTouchThenBallAt(4, 52.3, -20);
    CHECK(h.mode() == "corner_kick_left");
    h.runSeconds(1.1);
    const Vec3 b = h.ball().state().position;
    CHECK(b.x() == Approx(52 - 0.111).margin(0.001));
    CHECK(b.y() == Approx(-((68 + 7.32) / 4 - 0.111)).margin(0.001));
    h.touch(2);
    CHECK(h.mode() == "PlayOn");
  }
}

TEST_CASE("near a corner the line that the whole ball crossed first decides", "[soccer]") {
  Match h;
  h.touch(2);
  h.aside();
  // Over both lines within one cycle; the right team defends the goal line.
  const bool touchLine = GENERATE(true, false);
  h.placeBall(52 - (touchLine ? 0.3 : 0.1), 34 - (touchLine ? 0.1 : 0.3), 0.3);
  h.run(1);
  h.ball().setVelocity(Vec3(38, 38, 0));
  h.run(1);
  CHECK(h.ball().state().position.x() > 52.2);
  CHECK(h.ball().state().position.y() > 34.2);
  CHECK(h.mode() == (touchLine ? "KickIn_Right" : "goal_kick_right"));
}

TEST_CASE("a goal is a ball that is wholly over the line between the posts, however it gets into the net", "[soccer]") {
  Match h;
  h.touch(2);
  h.aside();
  SECTION("a ball on the line is none") {
    h.placeBall(52.1, 1);
    h.run(3);
    CHECK(h.mode() == "PlayOn");
  }
  SECTION("nor one that passes beside the post into the goal") {
    h.placeBall(51.9, 3.9, 0.3);
    h.run(1);
    h.ball().setVelocity(Vec3(25, -25, 0));
    h.run(1);
    CHECK(h.mode() == "goal_kick_right");
  }
  SECTION("a ball that crosses the line between the posts is one") {
    h.placeBall(51.9, 3.3, 0.3);
    h.run(1);
    h.ball().setVelocity(Vec3(30, 5, 0));
    h.run(1);
    CHECK(h.mode() == "Goal_Left");
  }
}

TEST_CASE("of two players that touch the ball in a cycle the nearer one does, whichever joined first", "[soccer]") {
  Match h;
  const int nearer = GENERATE(1, 3);
  h.placeBall(0, 10);
  h.placeAgent(nearer, 0.29, 10);
  h.placeAgent(4 - nearer, -0.3, 10);
  h.run(1);
  CHECK(h.get("/sys/server/gamecontrol/BallStateAspect", "lastTeam").toString() == (nearer == 1 ? "left" : "right"));
}

TEST_CASE("of two players that are equally near a draw decides, and it holds while both touch the ball", "[soccer]") {
  Match h;
  const auto last = [&h] { return h.get("/sys/server/gamecontrol/BallStateAspect", "lastTeam").toString(); };
  int left = 0;
  for (int duel = 0; duel < 20; ++duel) {
    h.setMode("PlayOn");
    h.aside();
    h.run(6);
    std::string first;
    for (int cycle = 0; cycle < 3; ++cycle) {
      h.placeBall(0, 10);
      h.placeAgent(1, 0.29, 10);
      h.placeAgent(3, -0.29, 10);
      h.run(1);
      if (cycle == 0) first = last();
      CHECK(last() == first);
    }
    left += first == "left";
  }
  CHECK(left >= 4);
  CHECK(left <= 16);
}

TEST_CASE("without any touch so far a ball that goes out is moved back and gives no restart", "[soccer]") {
  Match h;
  h.placeBall(20, 36);
  h.run(2);
  CHECK(h.mode() == "PlayOn");
  CHECK(h.ball().state().position.y() < 34.2);
}

TEST_CASE("a restart without a touch becomes a drop ball", "[soccer]") {
  Match h;
  h.set("RuleDropBallTime", 3);
  h.lastTouchThenBallAt(1, 10, 35);
  CHECK(h.mode() == "KickIn_Right");
  h.placeAgent(2, 10, 30);
  h.placeAgent(4, 12, 30);
  h.runSeconds(3.1);
  CHECK(h.mode() == "PlayOn");
  const Vec3 b = h.ball().state().position;
  for (int agent : {2, 4}) CHECK((h.bodyOf(agent).state().position - b).norm() > 8);
}

TEST_CASE("a drop ball in a penalty area is placed at the area's corner", "[soccer]") {
  Match h;
  h.placeBall(48, -3);
  CHECK(h.trainer("(dropBall)").empty());
  h.run(1);
  CHECK(h.ball().state().position.isApprox(Vec3(52 - 16.5, -20.16, 0.111), 0.01));
}

TEST_CASE("the player that executes a restart may not touch the ball twice", "[soccer]") {
  Match h;
  h.trainer("(kickOff Left)");
  h.run(3);
  h.touch(1);
  CHECK(h.mode() == "PlayOn");
  h.aside();
  h.placeBall(3, 0);
  h.run(10);
  SECTION("a second touch gives the opponents a free kick") {
    h.touch(1);
    CHECK(h.mode() == "free_kick_right");
  }
  SECTION("a touch by a team-mate in between is allowed") {
    h.touch(2);
    h.aside();
    h.run(10);
    h.touch(1);
    CHECK(h.mode() == "PlayOn");
  }
}

TEST_CASE("a goal directly from the kick-off does not count", "[soccer]") {
  Match h;
  h.trainer("(kickOff Left)");
  h.run(3);
  h.touch(1);
  h.aside();
  h.placeBall(53, 0);
  h.run(1);
  CHECK(h.mode() == "goal_kick_right");
  CHECK(h.score() == "{0, 0}");
}

TEST_CASE("half time, the second half's kick-off and the end come at their times, and players get new batteries",
          "[soccer]") {
  Match h;
  h.set("RuleHalfTime", 1);
  h.set("AutomaticKickOff", true);
  h.set("WaitBeforeKickOff", 0.5);
  setProperty(h.stateOf(1), "battery", 40);
  setProperty(h.at("/sys/server/gamecontrol/GameStateAspect"), "time", 0.5);
  h.runSeconds(0.4);
  CHECK(getProperty(h.stateOf(1), "battery").toNumber() == 40);
  h.runSeconds(0.2);
  CHECK(getProperty(h.stateOf(1), "battery").toNumber() == 100);
  CHECK(h.mode() == "BeforeKickOff");
  CHECK(h.get("/sys/server/gamecontrol/GameStateAspect", "half").toInteger() == 2);
  const double before = h.gameTime();
  h.runSeconds(0.6);
  CHECK(h.mode() == "KickOff_Right");
  CHECK(h.gameTime() == Approx(before).margin(0.25));
  h.runSeconds(1.2);
  CHECK(h.mode() == "GameOver");
  h.setMode("PlayOn");  // set again until the time is set back
  h.run(1);
  CHECK(h.mode() == "GameOver");
}

TEST_CASE("with ChangeSidesInSecondHalf teams change sides at half time", "[soccer]") {
  Match h;
  h.set("RuleHalfTime", 1);
  h.set("ChangeSidesInSecondHalf", true);
  h.trainer("(score (left 2)(right 1))");
  setProperty(h.at("/sys/server/gamecontrol/GameStateAspect"), "time", 0.99);
  h.run(2);
  CHECK(h.score() == "{1, 2}");
  CHECK(h.get("/sys/server/gamecontrol/GameStateAspect", "teamLeft").toString() == "B");
  CHECK(getProperty(h.stateOf(1), "side").toString() == "right");
}

TEST_CASE("with a single half the match is over after that half", "[soccer]") {
  Match h;
  h.set("RuleHalfTime", 1);
  h.set("SingleHalfTime", true);
  setProperty(h.at("/sys/server/gamecontrol/GameStateAspect"), "time", 0.99);
  h.run(2);
  CHECK(h.mode() == "GameOver");
}

TEST_CASE("a match that is saved and restored continues identically", "[soccer]") {
  Match h;
  SECTION("in the pause of a kick-in") { h.lastTouchThenBallAt(1, 10, 35); }
  SECTION("after a kick-off, before the right to score") {
    h.trainer("(kickOff Left)");
    h.run(3);
    h.touch(1);
    h.aside();
    h.placeBall(52.5, 0);
  }
  SECTION("in pass mode") {
    h.setMode("pass_left");
    h.run(5);
  }
  Node& root = h.kernel.root();
  StateWriter saved(true);
  saveTree(root, saved);
  const std::uint64_t then = stateHash(root);
  h.run(80);
  const std::uint64_t later = stateHash(root);
  CHECK(later != then);
  StateReader in(saved.bytes());
  loadTree(root, in);
  CHECK(stateHash(root) == then);
  h.run(80);
  CHECK(stateHash(root) == later);
}
