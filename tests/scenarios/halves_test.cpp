// The time of play: halves, the change of sides, the end.
#include "match.h"

using namespace spark;
using namespace spark::test;

TEST_CASE("After 300 s the second half waits for its kick-off, and after 600 s the match is over") {
  Match m;
  m.trainer("(time 299.9)");
  CHECK(m.until("BeforeKickOff", 1) > 0);
  CHECK(m.monitor().number("half") == 2);
  CHECK(m.time() == Approx(300.0).margin(kCycle));
  const double then = m.time();
  m.seconds(2);
  CHECK(m.time() == then);
  m.checkModeSent("BeforeKickOff");
  CHECK(m.a1.gs("t") == fmt::format("{:.2f}", then));
  m.checkBall(0, 0, 0.001);
  m.trainer("(kickOff None)");
  CHECK(m.mode() == "KickOff_Right");
  m.trainer("(time 599.9)(playMode PlayOn)");
  CHECK(m.until("GameOver", 1) > 0);
  CHECK(m.time() == Approx(600.0).margin(kCycle));
  CHECK(m.monitor().number("half") == 2);
  m.checkModeSent("GameOver");
  m.seconds(11);
  CHECK(m.time() == Approx(600.0).margin(0.001));
  CHECK_FALSE(m.over());
}

TEST_CASE("The match ends again until a trainer sets the time back, which does not set the half back") {
  Match m;
  m.trainer("(time 300)");
  m.run(1);
  m.trainer("(kickOff Left)(time 600)");
  m.run(1);
  CHECK(m.mode() == "GameOver");
  m.trainer("(playMode PlayOn)");
  CHECK(m.mode() == "GameOver");
  m.trainer("(time 100)(playMode PlayOn)");
  m.run(5);
  CHECK(m.mode() == "PlayOn");
  CHECK(m.monitor().number("half") == 2);
  CHECK(m.time() == Approx(100.12));
}

TEST_CASE("GameOver by a trainer persists and stops the time of play") {
  Match m;
  m.trainer("(playMode GameOver)");
  const double then = m.time();
  m.seconds(1);
  CHECK(m.mode() == "GameOver");
  CHECK(m.time() == then);
  m.trainer("(playMode PlayOn)");
  m.run(1);
  CHECK(m.mode() == "PlayOn");
  CHECK(m.time() == Approx(then + 0.04));
}

TEST_CASE("With a single half the match is over after that half") {
  Match m{{{"Soccer.SingleHalfTime", true}, {"Soccer.RuleHalfTime", 2.0}}};
  CHECK(m.until("GameOver", 3) > 0);
  CHECK(m.monitor().number("half") == 1);
  CHECK(m.time() == Approx(2.0).margin(kCycle));
}

TEST_CASE("With AutomaticQuit the simulation ends 10 s after the match") {
  Match m{{{"Soccer.AutomaticQuit", true}}};
  m.trainer("(playMode GameOver)");
  m.seconds(9.96);
  CHECK_FALSE(m.over());
  m.run(1);
  CHECK(m.over());
}

TEST_CASE(
    "Teams change sides at half time with their names, shirts and scores, and agents are notified unless disabled") {
  const bool announced = GENERATE(true, false);
  Match m{{{"Soccer.ChangeSidesInSecondHalf", true}, {"Soccer.AnnounceSides", announced}}};
  m.trainer("(score (left 2)(right 1))");
  const int full = m.monitor().fullMessages();
  m.trainer("(time 300)");
  m.run(1);
  CHECK(m.a1.gs("team") == (announced ? "right" : ""));
  CHECK(m.a1.gs("unum") == (announced ? "1" : ""));
  CHECK(m.b1.gs("team") == (announced ? "left" : ""));
  m.run(1);
  CHECK(m.monitor().fullMessages() > full);
  CHECK(m.monitor().number("half") == 2);
  CHECK(m.monitor().text("team_left") == "B");
  CHECK(m.monitor().text("team_right") == "A");
  CHECK(m.score() == std::pair(1, 2));
  m.a1.side = Side::right;
  m.b1.side = Side::left;
  m.checkAt(m.a1, 2.5, 7);  // it was in the left half, which is now the opponents' half
  m.checkAt(m.b1, -2.5, 7);
  CHECK(m.a1.gs("team").empty());
  CHECK(m.a1.gs("sr") == "2");
  m.trainer("(kickOff None)");
  CHECK(m.mode() == "KickOff_Left");  // the other team, which now plays on the left
  m.trainer("(playMode PlayOn)");
  m.trainer(Match::ballTo(0, 0) + m.apart());
  m.run(2);
  m.touch(m.b1);
  m.trainer(Match::put(m.b1, -8, 7) + Match::ballTo(15.3, 0, 0.1));
  CHECK(m.mode() == "Goal_Left");
  CHECK(m.score() == std::pair(2, 2));
}
