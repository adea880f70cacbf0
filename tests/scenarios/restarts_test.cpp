// Kick-ins, corner kicks, goal kicks, free kicks, drop balls: their causes, the pause, the players moved, their end.
#include "match.h"

using namespace spark;
using namespace spark::test;

namespace {
constexpr double kLine = 20.0 / 2 - 0.042, kEnd = 30.0 / 2 - 0.042;  // m: the ball just inside the field
constexpr double kCorner = (20 + 2.1) / 4 - 0.042;                   // m
}  // namespace

TEST_CASE("A ball over the touch line gives the opponents a kick-in where it left the field") {
  Match m;
  const bool left = GENERATE(true, false);
  const double y = GENERATE(1.0, -1.0);
  m.touchThen(left ? m.b1 : m.a1, Match::ballTo(3, 9.9 * y, 0.042, 0, 3 * y));
  const double took = m.until(left ? "KickIn_Left" : "KickIn_Right", 1);
  CHECK(took >= 0);
  CHECK(std::abs(m.ball().y()) > 10.042);
  m.checkModeSent(left ? "KickIn_Left" : "KickIn_Right");
  m.run(48);  // 0.98 s: until then the ball rolls freely
  CHECK(std::abs(m.ball().y()) > 11);
  m.run(2);
  m.checkBall(3, kLine * y, 0.001);
}

TEST_CASE("A kick-in has a pause, then opponents and kicking team are moved away, and a touch ends it") {
  Match m;
  m.touchThen(m.a1, Match::ballTo(3, 9.9, 0.042, 0, 3));
  REQUIRE(m.until("KickIn_Right", 0.2) >= 0);
  m.trainer(Match::put(m.a1, 3, 9) + Match::put(m.a2, 3, 7.7) + Match::put(m.b2, 3.2, 9.8));
  m.run(48);  // 49 cycles since the award
  m.checkAt(m.a1, 3, 9);
  m.checkAt(m.b2, 3.2, 9.8);
  m.run(2);
  CHECK(m.mode() == "KickIn_Right");
  m.checkAt(m.a1, 0.5, 9);  // 2.5 m towards its own end
  m.checkAt(m.a2, 3, 7.7);  // just outside the distance
  CHECK(Match::distance(m.at(m.b2), Vec3(3, kLine, 0)) == Approx(0.5).margin(0.01));
  m.trainer(Match::put(m.b2, 3.25, 9.8));  // the kicking team is pushed only once
  m.run(2);
  m.checkAt(m.b2, 3.25, 9.8);
  m.checkBall(3, kLine, 0.001);
  m.touch(m.b2);
  CHECK(m.mode() == "PlayOn");
}

TEST_CASE("A touch ends a restart only from 0.03 s after the pause") {
  Match m;
  m.trainer("(playMode free_kick_left)");
  m.run(49);  // the next cycle is 1.02 s after the award
  m.touch(m.a1);
  CHECK(m.mode() == "free_kick_left");
  m.run(1);
  CHECK(m.mode() == "PlayOn");
}

TEST_CASE("A restart set by a trainer has its position, its pause, and a drop ball after 15 s") {
  Match m;
  struct Case {
    const char* mode;
    double x, y;
  };
  const Case c =
      GENERATE(Case{"KickIn_Left", 5, kLine}, Case{"KickIn_Right", 5, kLine}, Case{"corner_kick_left", kEnd, kCorner},
               Case{"corner_kick_right", -kEnd, kCorner}, Case{"goal_kick_left", -14, 0},
               Case{"goal_kick_right", 14, 0}, Case{"free_kick_left", 5, 2}, Case{"free_kick_right", 5, 2},
               Case{"direct_free_kick_left", 5, 2}, Case{"direct_free_kick_right", 5, 2});
  INFO(c.mode);
  m.trainer(Match::ballTo(5, 2));
  m.run(1);
  m.trainer(std::string("(playMode ") + c.mode + ")");
  const double begin = m.time() - 0.02;
  CHECK(m.mode() == c.mode);
  m.run(48);  // 0.98 s
  m.checkBall(5, 2);
  m.run(2);
  CHECK(m.mode() == c.mode);
  m.checkBall(c.x, c.y, 0.001);
  CHECK(m.ball().z() == Approx(0.042).margin(0.001));
  m.checkModeSent(c.mode);
  CHECK(m.until("PlayOn", 20) > 0);
  CHECK(m.time() - begin == Approx(15.0).margin(0.001));
  m.run(1);
  // The drop ball is placed outside the penalty areas.
  const bool inArea = std::abs(c.x) > 13.2 && std::abs(c.y) < 3;
  m.checkBall(inArea ? std::copysign(13.2, c.x) : c.x, inArea ? 3.0 : c.y);
}

TEST_CASE("Every restart ends with a touch by either team") {
  Match m;
  const char* mode = GENERATE("KickIn_Left", "KickIn_Right", "corner_kick_left", "corner_kick_right", "free_kick_left",
                              "free_kick_right", "direct_free_kick_left", "direct_free_kick_right");
  INFO(mode);
  const bool first = GENERATE(true, false);
  m.trainer(std::string("(playMode ") + mode + ")");
  m.run(55);
  CHECK(m.mode() == mode);
  m.touch(first ? m.a1 : m.b1);
  CHECK(m.mode() == "PlayOn");
  m.checkModeSent("PlayOn");
}

TEST_CASE("A ball over the goal line gives a goal kick or a corner kick, depending on the last touch") {
  Match m;
  const double end = GENERATE(1.0, -1.0), y = GENERATE(4.0, -4.0);
  const bool attackers = GENERATE(true, false);
  const Player& last = (end > 0) == attackers ? m.a1 : m.b1;
  m.touchThen(last, Match::ballTo(15.1 * end, y));
  const std::string side = (end > 0) == attackers ? "right" : "left";  // the opponents of the last touch
  CHECK(m.mode() == (attackers ? "goal_kick_" : "corner_kick_") + side);
  m.run(52);
  if (attackers)
    m.checkBall(14 * end, 0, 0.001);
  else
    m.checkBall(kEnd * end, std::copysign(kCorner, y), 0.001);
  CHECK(m.score() == std::pair(0, 0));
}

TEST_CASE("At the corner flag the line that the whole ball crossed first takes precedence") {
  Match m;
  SECTION("it is not wholly over the goal line") {
    m.touchThen(m.a1, Match::ballTo(15.02, 10.2));
    CHECK(m.mode() == "KickIn_Right");
  }
  SECTION("it is not wholly over the touch line") {
    m.touchThen(m.a1, Match::ballTo(15.2, 10.02));
    CHECK(m.mode() == "goal_kick_right");
  }
}

TEST_CASE("At a goal kick opponents leave the area, and the ball must leave it, too") {
  Match m;
  m.touchThen(m.a1, Match::ballTo(15.1, 4));
  REQUIRE(m.mode() == "goal_kick_right");
  m.trainer(Match::put(m.a1, 14, 2) + Match::put(m.a2, 13.1, -2) + Match::put(m.b2, 14.3, 0));
  m.run(52);
  m.checkAt(m.a1, 13.2 - 2.5, 2);
  m.checkAt(m.a2, 13.2 - 2.5, -2);
  CHECK(Match::distance(m.at(m.b2), m.ball()) == Approx(0.5).margin(0.02));
  m.touch(m.b2, 1);
  CHECK(m.mode() == "goal_kick_right");
  m.trainer(Match::put(m.b2, 14.5, -2) + Match::ballTo(13.6, 0, 0.042, -2));
  while (m.ball().x() > 13.2) {
    CHECK(m.mode() == "goal_kick_right");
    m.run(1);
  }
  CHECK(m.mode() == "PlayOn");
  // A goal kick is direct.
  m.trainer(Match::ballTo(-15.3, 0, 0.1));
  CHECK(m.mode() == "Goal_Right");
}

TEST_CASE("A goal kick over its own goal line gives a corner kick") {
  Match m;
  m.trainer("(playMode goal_kick_left)");
  m.run(55);
  m.touchThen(m.a1, Match::ballTo(-15.2, 4));
  CHECK(m.mode() == "PlayOn");
  m.run(1);
  CHECK(m.mode() == "corner_kick_right");
}

TEST_CASE("A free kick set by a trainer is taken where the ball was, but outside the penalty areas") {
  Match m;
  m.trainer(Match::ballTo(-14, -1));
  m.run(1);
  m.trainer("(playMode free_kick_right)" + Match::put(m.a1, -12, -3) + Match::put(m.a2, -13.2, -1.5));
  m.run(52);
  m.checkBall(-13.2, -3, 0.001);
  // Towards its own end would be behind the goal line, so it is moved along y towards the middle.
  m.checkAt(m.a1, -12, -0.5, 0.5);
  CHECK(Match::distance(m.at(m.a1), m.ball()) > 2);
  CHECK(Match::distance(m.at(m.a2), m.ball()) > 2);
}

TEST_CASE("A second touch by the kicker gives the opponents a free kick") {
  Match m;
  const char* mode =
      GENERATE("KickOff_Left", "KickIn_Left", "corner_kick_left", "free_kick_left", "direct_free_kick_left");
  INFO(mode);
  m.trainer(std::string("(playMode ") + mode + ")");
  m.run(55);
  m.touchThen(m.a1, Match::ballTo(3, 2));
  REQUIRE(m.mode() == "PlayOn");
  m.run(6);
  SECTION("directly") {
    m.touch(m.a1);
    CHECK(m.mode() == "free_kick_right");
    m.trainer(m.apart());
    m.run(51);
    m.checkBall(3, 2, 0.05);
  }
  SECTION("after a team-mate") {
    m.touchThen(m.a2, Match::ballTo(3, 2));
    m.run(6);
    m.touch(m.a1);
    CHECK(m.mode() == "PlayOn");
  }
  SECTION("after an opponent") {
    m.touchThen(m.b2, Match::ballTo(3, 2));
    m.run(6);
    m.touch(m.a1);
    CHECK(m.mode() == "PlayOn");
  }
}

TEST_CASE("A continuous contact counts as one touch") {
  Match m;
  m.trainer("(playMode KickOff_Left)");
  m.run(5);
  m.touch(m.a1);
  REQUIRE(m.mode() == "PlayOn");
  for (int i = 0; i < 20; ++i) {
    m.touch(m.a1);
    CHECK(m.mode() == "PlayOn");
  }
}

TEST_CASE("Without any touch so far a ball that goes out gives no restart and is moved back") {
  Match m;
  m.trainer(Match::ballTo(4, 9.9, 0.042, 0, 4));
  m.run(10);
  CHECK(m.mode() == "PlayOn");
  m.checkBall(4, 10, 0.1);
}

TEST_CASE("At a trainer's drop ball players of both teams are moved away, and the ball falls from its position") {
  Match m;
  m.trainer(Match::ballTo(1, 2, 0.5, 1) + Match::put(m.a1, 0, 2) + Match::put(m.b1, 2, 3) + Match::put(m.b2, 4.5, 2));
  m.trainer("(dropBall)");
  const double z = m.ball().z();
  m.run(1);
  CHECK(m.mode() == "PlayOn");
  CHECK(m.ball().z() < z);
  CHECK(m.ball().z() > 0.3);
  const double x = m.ball().x();
  m.checkBall(1.02, 2, 0.03);
  m.checkAt(m.a1, x - 2.5, 2);
  m.checkAt(m.b1, x + 2.5, 3);
  m.checkAt(m.b2, 4.5, 2);
  m.run(2);
  CHECK(m.ball().x() == Approx(x).margin(0.01));  // at rest except for the fall
}

TEST_CASE("A ball dropped in a penalty area is placed at the corner of the area") {
  Match m;
  m.trainer(Match::ballTo(14, -1));
  m.trainer("(dropBall)");
  m.run(1);
  m.checkBall(13.2, -3);
  m.trainer(Match::ballTo(-13.5, 2));
  m.trainer("(playMode corner_kick_left)(dropBall)");
  CHECK(m.mode() == "PlayOn");
  m.run(1);
  m.checkBall(-13.2, 3);
}

TEST_CASE("Offside is a mode that only trainers set, and no rule acts in it") {
  Match m;
  const char* mode = GENERATE("offside_left", "offside_right");
  m.trainer(std::string("(playMode ") + mode + ")");
  m.seconds(16);
  m.touchThen(m.a1, Match::ballTo(15.3, 0, 0.1));
  CHECK(m.mode() == mode);
  CHECK(m.score() == std::pair(0, 0));
  m.trainer("(playMode nosuchmode)(playMode)(playMode goal_left)");
  CHECK(m.mode() == mode);
}

TEST_CASE("A rule that the config disables is not judged, and the other rules are") {
  const std::string rules = "/sys/server/gamecontrol/SoccerRuleAspect/";
  const std::string off = GENERATE("DoubleTouchRule", "BallOutRule", "DropBallRule");
  INFO(off);
  Match m{{{rules + off + ".enabled", false}}};
  m.trainer("(playMode KickOff_Left)");
  m.seconds(16);
  CHECK(m.mode() == (off == "DropBallRule" ? "KickOff_Left" : "PlayOn"));
  m.trainer("(playMode KickIn_Left)");
  m.run(55);
  m.touchThen(m.a1, Match::ballTo(3, 2));
  m.run(6);
  m.touch(m.a1);
  CHECK(m.mode() == (off == "DoubleTouchRule" ? "PlayOn" : "free_kick_right"));
  m.trainer("(playMode PlayOn)" + m.apart() + Match::ballTo(3, 11));
  m.run(1);
  CHECK(m.mode() == (off == "BallOutRule" ? "PlayOn" : "KickIn_Right"));
}
