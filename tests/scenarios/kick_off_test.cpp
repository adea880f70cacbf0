// Before the kick-off, and the kick-off itself: positions of the players, allowed touches, start of play.
#include "match.h"

using namespace spark;
using namespace spark::test;

TEST_CASE("Agents join, receive their team once, and are at the start positions") {
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

TEST_CASE("Before the kick-off ball and time are held, and players are kept in their halves and may beam") {
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
  m.checkAt(m.b1, 2.5, -5);  // part of it was in the other half
  m.act(m.a1, "(beam -5 4 0)");
  m.act(m.b1, "(beam 3 2 0)");  // ends at the middle line, and the referee moves it away from there
  m.run(3);
  m.checkAt(m.a1, -5, 4);
  m.checkAt(m.b1, 2.5, -2);
  m.checkModeSent("BeforeKickOff");
}

TEST_CASE("With StartAnyFieldPosition no player is moved before the kick-off") {
  Match m{{{"Soccer.StartAnyFieldPosition", true}}};
  m.trainer("(playMode BeforeKickOff)" + Match::put(m.a1, 4, 3));
  m.run(3);
  m.checkAt(m.a1, 4, 3);
}

TEST_CASE(
    "At a kick-off opponents are moved out of the half and the circle, and the kicking team may be in the circle") {
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
  m.checkModeSent("KickOff_Left");
  CHECK(m.a1.gs("t") == "0.04");  // the percepts of the previous cycle
  m.touch(m.a2);
  CHECK(m.mode() == "PlayOn");
  m.checkModeSent("PlayOn");
}

TEST_CASE("The right team's kick-off is the mirror image of the left team's") {
  Match m;
  m.trainer("(kickOff Right)" + Match::put(m.b1, -3, 1) + Match::put(m.b2, -0.5, 0.6) + Match::put(m.a1, 3, 2) +
            Match::put(m.a2, -1.2, -0.5));
  CHECK(m.mode() == "KickOff_Right");
  m.run(1);
  m.checkAt(m.b1, 2.5, 1);
  m.checkAt(m.b2, -0.5, 0.6);
  m.checkAt(m.a1, -2.5, 2);
  m.checkAt(m.a2, -2.5, -0.5);
  m.touch(m.a1, 1);  // a touch by any player starts play
  CHECK(m.mode() == "PlayOn");
}

TEST_CASE("A kick-off without a touch becomes a drop ball after 15 s") {
  Match m;
  m.trainer("(playMode BeforeKickOff)(time 0)");
  m.trainer("(kickOff Left)" + Match::put(m.a2, -0.6, 0));
  CHECK(m.until("PlayOn", 20) > 0);
  CHECK(m.time() == Approx(15.0).margin(0.001));
  m.run(1);
  CHECK(m.a1.gs("t") == "15.00");
  m.checkBall(0, 0);
  m.checkAt(m.a2, -2.5, 0);  // moved away like all players
}

TEST_CASE("A trainer that advances the time of play ends a kick-off, as recorded with the original server") {
  Match m;
  m.trainer("(kickOff Right)");
  m.run(10);
  m.trainer("(time 123.5)");
  CHECK(m.mode() == "PlayOn");
  CHECK(m.time() == Approx(123.52));
}

TEST_CASE("(kickOff None) gives left, then a random side, and in the second half the other team") {
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
  m.trainer("(playMode PlayOn)(kickOff)(kickOff left)");  // invalid sides
  CHECK(m.mode() == "PlayOn");
}

TEST_CASE("With CoinTossForKickOff the first kick-off is random") {
  bool left = false, right = false;
  for (int agents = 0; agents < 12 && !(left && right); ++agents) {
    Stadium s{{{"Soccer.CoinTossForKickOff", true}}};
    s.join("A", 1);
    for (int i = 0; i < agents; ++i)
      s.trainer("(dropBall)(playMode BeforeKickOff)");  // advances the referee's random numbers
    s.trainer("(kickOff None)");
    left |= s.mode() == "KickOff_Left";
    right |= s.mode() == "KickOff_Right";
  }
  CHECK(left);
  CHECK(right);
}

TEST_CASE("An automatic kick-off comes WaitBeforeKickOff after the first agent connected") {
  Stadium s{{{"Soccer.AutomaticKickOff", true}, {"Soccer.WaitBeforeKickOff", 2.0}}};
  s.seconds(5);
  CHECK(s.mode() == "BeforeKickOff");
  s.connect();
  CHECK(s.until("KickOff_Left", 5) == Approx(1.98));  // counts the cycle of the connection
  CHECK(s.time() == 0);
  s.run(1);
  CHECK(s.time() == Approx(0.02));
}

TEST_CASE("A kick-off cannot score directly") {
  Match m;
  m.trainer("(playMode BeforeKickOff)");
  m.trainer("(kickOff Left)");
  m.run(1);
  SECTION("a ball in the opponents' goal is a goal kick") {
    m.touchThen(m.a1, Match::ballTo(15.3, 0.2, 0.1));
    CHECK(m.mode() == "goal_kick_right");
    CHECK(m.score() == std::pair(0, 0));
  }
  SECTION("a ball in its own goal is a corner kick") {
    m.touchThen(m.a1, Match::ballTo(-15.3, 0.2, 0.1));
    CHECK(m.mode() == "corner_kick_right");
    CHECK(m.score() == std::pair(0, 0));
  }
  SECTION("a touch by a team-mate inside the circle is not enough") {
    m.touchThen(m.a1, Match::ballTo(1, 0));
    m.touchThen(m.a2, Match::ballTo(15.3, 0.2, 0.1));
    CHECK(m.mode() == "goal_kick_right");
  }
  SECTION("a touch by a team-mate outside the circle is enough") {
    m.touchThen(m.a1, Match::ballTo(2.3, 0));
    m.touchThen(m.a2, Match::ballTo(15.3, 0.2, 0.1));
    CHECK(m.mode() == "Goal_Left");
    CHECK(m.score() == std::pair(1, 0));
  }
  SECTION("a touch by an opponent is enough") {
    m.touchThen(m.a1, Match::ballTo(1, 0));
    m.touchThen(m.b2, Match::ballTo(15.3, 0.2, 0.1));
    CHECK(m.mode() == "Goal_Left");
  }
}

TEST_CASE("With one player per team the kick-off may score directly") {
  Stadium s;
  Player& a = s.join("A", 1);
  s.join("B", 1);
  s.trainer("(kickOff Left)");
  s.run(1);
  s.trainer(s.against(a));
  s.trainer(Stadium::put(a, -5, 5) + Stadium::ballTo(15.3, 0.2, 0.1));
  CHECK(s.mode() == "Goal_Left");
}
