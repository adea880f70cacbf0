// The automatic referee: when each foul is called, against which player, and its penalty.
#include "foul_match.h"

using namespace spark;
using namespace spark::test;

TEST_CASE("a player who lies for 15 s is held in the air for half a second and placed beside the field", "[fouls]") {
  FoulMatch h({"IncapableFoulAspect"}, 2, 1, 0.1);
  h.put(h.b(1), 0, 10.5);  // players beside the field are not judged
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
/// Fills the stack that the next call uses.
[[gnu::noinline]] void smear(unsigned char with) {
  volatile unsigned char bytes[1 << 16];
  for (volatile unsigned char& b : bytes) b = with;
}
}  // namespace

TEST_CASE("the state of a player who is held is the same in every run, whatever was in memory", "[fouls]") {
  std::uint64_t hashes[2];
  for (int run : {0, 1}) {
    FoulMatch h({"IncapableFoulAspect"}, 2, 1, 0.1);
    h.run(750);
    smear(run ? 0x5a : 0xa5);
    h.run(1);
    REQUIRE(h.fouls() == Fouls{"1 4 1 2"});
    hashes[run] = stateHash(*h.kernel.root().find("/sys/server/gamecontrol/PenaltyAspect"));
  }
  CHECK(hashes[0] == hashes[1]);
}

TEST_CASE("nobody is held while penalties are switched off", "[fouls]") {
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

TEST_CASE("a player who does not stand for 30 s is incapable, a goalie after 60 s", "[fouls]") {
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

TEST_CASE("getting up ends lying; half a second of standing ends not standing", "[fouls]") {
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
  // Time on the ground starts anew; time without standing is 1490 cycles after the short rise.
  h.run(1);
  CHECK(h.fouls() == Fouls{"1 4 1 2"});
}

TEST_CASE("pauses and switches reset the clocks of the ground", "[fouls]") {
  FoulMatch h({"IncapableFoulAspect"}, 2, 0, 0.1);
  h.run(740);
  SECTION("a goal") { h.setMode("Goal_Left"); }
  SECTION("before the kick-off") { h.setMode("BeforeKickOff"); }
  SECTION("the switch") { setProperty(h.at("/sys/server/gamecontrol/IncapableFoulAspect"), "enabled", false); }
  h.run(1);
  h.setMode("PlayOn");
  setProperty(h.at("/sys/server/gamecontrol/IncapableFoulAspect"), "enabled", true);
  h.run(750);
  CHECK(h.fouls().empty());
  h.run(1);
  CHECK(h.countFouls() == 1);
}

TEST_CASE("fouls are judged after the end of the match too", "[fouls]") {
  FoulMatch h({"IncapableFoulAspect"}, 2, 0, 0.1);
  h.setMode("GameOver");
  h.run(751);
  CHECK(h.fouls() == Fouls{"1 4 1 2"});
}

TEST_CASE("a goal sets free who is held", "[fouls]") {
  FoulMatch h({"IncapableFoulAspect"}, 2, 0, 0.1);
  h.run(755);
  CHECK(h.countFouls() == 5);
  h.setMode("Goal_Left");
  h.run(30);
  CHECK(h.fouls().empty());
  CHECK(h.position(2).y() == Approx(8).margin(0.01));
}

TEST_CASE("with an opponent at the ball the second and the third of a team must keep away, but for the goalie",
          "[fouls]") {
  FoulMatch h({"CrowdingFoulAspect"}, 4, 1, 0.1);
  h.set("MinOppDistance", 0.8), h.set("Min2PlDistance", 0.4), h.set("Min3PlDistance", 1.0);
  h.put(h.b(1), 0.7, -9);
  h.put(h.a(2), -0.2, -9);
  h.put(h.a(4), -0.9, -9);
  SECTION("both") {
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

TEST_CASE("the fourth in the own penalty area is put out over its nearest edge", "[fouls]") {
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
  SECTION("beside") {
    h.put(h.a(5), -14, 2.9);
    h.put(h.a(3), -14.5, 1);
    h.run(1);
    CHECK(h.fouls() == Fouls{"1 2 1 5"});
    h.is(h.a(5), -14, 3.4);
  }
  SECTION("when the goalie comes, the farthest from the goal goes") {
    h.put(h.a(4), -13.7, -2);
    h.run(1);
    h.put(h.a(1), -13.5, 1);
    h.run(1);
    CHECK(h.fouls() == Fouls{"1 2 1 4"});
    h.is(h.a(4), -12.8, -2, 0.01);
  }
  SECTION("with the beam penalty he is held") {
    h.set("IllegalDefenseBeamPenalty", true);
    h.put(h.a(5), -13.5, 1);
    h.run(3);
    CHECK(h.fouls() == Fouls{"1 2 1 5", "2 2 1 5", "3 2 1 5"});
    CHECK(h.position(h.a(5)).z() == Approx(1.03));
  }
  SECTION("as many as allowed") {
    h.set("MaxPlayersInsideOwnArea", 4);
    h.put(h.a(5), -13.5, 1);
    h.run(2);
    CHECK(h.fouls().empty());
  }
  SECTION("opponents may come") {
    h.put(h.b(4), -13.5, 1);
    h.run(2);
    CHECK(h.fouls().empty());
  }
  h.run(5);
  CHECK(h.get("/sys/server/gamecontrol/PenaltyAspect", "fouls").toNumber() <= 1);
}

TEST_CASE("the last to join a group of three leaves it, if his team has half of it", "[fouls]") {
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
  SECTION("a mate for the goalie") {
    for (int i = 0; i < 3; ++i) h.put(h.a(2), 0, 0), h.put(h.b(2), 0.78, 0), h.run(1);
    h.put(h.a(2), 0, 0), h.put(h.b(2), 0.78, 0), h.put(h.a(1), -0.78, 0);
    h.run(1);
    CHECK(h.fouls() == Fouls{"1 1 1 2"});
  }
  SECTION("one of three: an opponent goes") {
    for (int i = 0; i < 3; ++i) h.put(h.a(2), 0, 0), h.put(h.a(3), 0.78, 0), h.run(1);
    h.put(h.a(2), 0, 0), h.put(h.a(3), 0.78, 0), h.put(h.b(2), -0.78, 0);
    h.run(1);
    const Fouls fouls = h.fouls();
    REQUIRE(fouls.size() == 1);
    CHECK((fouls[0] == "1 1 1 2" || fouls[0] == "1 1 1 3"));
  }
  SECTION("larger groups may be allowed") {
    h.set("MaxTouchGroupSize", 3);
    h.put(h.a(2), 0, 0), h.put(h.b(2), 0.78, 0), h.put(h.a(3), -0.78, 0);
    h.run(1);
    CHECK(h.fouls().empty());
  }
  SECTION("with the beam penalty he is held") {
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
/// B2 runs into A2 from +x at 1 m/s. A2 stands at the origin, or moves with `speed`.
void runInto(FoulMatch& h, double speed = 0) {
  for (int i = 0; i < 3; ++i) {
    h.put(h.a(2), 0, 0, speed);
    h.put(h.b(2), i < 2 ? 0.9 : 0.79, 0, -1);
    h.run(1);
  }
}
}  // namespace

TEST_CASE("who runs into an opponent far from the ball charges", "[fouls]") {
  FoulMatch h({"ChargingFoulAspect"}, 2, 2);
  SECTION("one of them") {
    runInto(h);
    CHECK(h.fouls() == Fouls{"1 6 2 2"});
    h.run(25);
    h.is(h.b(2), 3.0, 10.5);
  }
  SECTION("not both") {
    runInto(h, 1);
    CHECK(h.fouls().empty());
  }
  SECTION("not the slow") {
    h.set("ChargingMinSpeed", 1.1);
    runInto(h);
    CHECK(h.fouls().empty());
  }
  SECTION("not when it is no foul") {
    h.set("UseCharging", false);
    runInto(h);
    CHECK(h.fouls().empty());
  }
  SECTION("not team-mates") {
    for (int i = 0; i < 3; ++i) h.put(h.a(2), 0, 0), h.put(h.a(1), i < 2 ? 0.9 : 0.79, 0, -1), h.run(1);
    CHECK(h.fouls().empty());
  }
  SECTION("not just after the referee moved one of them") {
    h.trainer("(repos (unum 2)(team Left))");
    h.run(40);
    runInto(h);
    CHECK(h.fouls().empty());
    h.run(15);
    runInto(h);
    CHECK(h.countFouls() == 1);
  }
  SECTION("takers in keep-away are never charged") {
    h.set("Keepaway", true);
    runInto(h);
    CHECK(h.fouls().empty());
  }
}

TEST_CASE("near the ball it matters who goes for it", "[fouls]") {
  FoulMatch h({"ChargingFoulAspect"}, 2, 2);
  SECTION("who runs at the opponent rather than at the ball charges") {
    h.placeBall(0.79, 0.9, 0.042);
    runInto(h);
    CHECK(h.fouls() == Fouls{"1 6 2 2"});
  }
  SECTION("who runs at the ball does not") {
    h.set("ChargingMinDeltaDist", 10);
    h.placeBall(-0.6, 0, 0.042);
    runInto(h);
    CHECK(h.fouls().empty());
  }
  SECTION("unless he is the farther one and the other stands") {
    h.placeBall(-0.6, 0, 0.042);
    runInto(h);
    CHECK(h.fouls() == Fouls{"1 6 2 2"});
  }
  SECTION("a contact at the ball is none") {
    h.set("ChargingMinCollBallDist", 1.0);
    h.placeBall(0.79, 0.9, 0.042);
    runInto(h);
    CHECK(h.fouls().empty());
  }
}

TEST_CASE("a harmless contact stays harmless until it has ended for 0.2 s", "[fouls]") {
  FoulMatch h({"ChargingFoulAspect"}, 2, 2);
  runInto(h, 1);
  for (int i = 0; i < 5; ++i) runInto(h);
  CHECK(h.fouls().empty());
  h.put(h.a(2), 0, 0), h.put(h.b(2), 2, 0);
  h.run(9);
  runInto(h);
  CHECK(h.countFouls() == 1);
}

TEST_CASE("players who just played the ball, and those they push, are spared; so is the goalie in his area",
          "[fouls]") {
  FoulMatch h({"ChargingFoulAspect"}, 2, 2);
  SECTION("the ball") {
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
  SECTION("the pushed") {
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

TEST_CASE("holding the ball beside an opponent is a foul where that rule is on", "[fouls]") {
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
  SECTION("the goalie away from his goal") {
    hold(h.a(1), 251);
    CHECK(h.fouls() == Fouls{"1 8 1 1"});
  }
  SECTION("without an opponent") {
    h.put(h.b(1), 0.8, -5);
    hold(h.a(2), 260);
    CHECK(h.fouls().empty());
  }
  SECTION("a second without the ball ends a hold") {
    hold(h.a(2), 240);
    h.put(h.a(2), -3, -5);
    h.run(50);
    hold(h.a(2), 240);
    CHECK(h.fouls().empty());
  }
  SECTION("off by default") {
    h.set("UseBallHolding", false);
    hold(h.a(2), 260);
    CHECK(h.fouls().empty());
  }
}
