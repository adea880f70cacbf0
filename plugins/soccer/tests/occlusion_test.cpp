// What players cannot see because something is in between.
#include "match_house.h"

using namespace spark;
using namespace spark::test;

namespace {

/// A wall of a match, which stands still.
void buildWall(SoccerMatch& h, const std::string& name, const Vec3& at, const Vec3& lengths) {
  Node& wall = h.kernel.create<Node>("Transform", "/usr/scene/" + name);
  setProperty(wall, "localPos", Value(List{at.x(), at.y(), at.z()}));
  setProperty(wall.create("BoxCollider", "collider"), "boxLengths", Value(List{lengths.x(), lengths.y(), lengths.z()}));
}

}  // namespace

TEST_CASE("with occlusion an eye does not see what is behind a wall or a player", "[soccer][senses]") {
  SoccerMatch h;
  h.importField();
  Puppet &a = h.join("A", 1), &b = h.join("B", 2);
  h.setMode("PlayOn");
  h.set("VisionNoise", false);
  const auto see = [&] {
    h.run(2);
    a.all.clear(), b.all.clear();
    h.run(3);
    INFO(a.all);
    REQUIRE(a.all.find("(See ") != std::string::npos);
    return a.all;
  };
  const auto seesBall = [&] { return see().find("(B ") != std::string::npos; };
  const auto seesPlayer = [&] { return see().find("(team B)") != std::string::npos; };
  h.placeAgent(1, -10, 0);
  h.placeAgent(2, 10, 5);
  h.placeBall(10, 0);
  buildWall(h, "wall", {0, 0, 0.5}, {0.2, 2, 1});

  SECTION("of all robots") { h.set("VisionOcclusion", true); }
  SECTION("of one robot") { setProperty(h.at("/usr/scene/AgentAspect1/body/VisionPerceptor"), "occlusion", true); }
  SECTION("only if it is on") {
    CHECK(seesBall());
    return;
  }
  CHECK_FALSE(seesBall());
  CHECK(seesPlayer());  // beside the wall
  h.placeBall(10, -4);
  CHECK(seesBall());
  // The other player is between this one and the ball, beside the wall; neither hides itself.
  h.placeAgent(2, 10, 5);
  h.placeBall(18, 7);
  CHECK_FALSE(seesBall());
  CHECK(seesPlayer());
  CHECK(see().find("(F1R ") != std::string::npos);
}
