// The automatic referee: when it calls each foul, against which player, and with which penalty.
#include "foul_match.h"

using namespace spark;
using namespace spark::test;

TEST_CASE("a player on the ground for 15 s is held in the air for half a second and then placed beside the field",
          "[fouls]") {
  FoulMatch h({"IncapableFoulAspect"}, 2, 1, 0.1);
  h.put(h.b(1), 0, 10.5);  // players off the field are not judged
  h.run(750);
  CHECK(h.fouls().empty());
  const double y = h.position(h.a(2)).y();
  h.run(1);
  CHECK(h.fouls() == Fouls{"1 4 1 2"});
  CHECK(h.position(h.a(2)).z() == Approx(1.01));
  h.run(24);
  CHECK(h.countFouls() == 24);
  CHECK(h.position(h.a(2)).z() == Approx(1.25));
  CHECK(h.position(h.a(2)).y() == Approx(y));
  CHECK(h.bodyOf(h.a(2)).state().linearVelocity.norm() == 0);
  h.run(1);
  CHECK(h.fouls().empty());
  h.is(h.a(2), -3.0, 10.5);  // the ball is on the other side
  CHECK(h.position(h.a(2)).z() == Approx(0.1));
  h.run(1500 - 776);
  CHECK(h.fouls().empty());
  h.run(1);
  CHECK(h.fouls() == Fouls{"26 4 1 1"});  // the goalie has 30 s
  h.run(1600);
  CHECK(h.get("/sys/server/gamecontrol/PenaltyAspect", "fouls") == Value(2));
}

namespace {
/// Fills the stack memory that the next call uses.
[[gnu::noinline]] void fillStack(unsigned char with) {
  volatile unsigned char bytes[1 << 16];
  for (volatile unsigned char& b : bytes) b = with;
}
}  // namespace

TEST_CASE("the state of a held player does not depend on uninitialized memory", "[fouls]") {
  std::uint64_t hashes[2];
  for (int run : {0, 1}) {
    FoulMatch h({"IncapableFoulAspect"}, 2, 1, 0.1);
    h.run(750);
    fillStack(run ? 0x5a : 0xa5);
    h.run(1);
    REQUIRE(h.fouls() == Fouls{"1 4 1 2"});
    hashes[run] = stateHash(*h.kernel.root().find("/sys/server/gamecontrol/PenaltyAspect"));
  }
  CHECK(hashes[0] == hashes[1]);
}

TEST_CASE("no player is held while penalties are disabled", "[fouls]") {
  FoulMatch h({"IncapableFoulAspect"}, 2, 0, 0.1);
  Leaf& penalties = *h.kernel.root().find("/sys/server/gamecontrol/PenaltyAspect");
  h.run(751);
  CHECK(h.fouls() == Fouls{"1 4 1 2"});
  setProperty(penalties, "enabled", false);
  h.run(800);
  CHECK(h.fouls().empty());
  CHECK(h.position(h.a(2)).z() < 0.2);
  CHECK(h.get("/sys/server/gamecontrol/PenaltyAspect", "fouls") == Value(1));
}

TEST_CASE("a player that does not stand up within 30 s is incapable, and a goalie after 60 s", "[fouls]") {
  FoulMatch h({"IncapableFoulAspect"}, 2, 0, 0.2);
  h.run(1500);
  CHECK(h.fouls().empty());
  h.run(1);
  CHECK(h.fouls() == Fouls{"1 4 1 2"});
  h.run(1499);
  h.fouls();
  h.run(1);
  CHECK(h.fouls() == Fouls{"26 4 1 1"});
}

TEST_CASE("getting up resets the time on the ground, and half a second of standing resets the time without standing",
          "[fouls]") {
  FoulMatch h({"IncapableFoulAspect"}, 2, 0, 0.1);
  const int up = GENERATE(1, 30);  // cycles
  h.put(1, 0, 10.5);
  h.run(740);
  for (int i = 0; i < up; ++i) {
    h.place(h.bodyOf(2), 0, 8, 0.3);
    h.run(1);
  }
  h.place(h.bodyOf(2), 0, 8, 0.1);
  h.run(750);
  CHECK(h.fouls().empty());
  // The time on the ground restarts; the time without standing is 1490 cycles after the short rise.
  h.run(1);
  CHECK(h.fouls() == Fouls{"1 4 1 2"});
}

TEST_CASE("pauses and disabling the rule reset the times on the ground", "[fouls]") {
  FoulMatch h({"IncapableFoulAspect"}, 2, 0, 0.1);
  h.run(740);
  SECTION("a goal") { h.setMode("Goal_Left"); }
  SECTION("before the kick-off") { h.setMode("BeforeKickOff"); }
  SECTION("disabling the rule") { setProperty(h.at("/sys/server/gamecontrol/IncapableFoulAspect"), "enabled", false); }
  h.run(1);
  h.setMode("PlayOn");
  setProperty(h.at("/sys/server/gamecontrol/IncapableFoulAspect"), "enabled", true);
  h.run(750);
  CHECK(h.fouls().empty());
  h.run(1);
  CHECK(h.countFouls() == 1);
}

TEST_CASE("fouls are judged after the end of the match as well", "[fouls]") {
  FoulMatch h({"IncapableFoulAspect"}, 2, 0, 0.1);
  h.setMode("GameOver");
  h.run(751);
  CHECK(h.fouls() == Fouls{"1 4 1 2"});
}

TEST_CASE("a goal releases a held player", "[fouls]") {
  FoulMatch h({"IncapableFoulAspect"}, 2, 0, 0.1);
  h.run(755);
  CHECK(h.countFouls() == 5);
  h.setMode("Goal_Left");
  h.run(30);
  CHECK(h.fouls().empty());
  CHECK(h.position(2).y() == Approx(8).margin(0.01));
}

TEST_CASE("with an opponent at the ball the second and third player of a team must keep away except for the goalie",
          "[fouls]") {
  FoulMatch h({"CrowdingFoulAspect"}, 4, 1, 0.1);
  h.set("MinOppDistance", 0.8), h.set("Min2PlDistance", 0.4), h.set("Min3PlDistance", 1.0);
  h.put(h.b(1), 0.7, -9);
  h.put(h.a(2), -0.2, -9);
  h.put(h.a(4), -0.9, -9);
  SECTION("a second and a third player nearby are fouls") {
    h.put(h.a(3), 0, -8.6);
    h.run(1);
    CHECK(h.fouls() == Fouls{"1 0 1 3", "2 0 1 4"});
  }
  SECTION("the goalie may be second") {
    h.put(h.a(1), 0, -8.6);
    h.run(1);
    CHECK(h.fouls() == Fouls{"1 0 1 4"});
  }
  SECTION("second and third are far enough away") {
    h.put(h.a(3), 0, -8.5);
    h.put(h.a(4), -1.05, -9);
    h.run(1);
    CHECK(h.fouls().empty());
  }
  SECTION("no opponent is near") {
    h.put(h.a(3), 0, -8.6);
    h.put(h.b(1), 0.9, -9);
    h.run(1);
    CHECK(h.fouls().empty());
  }
  SECTION("it is off by default") {
    h.put(h.a(3), 0, -8.6);
    h.set("MinOppDistance", 0), h.set("Min2PlDistance", 0), h.set("Min3PlDistance", 0);
    h.run(1);
    CHECK(h.fouls().empty());
  }
}

TEST_CASE("the fourth player in its own penalty area is moved across the nearest edge", "[fouls]") {
  FoulMatch h({"IllegalDefenceAspect"}, 5, 4);
  h.put(h.a(2), -14.5, 0), h.put(h.a(3), -14.5, 2), h.put(h.a(4), -14.5, -2);
  h.run(2);
  CHECK(h.fouls().empty());
  SECTION("in front") {
    h.put(h.a(5), -13.5, 1);
    h.run(1);
    CHECK(h.fouls() == Fouls{"1 2 1 5"});
    h.is(h.a(5), -12.8, 1);
  }
  SECTION("at the side") {
    h.put(h.a(5), -14, 2.9);
    h.put(h.a(3), -14.5, 1);
    h.run(1);
    CHECK(h.fouls() == Fouls{"1 2 1 5"});
    h.is(h.a(5), -14, 3.4);
  }
  SECTION("when the goalie enters, the player farthest from the goal is moved") {
    h.put(h.a(4), -13.7, -2);
    h.run(1);
    h.put(h.a(1), -13.5, 1);
    h.run(1);
    CHECK(h.fouls() == Fouls{"1 2 1 4"});
    h.is(h.a(4), -12.8, -2, 0.01);
  }
  SECTION("with the beam penalty the player is held") {
    h.set("IllegalDefenseBeamPenalty", true);
    h.put(h.a(5), -13.5, 1);
    h.run(3);
    CHECK(h.fouls() == Fouls{"1 2 1 5", "2 2 1 5", "3 2 1 5"});
    CHECK(h.position(h.a(5)).z() == Approx(1.03));
  }
  SECTION("with the maximum number there is no foul") {
    h.set("MaxPlayersInsideOwnArea", 4);
    h.put(h.a(5), -13.5, 1);
    h.run(2);
    CHECK(h.fouls().empty());
  }
  SECTION("opponents may enter") {
    h.put(h.b(4), -13.5, 1);
    h.run(2);
    CHECK(h.fouls().empty());
  }
  h.run(5);
  CHECK(h.get("/sys/server/gamecontrol/PenaltyAspect", "fouls").toNumber() <= 1);
}

TEST_CASE("the last player to join a group of three must leave it if its team has at least half of the group",
          "[fouls]") {
  FoulMatch h({"TouchingFoulAspect"}, 3, 3);
  SECTION("two of three") {
    for (int i = 0; i < 3; ++i) h.put(h.a(2), 0, 0), h.put(h.b(2), 0.78, 0), h.run(1);
    CHECK(h.fouls().empty());
    h.put(h.a(2), 0, 0), h.put(h.b(2), 0.78, 0), h.put(h.a(3), -0.78, 0);
    h.run(1);
    CHECK(h.fouls() == Fouls{"1 1 1 3"});
    CHECK(h.position(h.a(3)).x() == Approx(-1.18).margin(0.05));
    CHECK(h.position(h.a(3)).y() == Approx(0).margin(0.01));
  }
  SECTION("a team-mate leaves instead of the goalie") {
    for (int i = 0; i < 3; ++i) h.put(h.a(2), 0, 0), h.put(h.b(2), 0.78, 0), h.run(1);
    h.put(h.a(2), 0, 0), h.put(h.b(2), 0.78, 0), h.put(h.a(1), -0.78, 0);
    h.run(1);
    CHECK(h.fouls() == Fouls{"1 1 1 2"});
  }
  SECTION("with one of three an opponent leaves") {
    for (int i = 0; i < 3; ++i) h.put(h.a(2), 0, 0), h.put(h.a(3), 0.78, 0), h.run(1);
    h.put(h.a(2), 0, 0), h.put(h.a(3), 0.78, 0), h.put(h.b(2), -0.78, 0);
    h.run(1);
    const Fouls fouls = h.fouls();
    REQUIRE(fouls.size() == 1);
    CHECK((fouls[0] == "1 1 1 2" || fouls[0] == "1 1 1 3"));
  }
  SECTION("a setting allows larger groups") {
    h.set("MaxTouchGroupSize", 3);
    h.put(h.a(2), 0, 0), h.put(h.b(2), 0.78, 0), h.put(h.a(3), -0.78, 0);
    h.run(1);
    CHECK(h.fouls().empty());
  }
  SECTION("with the beam penalty the player is held") {
    h.set("TouchingFoulBeamPenalty", true);
    for (int i = 0; i < 3; ++i) h.put(h.a(2), 0, 0), h.put(h.b(2), 0.78, 0), h.run(1);
    h.put(h.a(2), 0, 0), h.put(h.b(2), 0.78, 0), h.put(h.a(3), -0.78, 0);
    h.run(25);
    CHECK(h.countFouls() == 25);
    h.run(1);
    h.is(h.a(3), -2.4, 10.5);
  }
}

namespace {
/// B2 runs into A2 from +x at 1 m/s. A2 is at the origin with the speed `speed`.
void runInto(FoulMatch& h, double speed = 0) {
  for (int i = 0; i < 3; ++i) {
    h.put(h.a(2), 0, 0, speed);
    h.put(h.b(2), i < 2 ? 0.9 : 0.79, 0, -1);
    h.run(1);
  }
}
}  // namespace

TEST_CASE("a player that runs into an opponent far from the ball is charging", "[fouls]") {
  FoulMatch h({"ChargingFoulAspect"}, 2, 2);
  SECTION("if only one of them runs") {
    runInto(h);
    CHECK(h.fouls() == Fouls{"1 6 2 2"});
    h.run(25);
    h.is(h.b(2), 3.0, 10.5);
  }
  SECTION("not if both run") {
    runInto(h, 1);
    CHECK(h.fouls().empty());
  }
  SECTION("not if it is slow") {
    h.set("ChargingMinSpeed", 1.1);
    runInto(h);
    CHECK(h.fouls().empty());
  }
  SECTION("not if charging is no foul") {
    h.set("UseCharging", false);
    runInto(h);
    CHECK(h.fouls().empty());
  }
  SECTION("not with a team-mate") {
    for (int i = 0; i < 3; ++i) h.put(h.a(2), 0, 0), h.put(h.a(1), i < 2 ? 0.9 : 0.79, 0, -1), h.run(1);
    CHECK(h.fouls().empty());
  }
  SECTION("not shortly after the referee moved one of them") {
    h.trainer("(repos (unum 2)(team Left))");
    h.run(40);
    runInto(h);
    CHECK(h.fouls().empty());
    h.run(15);
    runInto(h);
    CHECK(h.countFouls() == 1);
  }
  SECTION("not in keep-away") {
    h.set("Keepaway", true);
    runInto(h);
    CHECK(h.fouls().empty());
  }
}

TEST_CASE("near the ball charging depends on the player's direction and distance to the ball", "[fouls]") {
  FoulMatch h({"ChargingFoulAspect"}, 2, 2);
  SECTION("running at the opponent instead of the ball is charging") {
    h.placeBall(0.79, 0.9, 0.042);
    runInto(h);
    CHECK(h.fouls() == Fouls{"1 6 2 2"});
  }
  SECTION("running at the ball is not charging") {
    h.set("ChargingMinDeltaDist", 10);
    h.placeBall(-0.6, 0, 0.042);
    runInto(h);
    CHECK(h.fouls().empty());
  }
  SECTION("running at the ball is charging if the opponent is closer to it and stands") {
    h.placeBall(-0.6, 0, 0.042);
    runInto(h);
    CHECK(h.fouls() == Fouls{"1 6 2 2"});
  }
  SECTION("a contact at the ball is no foul") {
    h.set("ChargingMinCollBallDist", 1.0);
    h.placeBall(0.79, 0.9, 0.042);
    runInto(h);
    CHECK(h.fouls().empty());
  }
}

TEST_CASE("a contact without a foul remains one until it has ended for 0.2 s", "[fouls]") {
  FoulMatch h({"ChargingFoulAspect"}, 2, 2);
  runInto(h, 1);
  for (int i = 0; i < 5; ++i) runInto(h);
  CHECK(h.fouls().empty());
  h.put(h.a(2), 0, 0), h.put(h.b(2), 2, 0);
  h.run(9);
  runInto(h);
  CHECK(h.countFouls() == 1);
}

TEST_CASE("charging exempts players that just played the ball, the players they push, and the goalie in its area",
          "[fouls]") {
  FoulMatch h({"ChargingFoulAspect"}, 2, 2);
  SECTION("a player that just played the ball") {
    h.placeBall(5, 0, 0.042);
    h.put(h.b(2), 5.15, 0);
    h.run(1);
    h.placeBall(0, -9, 0.042);
    h.run(20);
    runInto(h);
    CHECK(h.fouls().empty());
    h.put(h.a(2), 0, 0), h.put(h.b(2), 2, 0);
    h.run(40);
    runInto(h);
    CHECK(h.fouls() == Fouls{"1 6 2 2"});
  }
  SECTION("a player that was pushed") {
    h.placeBall(5, 0, 0.042);
    h.put(h.b(2), 5.15, 0);
    h.run(1);
    h.placeBall(0, -9, 0.042);
    runInto(h);
    h.put(h.a(2), 0, 0), h.put(h.b(2), 2, 0);
    h.run(12);
    for (int i = 0; i < 3; ++i) h.put(h.b(2), 0, 0), h.put(h.a(2), i < 2 ? -0.9 : -0.79, 0, 1), h.run(1);
    CHECK(h.fouls().empty());
  }
  SECTION("the goalie") {
    for (int i = 0; i < 3; ++i) h.put(h.a(2), 14, 0), h.put(h.b(1), i < 2 ? 14.9 : 14.79, 0, -1), h.run(1);
    CHECK(h.fouls().empty());
    h.put(h.b(1), 10, 5);
    h.run(12);
    for (int i = 0; i < 3; ++i) h.put(h.a(2), 8, 0), h.put(h.b(1), i < 2 ? 8.9 : 8.79, 0, -1), h.run(1);
    CHECK(h.fouls() == Fouls{"1 6 2 1"});
  }
}

TEST_CASE("holding the ball next to an opponent is a foul if the rule is on", "[fouls]") {
  FoulMatch h({"BallHoldingAspect"}, 2, 1, 0.05);
  h.set("UseBallHolding", true);
  const auto hold = [&](int agent, int cycles) {
    for (int i = 0; i < cycles; ++i) {
      h.placeBall(0, -5, 0.042);
      h.put(agent, -0.1, -5);
      h.run(1);
    }
  };
  h.put(h.b(1), 0.5, -5);
  SECTION("a field player") {
    hold(h.a(2), 250);
    CHECK(h.fouls().empty());
    hold(h.a(2), 1);
    CHECK(h.fouls() == Fouls{"1 8 1 2"});
  }
  SECTION("the goalie far from its goal") {
    hold(h.a(1), 251);
    CHECK(h.fouls() == Fouls{"1 8 1 1"});
  }
  SECTION("without an opponent") {
    h.put(h.b(1), 0.8, -5);
    hold(h.a(2), 260);
    CHECK(h.fouls().empty());
  }
  SECTION("one second without the ball resets the hold") {
    hold(h.a(2), 240);
    h.put(h.a(2), -3, -5);
    h.run(50);
    hold(h.a(2), 240);
    CHECK(h.fouls().empty());
  }
  SECTION("the rule is off by default") {
    h.set("UseBallHolding", false);
    hold(h.a(2), 260);
    CHECK(h.fouls().empty());
  }
}
