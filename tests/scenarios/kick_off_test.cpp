// Before the kick-off, and the kick-off itself: who stands where, who may touch, when play goes on.
#include "match.h"

using namespace spark;
using namespace spark::test;

TEST_CASE("Agents join, are told their team once, and stand at the start positions") {
  Stadium s;
  Player& a = s.join("A", 1);
  Player& b = s.join("B", 7);
  CHECK(a.side == Side::left);
  CHECK(b.side == Side::right);
  CHECK(s.monitor().text("team_left") == "A");
  CHECK(s.monitor().text("team_right") == "B");
  CHECK(s.at(a).x() == Approx(-14.2).margin(0.05));
  CHECK(s.at(b).x() == Approx(14.2).margin(0.05));
  CHECK(a.gs("pm") == "BeforeKickOff");
  CHECK(a.gs("unum").empty());
  CHECK(a.gs("t") == "0.00");
}

TEST_CASE("Before the kick-off the ball is held, the clock stands, teams stay in their halves, beams work") {
  Match m;
  m.trainer("(playMode BeforeKickOff)");
  const double then = m.time();
  m.trainer(Match::ballTo(3, 3, 1) + Match::put(m.a1, 4, 3) + Match::put(m.b1, -0.05, -5));
  m.run(2);
  CHECK(m.mode() == "BeforeKickOff");
  CHECK(m.time() == then);
  m.checkBall(0, 0);
  CHECK(m.ball().z() == Approx(0.042).margin(0.001));
  m.checkAt(m.a1, -2.5, 3);
  m.checkAt(m.b1, 2.5, -5);  // some of him was in the other half
  m.act(m.a1, "(beam -5 4 0)");
  m.act(m.b1, "(beam 3 2 0)");  // ends at the middle line, and the referee moves him away from there
  m.run(3);
  m.checkAt(m.a1, -5, 4);
  m.checkAt(m.b1, 2.5, -2);
  m.checkTold("BeforeKickOff");
}

TEST_CASE("Before the kick-off nobody is moved when starts are free") {
  Match m{{{"Soccer.StartAnyFieldPosition", true}}};
  m.trainer("(playMode BeforeKickOff)" + Match::put(m.a1, 4, 3));
  m.run(3);
  m.checkAt(m.a1, 4, 3);
}

TEST_CASE("At a kick-off the others leave the half and the circle, the kicking team may stand in the circle") {
  Match m;
  m.trainer("(time 0)(kickOff Left)" + Match::put(m.a1, 3, 1) + Match::put(m.a2, 0.5, 0.6) + Match::put(m.b1, -3, 2) +
            Match::put(m.b2, 1.2, -0.5));
  CHECK(m.mode() == "KickOff_Left");
  CHECK(m.time() == Approx(0.02));
  m.run(1);
  m.checkAt(m.a1, -2.5, 1);
  m.checkAt(m.a2, 0.5, 0.6);
  m.checkAt(m.b1, 2.5, 2);
  m.checkAt(m.b2, 2.5, -0.5);
  m.checkTold("KickOff_Left");
  CHECK(m.a1.gs("t") == "0.04");  // of the cycle before: what is sensed leaves with the next
  m.touch(m.a2);
  CHECK(m.mode() == "PlayOn");
  m.checkTold("PlayOn");
}

TEST_CASE("The right team's kick-off is the mirror image") {
  Match m;
  m.trainer("(kickOff Right)" + Match::put(m.b1, -3, 1) + Match::put(m.b2, -0.5, 0.6) + Match::put(m.a1, 3, 2) +
            Match::put(m.a2, -1.2, -0.5));
  CHECK(m.mode() == "KickOff_Right");
  m.run(1);
  m.checkAt(m.b1, 2.5, 1);
  m.checkAt(m.b2, -0.5, 0.6);
  m.checkAt(m.a1, -2.5, 2);
  m.checkAt(m.a2, -2.5, -0.5);
  m.touch(m.a1, 1);  // anybody's touch starts the play
  CHECK(m.mode() == "PlayOn");
}

TEST_CASE("A kick-off that nobody takes is a drop ball after 15 s") {
  Match m;
  m.trainer("(playMode BeforeKickOff)(time 0)");
  m.trainer("(kickOff Left)" + Match::put(m.a2, -0.6, 0));
  CHECK(m.until("PlayOn", 20) > 0);
  CHECK(m.time() == Approx(15.0).margin(0.001));
  m.run(1);
  CHECK(m.a1.gs("t") == "15.00");
  m.checkBall(0, 0);
  m.checkAt(m.a2, -2.5, 0);  // cleared as everybody
}

TEST_CASE("A trainer who sets the clock ahead ends a kick-off, as recorded of the installed base") {
  Match m;
  m.trainer("(kickOff Right)");
  m.run(10);
  m.trainer("(time 123.5)");
  CHECK(m.mode() == "PlayOn");
  CHECK(m.time() == Approx(123.52));
}

TEST_CASE("Kick-off for nobody in particular: left, then a coin; in the second half the other team") {
  Match m;
  m.trainer("(playMode BeforeKickOff)(kickOff None)");
  CHECK(m.mode() == "KickOff_Left");
  int left = 0;
  for (int i = 0; i < 40; ++i) {
    m.trainer("(playMode PlayOn)(kickOff None)");
    left += m.mode() == "KickOff_Left";
  }
  CHECK(left > 5);
  CHECK(left < 35);
  m.trainer("(time 299.99)");
  CHECK(m.until("BeforeKickOff", 1) >= 0);
  m.trainer("(kickOff None)");
  CHECK(m.mode() == "KickOff_Right");
  m.trainer("(playMode PlayOn)(kickOff)(kickOff left)");  // no such side
  CHECK(m.mode() == "PlayOn");
}

TEST_CASE("A coin decides the first kick-off when it is asked") {
  bool left = false, right = false;
  for (int agents = 0; agents < 12 && !(left && right); ++agents) {
    Stadium s{{{"Soccer.CoinTossForKickOff", true}}};
    s.join("A", 1);
    for (int i = 0; i < agents; ++i) s.trainer("(dropBall)(playMode BeforeKickOff)");  // draws of the referee's dice
    s.trainer("(kickOff None)");
    left |= s.mode() == "KickOff_Left";
    right |= s.mode() == "KickOff_Right";
  }
  CHECK(left);
  CHECK(right);
}

TEST_CASE("An automatic kick-off comes when agents have been there for the wait") {
  Stadium s{{{"Soccer.AutomaticKickOff", true}, {"Soccer.WaitBeforeKickOff", 2.0}}};
  s.seconds(5);
  CHECK(s.mode() == "BeforeKickOff");
  s.connect();
  CHECK(s.until("KickOff_Left", 5) == Approx(1.98));  // the cycle of the connection was the first
  CHECK(s.time() == 0);
  s.run(1);
  CHECK(s.time() == Approx(0.02));
}

TEST_CASE("Straight from the kick-off nobody scores") {
  Match m;
  m.trainer("(playMode BeforeKickOff)");
  m.trainer("(kickOff Left)");
  m.run(1);
  SECTION("into the others' goal: a goal kick") {
    m.touchThen(m.a1, Match::ballTo(15.3, 0.2, 0.1));
    CHECK(m.mode() == "goal_kick_right");
    CHECK(m.score() == std::pair(0, 0));
  }
  SECTION("into the own goal: a corner") {
    m.touchThen(m.a1, Match::ballTo(-15.3, 0.2, 0.1));
    CHECK(m.mode() == "corner_kick_right");
    CHECK(m.score() == std::pair(0, 0));
  }
  SECTION("a team-mate inside the circle does not earn it") {
    m.touchThen(m.a1, Match::ballTo(1, 0));
    m.touchThen(m.a2, Match::ballTo(15.3, 0.2, 0.1));
    CHECK(m.mode() == "goal_kick_right");
  }
  SECTION("a team-mate outside of the circle earns it") {
    m.touchThen(m.a1, Match::ballTo(2.3, 0));
    m.touchThen(m.a2, Match::ballTo(15.3, 0.2, 0.1));
    CHECK(m.mode() == "Goal_Left");
    CHECK(m.score() == std::pair(1, 0));
  }
  SECTION("an opponent's touch earns it") {
    m.touchThen(m.a1, Match::ballTo(1, 0));
    m.touchThen(m.b2, Match::ballTo(15.3, 0.2, 0.1));
    CHECK(m.mode() == "Goal_Left");
  }
}

TEST_CASE("Two alone may score straight from the kick-off") {
  Stadium s;
  Player& a = s.join("A", 1);
  s.join("B", 1);
  s.trainer("(kickOff Left)");
  s.run(1);
  s.trainer(s.against(a));
  s.trainer(Stadium::put(a, -5, 5) + Stadium::ballTo(15.3, 0.2, 0.1));
  CHECK(s.mode() == "Goal_Left");
}
