// Pass mode: its conditions, its effects and its cost.
#include "match.h"

using namespace spark;
using namespace spark::test;

namespace {

/// A1 is 0.35 m from the resting ball, B1 1.5 m.
struct Pass : Match {
  Pass() {
    trainer(put(a1, -0.35, 0) + put(b1, 1.5, 0));
    run(2);
  }
  void requestPass(Player& p) {
    act(p, "(pass)");
    run(1);
  }
  void toMode() {
    requestPass(a1);
    REQUIRE(mode() == "pass_left");
  }
};
}  // namespace

TEST_CASE("Pass mode is granted near a resting ball with no opponent close by, and lasts 4 s") {
  Pass m;
  const double before = m.time();
  m.requestPass(m.a1);
  CHECK(m.mode() == "pass_left");
  m.checkModeSent("pass_left");
  CHECK(m.until("PlayOn", 6) > 0);
  CHECK(m.time() - before == Approx(4.0).margin(kCycle));
}

TEST_CASE("Pass mode is granted to the right team in the same way") {
  Pass m;
  m.trainer(Match::put(m.a1, -1.5, 0) + Match::put(m.b1, 0.35, 0));
  m.run(2);
  m.requestPass(m.b1);
  CHECK(m.mode() == "pass_right");
}

TEST_CASE("Pass mode is refused silently") {
  Pass m;
  std::string commands;
  Player* who = &m.a1;
  SECTION("too far from the ball") { commands = Match::put(m.a1, -0.55, 0); }
  SECTION("with an opponent near") { commands = Match::put(m.b1, 0.95, 0); }
  SECTION("while the ball moves") { commands = Match::ballTo(0, 0, 0.042, 0, 0.2); }
  SECTION("while a team-mate touches the ball") { commands = Match::put(m.a2, 0, 0.15 + 0.042 - 0.01); }
  SECTION("in another mode") { commands = "(playMode free_kick_left)"; }
  SECTION("opponents of the player near the ball") { who = &m.b1; }
  m.trainer(commands);
  const std::string mode = m.mode();
  m.requestPass(*who);
  CHECK(m.mode() == mode);
}

TEST_CASE("Pass mode requires its conditions in the previous cycle as well, so a jump to the ball does not grant it") {
  Pass m;
  m.trainer(Match::put(m.a1, -3, 0));
  m.command(Match::put(m.a1, -0.35, 0));
  m.requestPass(m.a1);
  CHECK(m.mode() == "PlayOn");
  m.requestPass(m.a1);
  CHECK(m.mode() == "pass_left");
}

TEST_CASE("In pass mode opponents within 1 m are pushed away to 1.1 m each time") {
  Pass m;
  m.toMode();
  for (int i = 0; i < 3; ++i) {
    m.trainer(Match::put(m.b1, 0.6, 0.3));
    m.run(1);
    CHECK(Match::distance(m.at(m.b1), m.ball()) == Approx(1.1).margin(0.02));
  }
  m.trainer(Match::put(m.b1, 1.05, 0));
  m.run(1);
  m.checkAt(m.b1, 1.05, 0, 0.02);
  m.checkAt(m.a1, -0.35, 0, 0.02);
  CHECK(m.mode() == "pass_left");
}

TEST_CASE("Pass mode ends with the first touch by either team") {
  Pass m;
  m.toMode();
  SECTION("by the team") { m.touch(m.a2); }
  SECTION("by an opponent") { m.touch(m.b2, 1); }
  CHECK(m.mode() == "PlayOn");
  m.checkModeSent("PlayOn");
}

TEST_CASE("Monitors receive a countdown until goals count again") {
  Pass m;
  m.toMode();
  CHECK_FALSE(m.monitor().lastMessageHas("pass_mode_score_wait_left"));
  m.touchThen(m.a1, "");
  REQUIRE(m.mode() == "PlayOn");
  CHECK(m.monitor().number("pass_mode_score_wait_left") == Approx(9.96).margin(0.001));
  m.seconds(9.9);
  CHECK(m.monitor().number("pass_mode_score_wait_left") == Approx(0.06).margin(0.001));
  CHECK_FALSE(m.monitor().lastMessageHas("pass_mode_score_wait_right"));
  m.run(3);
  CHECK_FALSE(m.monitor().lastMessageHas("pass_mode_score_wait_left"));
  m.trainer(Match::put(m.a1, -1.5, 0) + Match::put(m.b1, 0.35, 0) + Match::ballTo(0, 0));
  m.run(2);
  m.requestPass(m.b1);
  m.touchThen(m.b1, "");
  REQUIRE(m.mode() == "PlayOn");
  CHECK(m.monitor().number("pass_mode_score_wait_right") == Approx(9.96).margin(0.001));
  CHECK_FALSE(m.monitor().lastMessageHas("pass_mode_score_wait_left"));
}

TEST_CASE("A team cannot score for 10 s after its pass mode") {
  Pass m;
  m.toMode();
  m.touchThen(m.a1, Match::ballTo(0.5, 0));
  SECTION("its goal becomes a goal kick") {
    m.trainer(kInRightGoal);
    CHECK(m.mode() == "goal_kick_right");
    CHECK(m.score() == std::pair(0, 0));
  }
  SECTION("the opponents' goal counts") {
    m.trainer(kInLeftGoal);
    CHECK(m.mode() == "Goal_Right");
  }
  SECTION("its goal counts after 10 s") {
    m.seconds(10);
    m.trainer(kInRightGoal);
    CHECK(m.mode() == "Goal_Left");
  }
  SECTION("its goal does not count after a second touch by the same player") {
    m.trainer(Match::ballTo(2, 0));
    m.run(1);
    m.touchThen(m.a1, kInRightGoal);
    CHECK(m.mode() == "goal_kick_right");
  }
  SECTION("its goal does not count after a team-mate's touch near the spot") {
    m.touchThen(m.a2, kInRightGoal);
    CHECK(m.mode() == "goal_kick_right");
  }
  SECTION("its goal counts after a team-mate's touch 1 m away") {
    m.trainer(Match::ballTo(1.1, 0));
    m.run(1);
    m.touchThen(m.a2, kInRightGoal);
    CHECK(m.mode() == "Goal_Left");
  }
  SECTION("its goal counts after two touches near the spot and one further away by the same players") {
    m.touchThen(m.a2, Match::ballTo(1.1, 0));
    m.run(1);
    m.touchThen(m.a1, kInRightGoal);
    CHECK(m.mode() == "Goal_Left");
  }
  SECTION("a set piece ends the ban") {
    m.trainer("(kickOff Left)");
    m.trainer("(playMode PlayOn)");
    m.trainer(kInRightGoal);
    CHECK(m.mode() == "Goal_Left");
  }
  SECTION("a drop ball ends the ban") {
    m.trainer("(dropBall)");
    m.trainer(kInRightGoal);
    CHECK(m.mode() == "Goal_Left");
  }
  SECTION("the opponents' pass mode ends the ban") {
    m.trainer("(playMode pass_right)");
    m.trainer("(playMode PlayOn)");
    m.trainer(kInRightGoal);
    CHECK(m.mode() == "Goal_Left");
  }
}

TEST_CASE("A team gets pass mode again 3 s after its last one, and the opponents at once") {
  Pass m;
  m.toMode();
  m.touchThen(m.a1, Match::ballTo(0, 0));
  REQUIRE(m.mode() == "PlayOn");
  m.trainer(Match::put(m.a1, -0.35, 0) + Match::put(m.b1, 1.5, 0));
  const double wait = 3.0 - 0.02 * 3;  // since the last cycle in pass mode
  m.seconds(wait - 0.04);
  m.requestPass(m.a1);
  CHECK(m.mode() == "PlayOn");
  SECTION("the same team") {
    m.run(2);
    m.requestPass(m.a1);
    CHECK(m.mode() == "pass_left");
  }
  SECTION("the opponents") {
    m.trainer(Match::put(m.a1, -1.5, 0) + Match::put(m.b1, 0.35, 0));
    m.run(1);
    m.requestPass(m.b1);
    CHECK(m.mode() == "pass_right");
  }
}

TEST_CASE("Pass mode set by a trainer has the same effects, and without the rule it is never granted") {
  Pass m;
  SECTION("set by a trainer") {
    m.trainer("(playMode pass_left)");
    m.touchThen(m.a1, kInRightGoal);
    CHECK(m.mode() == "goal_kick_right");
  }
  SECTION("switched off") {
    setProperty(m.node("/sys/server/gamecontrol/SoccerRuleAspect/PassModeRule"), "enabled", false);
    m.requestPass(m.a1);
    CHECK(m.mode() == "PlayOn");
  }
}
