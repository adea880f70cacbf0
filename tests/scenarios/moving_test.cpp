// The positions to which the referee moves players.
#include "match.h"

using namespace spark;
using namespace spark::test;

TEST_CASE("No player is moved onto another player") {
  Match m;
  m.trainer("(kickOff Left)" + Match::put(m.b1, 2.5, 1) + Match::put(m.b2, 1, 1));
  m.run(1);
  m.checkAt(m.b1, 2.5, 1);
  const Vec3 b2 = m.at(m.b2);
  CHECK(Match::distance(b2, m.at(m.b1)) > 0.5);
  // The nearest of the candidates, which are in steps of 0.4 m further out or further from the middle.
  m.checkAt(m.b2, 2.5, 1.8);
}

TEST_CASE("No player is moved as the fourth into its own penalty area") {
  Match m;
  Player& a3 = m.join("A", 3);
  Player& a4 = m.join("A", 4);
  m.trainer(Match::ballTo(-11.5, 0));
  m.run(1);
  m.trainer("(playMode free_kick_right)" + Match::put(m.a1, -14.6, 2.5) + Match::put(m.a2, -14.6, -2.5) +
            Match::put(a3, -14.6, 1.5) + Match::put(a4, -11, 0.5));
  m.run(53);
  const Vec3 p = m.at(a4);
  CHECK(Match::distance(p, m.ball()) > 2);
  CHECK_FALSE((p.x() > -15.4 && p.x() < -12.8 && std::abs(p.y()) < 3.4));
  // With fewer players in the area it is moved there.
  m.trainer(Match::put(m.a1, -8, 7) + Match::put(a4, -11, 0.5));
  m.run(2);
  m.checkAt(a4, -14, 0.5);
}

TEST_CASE("A player that would be moved behind its goal line is moved towards the middle") {
  Match m;
  m.trainer("(playMode corner_kick_right)" + Match::put(m.a1, -14.5, 5));
  m.run(52);
  m.checkAt(m.a1, -14.5, (20 + 2.1) / 4 - 0.042 - 2.5);
}

TEST_CASE("A player is not moved next to the ball except when it is pushed away from it") {
  Match m;
  // The target of the move before the kick-off is the position of the ball.
  m.trainer("(playMode BeforeKickOff)");
  m.trainer("(kickOff Left)" + Match::put(m.a1, 6, 0) + Match::ballTo(-2.5, 0.2));
  m.run(1);
  CHECK(Match::distance(m.at(m.a1), Vec3(-2.5, 0.2, 0)) >= 0.99);
}

TEST_CASE("A trainer moves a player off the field, by its number, to the side away from the ball") {
  Match m;
  m.trainer(Match::ballTo(0, -3));
  m.run(1);
  m.trainer("(repos (unum 2)(team Left))(repos (unum 1)(team Right))");
  m.run(1);
  m.checkAt(m.a2, -0.6 * (7 - 2), 10.5, 0.02);
  m.checkAt(m.b1, 0.6 * (7 - 1), 10.5, 0.02);
  CHECK(m.at(m.a2).z() == Approx(1.0).margin(0.02));
  m.trainer(Match::ballTo(0, 3));
  m.run(1);
  m.trainer("(repos (unum 2)(team Left))");
  m.run(1);
  m.checkAt(m.a2, -3, -10.5, 0.02);
}

TEST_CASE("With MaxNumSafeRepositionAttempts 0 a player is moved to its target even if that is occupied") {
  Match m{{{"Soccer.MaxNumSafeRepositionAttempts", 0}}};
  m.trainer("(kickOff Left)" + Match::put(m.b1, 2.5, 1.35) + Match::put(m.b2, 1, 1));
  m.run(1);
  m.checkAt(m.b2, 2.5, 1);
}

TEST_CASE("A humanoid is moved as a whole and remains upright") {
  Stadium s;
  Player& a = s.join("A", 1, "rsg/agent/nao/nao.rsg");
  Player& b = s.join("B", 2, "rsg/agent/nao/nao_hetero.rsg 4");
  s.trainer("(agent (unum 2)(team Right)(move 3 1 0.4 90))");
  s.seconds(1);
  const double z = s.at(b).z();
  CHECK(z > 0.33);
  s.trainer("(kickOff Left)(agent (unum 2)(team Right)(pos 1.2 -0.5 " + std::to_string(z) + "))");
  s.run(1);
  CHECK(s.at(b).x() == Approx(2.5).margin(0.01));
  CHECK(s.at(b).y() == Approx(-0.5).margin(0.01));
  s.seconds(1);
  CHECK(s.mode() == "KickOff_Left");
  CHECK(s.at(b).z() == Approx(z).margin(0.02));
  CHECK(s.at(b).x() == Approx(2.5).margin(0.05));
  s.trainer("(agent (unum 1)(team Left)(pos -0.1 0.055 0.38))");
  CHECK(s.until("PlayOn", 1) >= 0);  // its feet reach the ball
  CHECK(a.gs("sl") == "0");
}

TEST_CASE("A team has at most 7 robots of one type, 9 of any two types, and three types") {
  Stadium s;
  SECTION("an eighth robot of one type is refused") {
    for (int n = 1; n <= 7; ++n) CHECK(s.join("A", n, 0.6, 0).side == Side::left);
    CHECK(s.join("A", 8, 0.6, 0).side == Side::none);
    CHECK(s.join("A", 8, 0.6, 1).side == Side::left);  // the number is still free
  }
  SECTION("a tenth robot of two types is refused") {
    for (int n = 1; n <= 9; ++n) CHECK(s.join("A", n, 0.6, n % 2).side == Side::left);
    CHECK(s.join("A", 10, 0.6, 0).side == Side::none);
    CHECK(s.join("A", 10, 0.6, 2).side == Side::left);
    CHECK(s.join("B", 10, 0.6, 0).side == Side::right);  // another team
  }
}
