// Offside, a rule that a config can add with one line.
#include "match_house.h"

using namespace spark;
using namespace spark::test;

namespace {

/// A1 A2 A3 are agents 1..3, B1 B2 agents 4 and 5; A attacks towards +x.
struct OffsideMatch : SoccerMatch {
  explicit OffsideMatch(bool judged = true) {
    importField();
    if (judged) kernel.create("OffsideAspect", "/sys/server/gamecontrol/OffsideAspect");
    for (int n = 1; n <= 3; ++n) join("A", n);
    for (int n = 1; n <= 2; ++n) join("B", n);
    setMode("PlayOn");
    run(1);
    formation(40);
  }
  /// B's second-last player is at x = 30, A2 at x = `attacker`, the ball and A1 at 20.
  void formation(double attacker) {
    placeAgent(1, 18, 0), placeAgent(2, attacker, 10), placeAgent(3, -10, 0), placeAgent(4, 50, 0),
        placeAgent(5, 30, -10);
    placeBall(20, 0);
    run(1);
  }
  void pass() {
    touch(1);
    placeAgent(1, 18, 0);
  }
  void receive(double x) {
    placeBall(x, 10);
    placeAgent(2, x - 3, 10);
    run(1);
    touch(2);
  }
};

}  // namespace

TEST_CASE("a player behind the second-last opponent is offside when it gets the ball", "[soccer]") {
  OffsideMatch h;
  h.pass();
  CHECK(h.get("/sys/server/gamecontrol/OffsideAspect", "marked").text() == "{2}");
  h.receive(41);
  CHECK(h.mode() == "offside_left");
  const Vec3 spot = h.ball().state().position;
  h.runSeconds(1.1);
  CHECK(h.mode() == "free_kick_right");
  h.runSeconds(1.2);
  CHECK((h.ball().state().position - spot).head<2>().norm() < 0.5);
}

TEST_CASE("the offside rule can be disabled and enabled during a match", "[soccer]") {
  OffsideMatch h;
  Leaf& aspect = *h.kernel.root().find("/sys/server/gamecontrol/OffsideAspect");
  h.pass();
  CHECK(h.get("/sys/server/gamecontrol/OffsideAspect", "marked").text() == "{2}");
  setProperty(aspect, "enabled", false);
  h.receive(41);
  CHECK(h.mode() == "PlayOn");
  CHECK(h.get("/sys/server/gamecontrol/OffsideAspect", "marked").text() == "{}");
  h.formation(40);
  setProperty(aspect, "enabled", true);
  h.runSeconds(0.2);  // the previous touch has expired
  h.pass();
  h.receive(41);
  CHECK(h.mode() == "offside_left");
  setProperty(aspect, "enabled", false);
  h.runSeconds(1.1);  // an offside that was already called is still carried out
  CHECK(h.mode() == "free_kick_right");
}

TEST_CASE("a player level with the defense, behind the ball or in its own half is not offside", "[soccer]") {
  OffsideMatch h;
  const double x = GENERATE(29.0, 19.0, -5.0);
  h.formation(x);
  h.pass();
  CHECK(h.get("/sys/server/gamecontrol/OffsideAspect", "marked").text() == "{}");
  h.receive(40);
  CHECK(h.mode() == "PlayOn");
}

TEST_CASE("an opponent's touch in between ends an offside position", "[soccer]") {
  OffsideMatch h;
  h.pass();
  h.placeBall(25, -10);
  h.touch(5);
  h.placeAgent(5, 30, -10);
  h.receive(41);
  CHECK(h.mode() == "PlayOn");
}

TEST_CASE("without the aspect there is no offside", "[soccer]") {
  OffsideMatch h(false);
  h.pass();
  h.receive(41);
  CHECK(h.mode() == "PlayOn");
}

TEST_CASE("a touch that executes a restart marks no player", "[soccer]") {
  OffsideMatch h;
  h.setMode("KickIn_Left");
  h.runSeconds(1.2);
  h.placeAgent(2, 40, 10);
  h.touch(1);
  CHECK(h.mode() == "PlayOn");
  CHECK(h.get("/sys/server/gamecontrol/OffsideAspect", "marked").text() == "{}");
}
