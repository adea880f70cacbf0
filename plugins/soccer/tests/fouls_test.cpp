// The automatic referee: when each foul is called, against whom, and what comes of it.
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "../box_overlap.h"
#include "match_house.h"

using namespace spark;
using namespace spark::test;

namespace {

/// Teams A (left) and B (right) of spheres on the league's field, in PlayOn, with the ball far from everybody. Agents are numbered A1, A2,
/// ..., B1, B2, ... `radius` is what makes them lie (below 0.25 m) or stand. Players wait in a row at y = 8, 2 m from each other.
struct FoulMatch : MatchHouse {
  FoulMatch(std::initializer_list<const char*> fouls, int left, int right, double radius = 0.4) : MatchHouse(false), left_(left) {
    set("AgentRadius", radius);
    set("AgentMass", 10);
    set("MaxRobotTypeCount", 11), set("MinRobotTypesCount", 1), set("MaxSumTwoRobotTypes", 22);
    Leaf& robots = kernel.create("DirectoryFileSystem", "/sys/server/file/robots");
    setProperty(robots, "path", SPARK_TEST_ROBOTS);
    setProperty(robots, "prefix", "rsg/agent/test");
    importField();
    kernel.create("PlayerContactAspect", "/sys/server/gamecontrol/PlayerContactAspect");
    for (const char* foul : fouls) kernel.create(foul, std::string("/sys/server/gamecontrol/") + foul);
    kernel.create("PenaltyAspect", "/sys/server/gamecontrol/PenaltyAspect");
    kernel.create("SoccerRuleItem", "/sys/fouls");
    for (int n = 1; n <= left; ++n) join("A", n);
    for (int n = 1; n <= right; ++n) join("B", n);
    for (int n = 1; n <= left + right; ++n) put(n, 2.0 * n - 8, 8);
    placeBall(0, -9, 0.042);
    setMode("PlayOn");
  }
  int a(int unum) const { return unum; }
  int b(int unum) const { return left_ + unum; }
  double radius() { return get("/sys/variables/Soccer", "AgentRadius").toNumber(); }
  void put(int agent, double x, double y, double vx = 0) {
    place(bodyOf(agent), x, y, radius());
    bodyOf(agent).setVelocity(Vec3(vx, 0, 0));
  }
  Vec3 position(int agent) { return bodyOf(agent).state().position; }
  /// What monitors are told since the last call: "index type team unum".
  std::vector<std::string> fouls() {
    Environment env;
    kernel.root().require<IMonitorItem>("/sys/fouls").contribute(env);
    std::vector<std::string> out;
    for (const Element e : env.predicates) {
      out.push_back(fmt::format("{} {} {} {}", e.at(1).integer(), e.at(2).integer(), e.at(3).integer(), e.at(4).integer()));
      CHECK(e.head() == "foul");
    }
    return out;
  }
  std::size_t countFouls() { return fouls().size(); }
  bool is(int agent, double x, double y, double tolerance = 1e-9) {
    const Vec3 p = position(agent);
    INFO("agent " << agent << " is at " << p.transpose());
    CHECK(p.x() == Approx(x).margin(tolerance));
    CHECK(p.y() == Approx(y).margin(tolerance));
    return true;
  }

 private:
  int left_;
};

using Fouls = std::vector<std::string>;

}  // namespace

TEST_CASE("a player who lies for 15 s is held in the air for half a second and placed beside the field", "[fouls]") {
  FoulMatch h({"IncapableFoulAspect"}, 2, 1, 0.1);
  h.put(h.b(1), 0, 10.5);  // who lies beside the field is left alone
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
  // lying now is 15 s again; not standing is 1490 cycles after the short rise
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

TEST_CASE("with an opponent at the ball the second and the third of a team must keep away, but for the goalie", "[fouls]") {
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
/// B2 runs into A2, who stands at the origin (or comes with `speed`), from +x at 1 m/s.
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

TEST_CASE("players who just played the ball, and those they push, are spared; so is the goalie in his area", "[fouls]") {
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

namespace {
/// A2 is a boxer whose arms overlap; it is agent 2.
struct BoxerMatch : FoulMatch {
  explicit BoxerMatch(const char* overlap = "0.06") : FoulMatch({"SelfCollisionAspect"}, 1, 0) {
    setMode("BeforeKickOff");
    auto& boxer = kernel.create<Puppet>("Puppet", "/usr/agent/boxer");
    boxer.robot = std::string("rsg/agent/test/boxer.rsg ") + overlap;
    run(5);
    act(boxer, "(init (unum 2)(teamname A))");
    run(2);
    fouls();
    setMode("PlayOn");
  }
  bool frozen(const char* effector) {
    std::vector<Effector*> all;
    kernel.root().require<Node>("/usr/scene/AgentAspect2").collect(all);
    for (Effector* e : all)
      if (e->name() == effector) return getProperty(*e, "frozen").toBool();
    FAIL("no effector " << effector);
    return false;
  }
};
}  // namespace

TEST_CASE("joints of overlapping parts are frozen for 1 s and then spared for 2 s", "[fouls]") {
  BoxerMatch h;
  h.run(1);
  CHECK(h.fouls() == Fouls{"1 7 1 2"});
  CHECK(h.frozen("lae1"));
  CHECK(h.frozen("rae1"));
  h.run(49);
  CHECK(h.frozen("lae1"));
  h.run(1);
  CHECK_FALSE(h.frozen("lae1"));
  CHECK_FALSE(h.frozen("rae1"));
  h.run(99);
  CHECK(h.fouls().empty());
  h.run(1);
  CHECK(h.fouls() == Fouls{"2 7 1 2"});
  CHECK(h.frozen("lae1"));
  SECTION("a pause thaws") {
    h.setMode("BeforeKickOff");
    h.run(1);
    CHECK_FALSE(h.frozen("lae1"));
    h.setMode("PlayOn");
    h.run(1);
    CHECK(h.fouls() == Fouls{"3 7 1 2"});
  }
  SECTION("state is kept") {
    StateWriter out(true);
    saveTree(h.kernel.root(), out);
    h.run(60);
    CHECK_FALSE(h.frozen("lae1"));
    StateReader in(out.bytes());
    loadTree(h.kernel.root(), in);
    CHECK(h.frozen("lae1"));
    h.run(49);
    CHECK(h.frozen("lae1"));
    h.run(1);
    CHECK_FALSE(h.frozen("lae1"));
    h.run(99);
    CHECK(h.fouls().empty());
  }
}

TEST_CASE("small overlaps of a robot's parts are tolerated", "[fouls]") {
  BoxerMatch h("0.03");
  h.run(10);
  CHECK(h.fouls().empty());
  h.set("SelfCollisionsTolerance", 0.02);
  h.run(1);
  CHECK(h.fouls() == Fouls{"1 7 1 2"});
}

TEST_CASE("self-collisions may be penalised by a beam, or not at all", "[fouls]") {
  BoxerMatch h;
  SECTION("by a beam, not again before 10 s have passed") {
    h.set("SelfCollisionBeamPenalty", true);
    h.run(1);
    CHECK(h.fouls() == Fouls{"1 7 1 2"});
    CHECK_FALSE(h.frozen("lae1"));
    h.run(25);
    CHECK(h.countFouls() == 24);
    const Vec3 torso = h.kernel.root().require<IRigidBody>("/usr/scene/AgentAspect2/robot/body/physics").state().position;
    CHECK(torso.x() == Approx(-3.0));
    CHECK(torso.y() == Approx(-10.5));
    h.run(500 - 26);
    CHECK(h.fouls().empty());
    h.run(1);
    CHECK(h.countFouls() == 1);
  }
  SECTION("and be written to a file, once each") {
    const auto file = std::filesystem::temp_directory_path() / fmt::format("spark-self-collisions-{}.txt", getpid());
    std::filesystem::remove(file);
    h.set("SelfCollisionRecordFilename", file.string());
    h.set("WriteSelfCollisionsToFile", true);
    h.run(10);
    std::ifstream in(file);
    std::string line, more;
    std::getline(in, line);
    CHECK(line.ends_with(" left 2: larm and rarm"));
    CHECK_FALSE(std::getline(in, more));
    std::filesystem::remove(file);
  }
  SECTION("not at all") {
    h.set("FoulOnSelfCollisions", false);
    h.run(10);
    CHECK(h.fouls().empty());
    CHECK_FALSE(h.frozen("lae1"));
  }
}

TEST_CASE("boxes overlap as deep as along their least axis", "[fouls]") {
  const Vec3 half(0.5, 0.5, 0.5);
  Pose a, b;
  const auto overlap = [&](double tolerance) { return soccer::overlapBeyond(tolerance, a, half, b, half); };
  SECTION("side by side") {
    b.position = Vec3(0.9, 0.2, 0);
    CHECK(overlap(0.099));
    CHECK_FALSE(overlap(0.101));
  }
  SECTION("corner against face") {
    // turned by 45 degrees about z the box reaches 0.7071 along x
    const double c = std::sqrt(0.5);
    b.rotation << c, -c, 0, c, c, 0, 0, 0, 1;
    b.position = Vec3(0.5 + c - 0.05, 0, 0);
    CHECK(overlap(0.049));
    CHECK_FALSE(overlap(0.051));
  }
  SECTION("edge against edge, which no face normal separates") {
    const double c = std::sqrt(0.5);
    a.rotation << c, -c, 0, c, c, 0, 0, 0, 1;   // an edge along z towards +x
    b.rotation << c, 0, c, 0, 1, 0, -c, 0, c;   // an edge along y towards -x
    b.position = Vec3(2 * c - 0.03, 0, 0);
    CHECK(overlap(0.029));
    CHECK_FALSE(overlap(0.031));
    b.position.x() = 2 * c + 0.001;
    CHECK_FALSE(overlap(0));
  }
}
