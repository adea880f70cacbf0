// The differences between versions of the original server, property by property.
#include <algorithm>

#include "match_house.h"

using namespace spark;
using namespace spark::test;

namespace {

/// Replaces the agent's vision by cone vision.
Leaf& useConeVision(SoccerMatch& h, int agent, int interval) {
  Node& body = h.kernel.root().require<Node>("/usr/scene/AgentAspect" + std::to_string(agent) + "/body");
  body.remove(*body.child("VisionPerceptor"));
  Leaf& eye = body.create("RestrictedVisionPerceptor", "eye");
  setProperty(eye, "interval", interval);
  setProperty(eye, "senseLine", true);
  return eye;
}

}  // namespace

TEST_CASE("with ExtraGameState GS includes the kick-off side and the penalties of all players", "[soccer]") {
  SoccerMatch h;
  h.importField();
  Puppet& a = h.join("A", 7);
  h.join("B", 3), h.join("A", 2);
  h.run(2);
  CHECK(a.heard.find(" (pm BeforeKickOff))") != std::string::npos);
  h.set("ExtraGameState", true);
  h.run(2);
  CHECK(
      a.heard.find(
          " (pm BeforeKickOff) (k left) (ti ((2 penalty_none 0.00) (7 penalty_none 0.00)) ((3 penalty_none 0.00))))") !=
      std::string::npos);
  h.setMode("PlayOn");
  h.run(50);
  CHECK(a.heard.find("(t 0.98) (pm PlayOn) (k left) (ti ((2 penalty_none -0.98)") != std::string::npos);
  h.trainer("(kill (unum 3)(team Right))");
  h.trainer("(kickOff Right)");
  h.run(3);
  CHECK(a.heard.find("(k left)") != std::string::npos);
  CHECK(a.heard.find(") ()))") != std::string::npos);
}

TEST_CASE("SayMsgSize limits the length of players' messages", "[soccer]") {
  SoccerMatch h;
  h.importField();
  Puppet &a = h.join("A", 1), &mate = h.join("A", 2);
  const std::string word(21, 'x');
  h.act(a, "(say " + word + ")");
  h.run(2);
  const std::string before = mate.all;
  h.set("SayMsgSize", 21);
  h.act(a, "(say " + word + ")");
  h.run(2);
  CHECK(lacks(before, word, mate.all));
}

TEST_CASE("without BeamWithinFieldWidth beams may leave the field, but not exceed the maximum distance", "[soccer]") {
  SoccerMatch h;
  h.importField();
  Puppet& a = h.join("A", 1);
  h.set("BeamWithinFieldWidth", false);
  h.act(a, "(beam -3 50 0)");
  h.run(1);
  CHECK(h.bodyOf(1).state().position.y() == Approx(50).margin(0.01));
  h.act(a, "(beam 1e30 1e30 1e30)");
  h.run(1);
  CHECK(h.bodyOf(1).state().position.norm() == Approx(1000).margin(0.1));
  CHECK(h.bodyOf(1).state().rotation.allFinite());
}

TEST_CASE("the settings determine the width of penalty areas for the rules", "[soccer]") {
  SoccerMatch h;
  h.importField();
  h.set("MaxPlayersInsideOwnArea", 0);
  h.join("A", 1);
  h.set("PenaltyWidth", 3.9);
  h.set("GoalWidth", 2.1);
  // A free kick inside an area is taken from the area's front corner.
  h.setMode("PlayOn");
  const auto dropAt = [&h](double x, double y) {
    callMethod(h.at("/sys/server/gamecontrol/SoccerRuleAspect"), "dropBall", std::vector<Value>{x, y, 0.111});
    return h.ball().state().position;
  };
  CHECK(dropAt(-45, 2.5).y() == Approx(3.0).margin(1e-6));
  h.set("PenaltyWidthBeyondGoal", false);
  CHECK(dropAt(-45, 2.5).y() == Approx(2.5).margin(1e-6));
  CHECK(dropAt(-45, 1.5).y() == Approx(1.95).margin(1e-6));
}

TEST_CASE("agents receive their temperature only without ConstantTemperature", "[soccer]") {
  SoccerMatch h;
  h.importField();
  Puppet& a = h.join("A", 1);
  h.trainer("(agent (unum 1)(team Left)(temperature 31))");
  h.run(11);
  CHECK(a.all.find("(temp 23.00)") != std::string::npos);
  const std::string constant = a.all;
  h.set("ConstantTemperature", false);
  h.run(12);
  CHECK(lacks(constant, "(temp 31.00)", a.all));
}

TEST_CASE("the settings determine the vision interval, the visibility of lines and the noise", "[soccer]") {
  SoccerMatch h;
  h.importField();
  Puppet& a = h.join("A", 1);
  h.setMode("PlayOn");
  useConeVision(h, 1, 3);
  h.placeAgent(1, 0, 20);
  h.placeBall(10, 20);
  h.run(3);
  const auto look = [&](int cycles) {
    h.run(1);
    a.all.clear();
    h.run(cycles);
    return a.all;
  };
  CHECK(count(look(12), "(See ") == 4);
  const std::string lines = a.all;
  CHECK(count(a.all, "(B (pol 10.00 0.00 ") == 0);  // at least a calibration error
  h.set("VisionInterval", 2);
  CHECK(count(look(12), "(See ") == 6);
  h.set("FieldLinesSeen", false);
  h.set("VisionNoise", false);
  look(12);
  INFO(a.heard);
  CHECK(lacks(a.all, "(L (pol", lines));
  CHECK(count(a.all, "(B (pol 10.00 0.00 ") + count(a.all, "(B (pol 10.00 -0.00 ") == 6);
}
