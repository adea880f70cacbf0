// Self-collisions: when they are fouls, which joints they freeze, and which boxes overlap.
#include <unistd.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <fstream>
#include <functional>

#include "../box_overlap.h"
#include "foul_match.h"

using namespace spark;
using namespace spark::test;

namespace {
/// A2 is a boxer whose arms overlap. It is agent 2.
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
    trainer("(time 20)");  // from 16 s to 64 s the single-precision time of play is exact
  }
  bool frozen(const char* effector) {
    std::vector<Effector*> all;
    kernel.root().require<Node>("/usr/scene/AgentAspect2").collect(all);
    for (Effector* e : all)
      if (e->name() == effector) return getProperty(*e, "frozen").toBool();
    FAIL("no effector " << effector);
    return false;
  }
  /// Runs until the arms are released, calling `each` before each cycle; returns the number of cycles.
  int cyclesFrozen(const std::function<void()>& each = [] {}) {
    int cycles = 0;
    for (; frozen("lae1") && cycles < 200; ++cycles) {
      each();
      run(1);
    }
    return cycles;
  }
};
}  // namespace

TEST_CASE("joints of overlapping parts are frozen for 1 s and then exempt for 2 s", "[fouls]") {
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
  SECTION("a pause releases the joints") {
    h.setMode("BeforeKickOff");
    h.run(1);
    CHECK_FALSE(h.frozen("lae1"));
    h.setMode("PlayOn");
    h.run(1);
    CHECK(h.fouls() == Fouls{"3 7 1 2"});
  }
  SECTION("the freeze is part of the saved state") {
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

TEST_CASE("late in a half a freeze lasts one cycle longer because the time of play is in single precision", "[fouls]") {
  BoxerMatch h;
  REQUIRE(h.trainer("(time 90)").empty());
  h.run(1);
  CHECK(h.cyclesFrozen() == 51);
}

TEST_CASE("a freeze lasts 1 s in every mode in which it is judged", "[fouls]") {
  BoxerMatch h;
  h.run(1);
  REQUIRE(h.frozen("lae1"));
  for (const char* mode : {"GameOver", "KickOff_Left", "KickIn_Right", "corner_kick_left", "goal_kick_right",
                           "free_kick_left", "direct_free_kick_right", "offside_left", "pass_left", "PlayOn"}) {
    CAPTURE(mode);
    h.setMode(mode);
    CHECK(h.cyclesFrozen() == 50);
    // The exemption ends 3 s after the freeze began.
    h.setMode(mode);
    h.run(99);
    CHECK_FALSE(h.frozen("lae1"));
    h.setMode("PlayOn");
    h.run(1);
    REQUIRE(h.frozen("lae1"));
  }
}

TEST_CASE("a freeze that spans play and the end of the match lasts 1 s", "[fouls]") {
  BoxerMatch h;
  h.run(21);
  REQUIRE(h.frozen("lae1"));
  h.setMode("GameOver");
  CHECK(h.cyclesFrozen() == 30);
}

TEST_CASE("a freeze ends with the next cycle in a pause", "[fouls]") {
  BoxerMatch h;
  h.run(1);
  REQUIRE(h.frozen("lae1"));
  h.setMode(GENERATE("BeforeKickOff", "Goal_Left", "Goal_Right"));
  CHECK(h.cyclesFrozen() == 1);
}

TEST_CASE("a trainer that sets the time neither ends nor prolongs a freeze", "[fouls]") {
  BoxerMatch h;
  h.run(1);
  h.set("SelfCollisionsTolerance", 1.0);
  REQUIRE(h.frozen("lae1"));
  SECTION("once") {
    h.run(10);
    REQUIRE(h.trainer(GENERATE("(time 0)", "(time 19.9)", "(time 50)")).empty());
    CHECK(h.cyclesFrozen() == 40);
  }
  SECTION("in every cycle") {
    CHECK(h.cyclesFrozen([&] { REQUIRE(h.trainer("(time 30)").empty()); }) == 50);
  }
  SECTION("when the match is over") {
    h.setMode("GameOver");
    REQUIRE(h.trainer("(time 0)").empty());
    CHECK(h.cyclesFrozen() == 50);
  }
}

TEST_CASE("a freeze ends even if the aspects of the match are disabled", "[fouls]") {
  BoxerMatch h;
  h.run(1);
  REQUIRE(h.frozen("lae1"));
  const auto disable = [&](const std::string& aspect) {
    setProperty(h.at("/sys/server/gamecontrol/" + aspect), "enabled", false);
  };
  SECTION("the clock of play") {
    disable("GameStateAspect");
    CHECK(h.cyclesFrozen() == 50);
  }
  SECTION("a foul, or the referee of all fouls") {
    disable(GENERATE("SelfCollisionAspect", "SoccerRuleAspect"));
    CHECK(h.cyclesFrozen() == 1);
  }
  SECTION("a foul that is removed") {
    Leaf& aspect = h.at("/sys/server/gamecontrol/SelfCollisionAspect");
    aspect.parent()->remove(aspect);
    CHECK_FALSE(h.frozen("lae1"));
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

TEST_CASE("self-collisions may be penalized by a beam or not at all", "[fouls]") {
  BoxerMatch h;
  SECTION("by a beam, at most once per 10 s") {
    h.set("SelfCollisionBeamPenalty", true);
    h.run(1);
    CHECK(h.fouls() == Fouls{"1 7 1 2"});
    CHECK_FALSE(h.frozen("lae1"));
    h.run(25);
    CHECK(h.countFouls() == 24);
    const Vec3 torso =
        h.kernel.root().require<IRigidBody>("/usr/scene/AgentAspect2/robot/body/physics").state().position;
    CHECK(torso.x() == Approx(-3.0));
    CHECK(torso.y() == Approx(-10.5));
    if (GENERATE(false, true)) h.setMode("GameOver");
    h.run(500 - 26);
    CHECK(h.fouls().empty());
    h.run(1);
    CHECK(h.countFouls() == 1);
  }
  SECTION("each self-collision is written to a file once") {
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

TEST_CASE("a pair of boxes is ignored only if the later box excludes the earlier one", "[fouls]") {
  BoxerMatch h;
  h.setMode("BeforeKickOff");
  const std::string robot = "/usr/scene/AgentAspect2/robot/";
  // The referee searches for the robot's boxes again when its nodes change.
  const auto name = [&](const char* speaker, const char* named) {
    callMethod(h.at(robot + speaker), "addNotCollideWithColliderName", std::vector<Value>{named, true});
    h.kernel.create("Transform", robot + "change");
  };
  SECTION("the later one excludes the earlier one") {
    name("rarm/RightArm", "LeftArm");
    h.setMode("PlayOn");
    h.run(5);
    CHECK(h.fouls().empty());
  }
  SECTION("the earlier one excludes the later one") {
    name("larm/LeftArm", "RightArm");
    h.setMode("PlayOn");
    h.run(1);
    CHECK(h.fouls() == Fouls{"1 7 1 2"});
  }
  SECTION("a joint between them does not matter") {
    Leaf& joint = h.kernel.create("FixedJoint", robot + "rarm/joint");
    callMethod(joint, "attach", std::vector<Value>{"../physics", "../../larm/physics"});
    h.setMode("PlayOn");
    h.run(1);
    CHECK(h.fouls() == Fouls{"1 7 1 2"});
  }
}

namespace {

/// R = Rx Ry Rz, angles in degrees.
Mat3 turned(double x, double y, double z) {
  return (Eigen::AngleAxisd(degToRad(x), Vec3::UnitX()) * Eigen::AngleAxisd(degToRad(y), Vec3::UnitY()) *
          Eigen::AngleAxisd(degToRad(z), Vec3::UnitZ()))
      .toRotationMatrix();
}

/// The referee's test of a box at the origin and one at (`x`, 0, 0), both with these half edge lengths.
bool overlap(double tolerance, const Vec3& half, double x, const Mat3& rotation) {
  const Vec3f edges = half.cast<float>();
  return soccer::overlapBeyond(static_cast<float>(tolerance), {Pose{}, edges}, {Pose{Vec3(x, 0, 0), rotation}, edges});
}

}  // namespace

TEST_CASE("the overlap depth of boxes is measured along a face normal if that gives the minimum", "[fouls]") {
  const Vec3 half(0.5, 0.5, 0.5);
  const Mat3 rotation = turned(90, 30, 50);
  const double touching = 0.5 + rotation.row(0).cwiseAbs().sum() * 0.5;
  CHECK(overlap(0.199, half, touching - 0.2, rotation));
  CHECK_FALSE(overlap(0.201, half, touching - 0.2, rotation));
  CHECK_FALSE(overlap(0, half, touching + 0.001, rotation));
}

TEST_CASE("for crossing edges the tolerance is scaled by the sine of their angle", "[fouls]") {
  const Vec3 half(0.05, 0.15, 0.05);
  const Mat3 rotation = turned(40, 40, 40);
  const double x = 0.05 + rotation.row(0).cwiseAbs().dot(half) - 0.06;
  // The boxes overlap by 0.0303 m along the normal of their long edges, which are at 71.3 degrees.
  CHECK(overlap(0.0286, half, x, rotation));
  CHECK_FALSE(overlap(0.0288, half, x, rotation));
}

TEST_CASE("parallel or nearly parallel boxes are no foul at any depth of overlap", "[fouls]") {
  const Vec3 half(0.04, 0.035, 0.055);
  CHECK_FALSE(overlap(0.04, half, 0.001, Mat3::Identity()));
  CHECK_FALSE(overlap(0.04, half, 0.001, turned(8, 0, 0)));
  CHECK_FALSE(overlap(0.04, half, 0.001, turned(3, 4, 5)));
}
