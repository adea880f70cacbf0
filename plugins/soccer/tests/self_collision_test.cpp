// Parts of one robot that overlap: when that is a foul, what it freezes, and how deep boxes overlap.
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "../box_overlap.h"
#include "foul_match.h"

using namespace spark;
using namespace spark::test;

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
