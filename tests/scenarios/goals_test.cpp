// Goals, the rules that prevent them, the pause after a goal, and the penalty shoot-out.
#include "match.h"

using namespace spark;
using namespace spark::test;

namespace {}

TEST_CASE("A goal counts for the side that attacks that goal, whichever team touched the ball") {
  Match m;
  const bool right = GENERATE(true, false), own = GENERATE(true, false);
  m.touchThen(right != own ? m.a1 : m.b1, right ? kInRightGoal : kInLeftGoal);
  CHECK(m.mode() == (right ? "Goal_Left" : "Goal_Right"));
  CHECK(m.score() == (right ? std::pair(1, 0) : std::pair(0, 1)));
  m.checkModeSent(right ? "Goal_Left" : "Goal_Right");
  CHECK(m.a1.gs("sl") == (right ? "1" : "0"));
  CHECK(m.b2.gs("sr") == (right ? "0" : "1"));
}

TEST_CASE(
    "For 3 s after a goal the ball is free, players are moved to their halves and may beam, then the other side kicks "
    "off") {
  Match m;
  m.touchThen(m.a1, kInRightGoal);
  REQUIRE(m.mode() == "Goal_Left");
  const double goal = m.time();
  m.trainer(Match::put(m.a1, 4, 1) + Match::put(m.b1, 0.7, 0.6) + Match::put(m.b2, -4, 2));
  m.act(m.a2, "(beam -3 -4 0)");
  m.run(3);
  m.checkAt(m.a1, -2.5, 1);
  m.checkAt(m.a2, -3, -4);
  m.checkAt(m.b1, 0.7, 0.6);  // its side kicks off next
  m.checkAt(m.b2, 2.5, 2);
  CHECK(m.ball().x() > 15);
  CHECK(m.until("KickOff_Right", 5) > 0);
  CHECK(m.time() - goal == Approx(3.0).margin(kCycle));
  m.run(1);
  m.checkBall(0, 0, 0.001);
  m.act(m.a2, "(beam -9 4 0)");
  m.run(3);
  m.checkAt(m.a2, -3, -4);  // too late to beam
  m.trainer("(playMode PlayOn)");
  m.touchThen(m.b1, kInLeftGoal);
  CHECK(m.until("KickOff_Left", 5) > 0);
  CHECK(m.score() == std::pair(1, 1));
}

TEST_CASE("A ball that crosses the goal line inside the goal scores, and above the bar or beside the post it is out") {
  Match m{{{"Soccer.RightGoalRecorder", "nowhere"}, {"Soccer.LeftGoalRecorder", "nowhere"}}};
  struct Case {
    double x, y, z;
    const char* mode;
  };
  const Case c = GENERATE(Case{15, 0.5, 0.3, "Goal_Left"}, Case{-15, -0.5, 0.3, "Goal_Right"},
                          Case{15, 0.5, 1.2, "goal_kick_right"}, Case{15, 1.5, 0.3, "goal_kick_right"},
                          Case{-15, -1.5, 0.3, "corner_kick_right"});
  m.touchThen(m.a1, Match::ballTo(c.x, c.y, c.z, std::copysign(3, c.x)));
  CHECK(m.mode() == c.mode);
}

TEST_CASE("An indirect kick cannot score directly, and a direct kick only in the opponents' goal") {
  Match m;
  const std::string kick =
      GENERATE("KickIn_Left", "free_kick_left", "direct_free_kick_left", "corner_kick_left", "goal_kick_left");
  INFO(kick);
  const bool direct = kick != "KickIn_Left" && kick != "free_kick_left";
  m.trainer("(playMode " + kick + ")");
  m.run(55);
  m.touch(m.a1);
  SECTION("into the opponents' goal") {
    m.trainer(m.apart() + (kick == "goal_kick_left" ? Match::ballTo(-10, 0) : ""));
    m.trainer(kInRightGoal);
    CHECK(m.mode() == (direct ? "Goal_Left" : "goal_kick_right"));
    CHECK(m.score().first == (direct ? 1 : 0));
  }
  SECTION("into its own goal") {
    m.trainer(m.apart() + (kick == "goal_kick_left" ? Match::ballTo(-10, 0) : ""));
    m.trainer(kInLeftGoal);
    CHECK(m.mode() == "corner_kick_right");
    CHECK(m.score() == std::pair(0, 0));
  }
  SECTION("after a touch by another player") {
    m.trainer(m.apart() + Match::ballTo(-10, 0));
    m.run(1);
    m.touchThen(m.a2, kInRightGoal);
    CHECK(m.mode() == "Goal_Left");
  }
}

TEST_CASE("A ball in the goal does not count unless play is on") {
  Match m;
  const char* mode =
      GENERATE("BeforeKickOff", "KickOff_Left", "KickIn_Left", "goal_kick_right", "offside_left", "GameOver");
  INFO(mode);
  m.trainer(std::string("(playMode ") + mode + ")");
  m.trainer(kInRightGoal);
  m.run(3);
  CHECK(m.mode() == mode);
  CHECK(m.score() == std::pair(0, 0));
}

TEST_CASE("A trainer sets the score, and agents and monitors receive it") {
  Match m;
  m.trainer("(score (left 2)(right 1))");
  CHECK(m.score() == std::pair(2, 1));
  m.trainer("(score (left 5))(score (left -1)(right 0))");
  CHECK(m.score() == std::pair(2, 1));
  m.run(1);
  CHECK(m.b1.gs("sl") == "2");
}

TEST_CASE("In a shoot-out the kick-off may score, the goalie must stay in its area, and a goal ends it") {
  Match m{{{"Soccer.PenaltyShootout", true}}};
  m.trainer(Match::put(m.b1, 14, 0.5) + Match::put(m.b2, 14, -2) + "(kickOff Left)(score (left 0)(right 0))");
  m.run(1);
  m.trainer(m.against(m.a1));
  REQUIRE(m.mode() == "PlayOn");
  SECTION("a goal") {
    m.trainer(Match::put(m.a1, -5, 5) + kInRightGoal);
    CHECK(m.mode() == "Goal_Left");
    CHECK(m.score() == std::pair(1, 0));
    CHECK(m.until("GameOver", 4) == Approx(3.0).margin(kCycle));
  }
  SECTION("the goalie leaves its area") {
    m.run(5);
    CHECK(m.mode() == "PlayOn");
    m.trainer(Match::put(m.b1, 13.1, 0.5));
    CHECK(m.mode() == "Goal_Left");
    CHECK(m.score() == std::pair(1, 0));
  }
  SECTION("the goalie may be in its goal") {
    m.trainer(Match::put(m.b1, 15.2, 0));
    m.run(2);
    CHECK(m.mode() == "PlayOn");
  }
}
