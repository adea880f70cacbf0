// What players see of each other where something is in between.
#include "stadium.h"

using namespace spark;
using namespace spark::test;

namespace {

/// Two humanoids that face each other over six metres.
struct Encounter : Stadium {
  explicit Encounter(bool occlusion)
      : Stadium({{"Soccer.VisionNoise", false}, {"Soccer.VisionOcclusion", occlusion}}),
        a(join("A", 1, "rsg/agent/nao/nao_hetero.rsg 0")),
        b(join("B", 1, "rsg/agent/nao/nao_hetero.rsg 0")) {
    act(a, "(beam -3 0 0)");
    act(b, "(beam -3 0 0)");
    run(3);
  }
  /// A wall on the ground across the x axis.
  void buildWall(double x, double height) {
    Node& wall = node("/usr/scene").asNode()->create<Node>("Transform", "wall");
    setProperty(wall, "localPos", Value(List{x, 0.0, height / 2}));
    setProperty(wall.create("BoxCollider", "collider"), "boxLengths", Value(List{0.1, 3.0, height}));
  }
  /// What the first player sees next.
  std::string see() {
    run(1);
    while (!a.heard("(See ")) run(1);
    return a.last;
  }
  Player &a, &b;
};

bool shows(const std::string& percepts, const char* part) {
  return percepts.find(std::string("(") + part + " (pol") != std::string::npos;
}

int lines(const std::string& percepts) {
  int n = 0;
  for (std::size_t at = percepts.find("(L "); at != std::string::npos; at = percepts.find("(L ", at + 1)) ++n;
  return n;
}

}  // namespace

TEST_CASE("with occlusion a robot shows the parts above a wall") {
  Encounter s(true);
  const std::string open = s.see();
  INFO(open);
  for (const char* part : {"head", "rlowerarm", "llowerarm", "rfoot", "lfoot"}) CHECK(shows(open, part));
  s.buildWall(2, 0.2);  // knees
  const std::string half = s.see();
  INFO(half);
  CHECK(shows(half, "head"));
  CHECK_FALSE(shows(half, "rfoot"));
  CHECK_FALSE(shows(half, "lfoot"));
}

TEST_CASE("with occlusion a wall hides a robot, the ball and the lines behind it, but not what is beside it") {
  Encounter s(true);
  s.trainer("(playMode PlayOn)" + Encounter::ballTo(2, 0));
  const std::string open = s.see();
  s.buildWall(1, 2);
  const std::string behind = s.see();
  INFO(open << "\n" << behind);
  CHECK(shows(open, "B"));
  CHECK_FALSE(shows(behind, "B"));
  CHECK_FALSE(shows(behind, "head"));
  CHECK(shows(behind, "F1R"));
  CHECK_FALSE(shows(behind, "G1R"));
  CHECK(lines(behind) < lines(open));
  CHECK(lines(behind) > 0);
}

TEST_CASE("without occlusion a wall hides nothing") {
  Encounter s(false);
  const std::string open = s.see();
  s.buildWall(1, 2);
  const std::string behind = s.see();
  CHECK(shows(behind, "head"));
  CHECK(lines(behind) == lines(open));
}
