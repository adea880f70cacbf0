// Init and the effectors of players.
#include <algorithm>

#include "match_house.h"

using namespace spark;
using namespace spark::test;

TEST_CASE("init sets team, number and start position, which are announced once", "[soccer]") {
  SoccerMatch h;
  h.importField();
  Puppet& a = h.join("A", 7);
  CHECK(getProperty(h.stateOf(1), "side").toString() == "left");
  CHECK(getProperty(h.stateOf(1), "unum").toInteger() == 7);
  const Vec3 p = h.bodyOf(1).state().position;
  CHECK(p.x() == Approx(-52 + 0.44).margin(0.01));
  CHECK(p.y() == Approx(34 - 0.44).margin(0.01));
  const std::string announced = "(GS (unum 7) (team left) (sl 0) (sr 0) (t 0.00) (pm BeforeKickOff))";
  h.run(5);
  CHECK(count(a.all, announced) == 1);
  CHECK(a.heard.find("(GS (sl 0) (sr 0) (t 0.00) (pm BeforeKickOff))") != std::string::npos);
  h.join("B", 1);
  CHECK(getProperty(h.stateOf(2), "side").toString() == "right");
  CHECK(h.bodyOf(2).state().position.x() == Approx(52 - 0.44).margin(0.01));
}

TEST_CASE("number 0, no number and a word give the lowest free number", "[soccer]") {
  SoccerMatch h;
  h.importField();
  h.join("A", 1);
  for (const auto& [name, action, unum] : {std::tuple{"x", "(init (unum 0)(teamname A))", 2},
                                           {"y", "(init (teamname A))", 3},
                                           {"z", "(init (unum seven)(teamname A))", 4}}) {
    h.act(h.connect(name), action);
    h.run(1);
    CHECK(getProperty(h.stateOf(unum), "unum").toInteger() == unum);
  }
}

TEST_CASE("a refused init moves the agent above the center and logs one line", "[soccer]") {
  SoccerMatch h;
  h.importField();
  h.join("A", 1), h.join("B", 1);
  Puppet& c = h.connect("C");
  const auto [action, reason] = GENERATE(table<std::string, std::string>({
      {"(init (unum 3))", "expected (teamname <name>)"},
      {"(init (unum 3)(teamname C))", "there are two teams already"},
      {"(init (unum 1)(teamname A))", "number 1 of team 'A' is taken"},
      {"(init (unum 12)(teamname A))", "number 12 is not one of 1..11"},
      {"(init (unum -1)(teamname A))", "number -1 is not one of 1..11"},
      {"(init (unum 3)(teamname \"x)(GS (pm GameOver))\"))", "the team name holds"},
      {"(init (unum 3)(teamname \"two words\"))", "the team name holds"},
      {"(init (unum 3)(teamname \";x\"))", "the team name holds"},
      {"(init (unum 3)(teamname 123456789012345678901234567890123))", "33 bytes, at most 32 are allowed"},
      {"(init (unum 3)(teamname \"x\\\\\"))", "the team name holds"},
  }));
  h.text.clear();
  h.act(c, action);
  h.run(2);
  CHECK(h.text.find(reason) != std::string::npos);
  CHECK(getProperty(h.stateOf(3), "side").toString() == "none");
  CHECK((h.bodyOf(3).state().position - Vec3(0, 0, 10)).norm() < 0.05);
  const std::string refused = c.all;
  // The agent can still join.
  h.act(c, "(init (unum 5)(teamname B))");
  h.run(3);
  CHECK(getProperty(h.stateOf(3), "unum").toInteger() == 5);
  CHECK(lacks(refused, "unum", c.all));
}

TEST_CASE("an agent that sends init in every cycle does not fill the log", "[soccer]") {
  SoccerMatch h;
  h.importField();
  h.join("A", 1);
  Puppet& b = h.connect("B");
  h.text.clear();
  for (int i = 0; i < 100; ++i) {
    h.act(b, i % 2   ? "(init (unum 1)(teamname A))"
             : i % 4 ? "(init (unum 2)(teamname A))"
                     : "(init (unum 3)(teamname A))");
    h.run(1);
  }
  CHECK(h.text.find("the results are no longer logged") != std::string::npos);
  CHECK(std::count(h.text.begin(), h.text.end(), '\n') < 30);
}

TEST_CASE("a twelfth player of a team is refused, and a number is free again after its player leaves", "[soccer]") {
  SoccerMatch h;
  h.importField();
  for (int n = 1; n <= 11; ++n) h.join("A", n);
  Puppet& late = h.connect("late");
  h.text.clear();
  h.act(late, "(init (teamname A))");
  h.run(1);
  CHECK(h.text.find("has 11 players already") != std::string::npos);
  CHECK(h.trainer("(kill (unum 4)(team Left))").empty());
  h.run(2);
  h.act(late, "(init (teamname A))");
  h.run(1);
  CHECK(getProperty(h.stateOf(12), "unum").toInteger() == 4);
}

TEST_CASE("a repeated init moves the robot to the next start position before kick-offs, and not during play",
          "[soccer]") {
  SoccerMatch h;
  h.importField();
  Puppet& a = h.join("A", 1);
  const bool before = GENERATE(true, false);
  if (!before) h.setMode("PlayOn");
  const std::string again = GENERATE("(init (unum 1)(teamname A))", "(init (teamname A))",
                                     "(init (unum 12)(teamname A))", "(init (unum 3)(teamname A))");
  const Vec3 old = h.bodyOf(1).state().position;
  h.act(a, again);
  h.run(1);
  CHECK((h.bodyOf(1).state().position - old).norm() == Approx(before ? 3 * 0.22 : 0).margin(0.01));
  CHECK(getProperty(h.stateOf(1), "unum").toInteger() == (again.find("3") != again.npos ? 3 : 1));
}

TEST_CASE("a second init with another number releases the first one", "[soccer]") {
  SoccerMatch h;
  h.importField();
  Puppet& a = h.join("A", 3);
  h.act(a, "(init (unum 9)(teamname A))");
  h.run(1);
  CHECK(getProperty(h.stateOf(1), "unum").toInteger() == 9);
  h.act(h.connect("second"), "(init (unum 3)(teamname A))");
  h.run(1);
  CHECK(getProperty(h.stateOf(2), "unum").toInteger() == 3);
}

TEST_CASE("the league's limits of robot types apply", "[soccer]") {
  SoccerMatch h;
  h.importField();
  h.set("MaxRobotTypeCount", 1);
  h.join("A", 1);
  Puppet& b = h.connect("b");
  h.text.clear();
  h.act(b, "(init (unum 2)(teamname A))");
  h.run(1);
  CHECK(h.text.find("robots of type 0 already") != std::string::npos);
  // The number is still free.
  h.set("MaxRobotTypeCount", 11);
  h.act(b, "(init (unum 2)(teamname A))");
  h.run(1);
  CHECK(getProperty(h.stateOf(2), "unum").toInteger() == 2);
}

TEST_CASE("beams are in the team's coordinates and only allowed before kick-offs", "[soccer]") {
  SoccerMatch h;
  h.importField();
  Puppet &a = h.join("A", 1), &b = h.join("B", 1);
  a.next = b.next = "(beam -10 5 0)";
  h.run(3);
  CHECK(h.bodyOf(1).state().position.head<2>().isApprox(Eigen::Vector2d(-10, 5), 0.01));
  CHECK(h.bodyOf(2).state().position.head<2>().isApprox(Eigen::Vector2d(10, -5), 0.01));
  h.act(a, "(beam 10 50 0)");  // beyond the center line and the touch line
  h.run(1);
  CHECK(h.bodyOf(1).state().position.x() <= 0.0);
  CHECK(h.bodyOf(1).state().position.y() == Approx(34).margin(0.01));
  h.setMode("PlayOn");
  h.act(a, "(beam -20 0 0)");
  CHECK(h.bodyOf(1).state().position.x() > -15);
}

TEST_CASE("the beam angle is computed in single precision, step by step", "[soccer]") {
  SoccerMatch h;
  h.importField();
  Puppet& a = h.join("A", 1);
  a.next = "(beam -10 5 -80.5377)";
  h.run(2);
  const float sum = -80.5377F - 90;
  const auto yaw = static_cast<float>(degToRad(sum));
  REQUIRE(yaw != static_cast<float>(degToRad(-80.5377 - 90)));
  const Mat3 r = h.bodyOf(1).state().rotation;
  CHECK(std::atan2(r(1, 0), r(0, 0)) == Approx(static_cast<double>(yaw)).margin(6e-8).epsilon(0));
}

TEST_CASE("a kick's force follows the formula and lasts for the given number of steps", "[soccer]") {
  SoccerMatch h;
  h.importField();
  Puppet& a = h.join("A", 2);
  h.setMode("PlayOn");
  Leaf& kick = h.at("/usr/scene/AgentAspect1/body/KickEffector");
  callMethod(kick, "setNoiseParams", std::vector<Value>{0.0, 0.0, 0.0, 0.0});
  h.placeBall(10, 0);
  h.placeAgent(1, 10 - 0.35, 0);
  a.next = "(kick 30 10)";
  h.run(2);
  const List force = getProperty(kick, "force").toList();
  CHECK(force[0].toNumber() == Approx(4 * 10 * std::cos(degToRad(30))).margin(0.3));
  CHECK(force[1].toNumber() == Approx(0).margin(0.3));
  CHECK(force[2].toNumber() == Approx(4 * 10 * std::sin(degToRad(30))).margin(0.01));
  CHECK(getProperty(kick, "stepsLeft").toInteger() == 9);
  CHECK(h.get("/sys/server/gamecontrol/BallStateAspect", "lastUnum").toInteger() == 2);
  h.run(9);
  CHECK(getProperty(kick, "stepsLeft").toInteger() == 0);
  CHECK(h.ball().state().linearVelocity.x() > 10);
  CHECK(h.ball().state().linearVelocity.z() > 3);
  // Out of reach the kick has no effect.
  a.next = "(kick 0 100)";
  h.run(2);
  CHECK(getProperty(kick, "stepsLeft").toInteger() == 0);
}

TEST_CASE("a drive force persists until the next one, is mirrored for the right team, and drains the battery",
          "[soccer]") {
  SoccerMatch h;
  h.importField();
  Puppet &a = h.join("A", 1), &b = h.join("B", 1);
  h.setMode("PlayOn");
  h.placeAgent(1, -20, 0);
  h.placeAgent(2, 20, 0);
  for (int agent : {1, 2})
    setProperty(h.at("/usr/scene/AgentAspect" + std::to_string(agent) + "/body/DriveEffector"), "sigma", 0);
  a.next = b.next = "(drive 1000 0 0)";
  h.runSeconds(2);
  CHECK(getProperty(h.at("/usr/scene/AgentAspect1/body/DriveEffector"), "force").text() == "{6000.0, 0.0, 0.0}");
  CHECK(h.bodyOf(1).state().linearVelocity.x() > 8);
  CHECK(h.bodyOf(1).state().linearVelocity.x() < 10.5);
  CHECK(h.bodyOf(2).state().linearVelocity.x() < -8);
  // 6000 N drain a third of a percent per second.
  CHECK(getProperty(h.stateOf(1), "battery").toNumber() == Approx(100 - 2.0 / 3).margin(0.03));
  setProperty(h.stateOf(1), "battery", 0);
  h.act(b, "(drive 0 0 0)");
  h.runSeconds(2);
  for (int agent : {1, 2}) CHECK(std::abs(h.bodyOf(agent).state().linearVelocity.x()) < 0.5);
}

TEST_CASE("arguments that are not finite are refused", "[soccer]") {
  SoccerMatch h;
  h.importField();
  Puppet& a = h.join("A", 1);
  h.setMode("PlayOn");
  const Vec3 before = h.bodyOf(1).state().position;
  h.text.clear();
  h.act(a, "(drive nan 0 0)(drive inf 0 0)(drive 1)(kick nan 100)(beam nan 0 0)(pantilt inf 0)");
  h.run(2);
  CHECK((h.bodyOf(1).state().position - before).norm() < 0.01);
  CHECK(h.text.find("expected a finite number as argument 1, found nan") != std::string::npos);
  CHECK(h.text.find("expected a number as argument 2, found none") != std::string::npos);
}

TEST_CASE("only the goalie can catch the ball, inside its area", "[soccer]") {
  SoccerMatch h;
  h.importField();
  Puppet &goalie = h.join("A", 1), &other = h.join("A", 2);
  h.join("B", 9);
  h.setMode("PlayOn");
  h.placeBall(-48, 0);
  h.placeAgent(1, -49, 0);
  h.placeAgent(2, -49, 1);
  h.placeAgent(3, -47, 0);
  h.act(other, "(catch)");
  CHECK(h.ball().state().position.x() == Approx(-48).margin(0.05));
  h.act(goalie, "(catch)");
  CHECK(h.ball().state().position.x() == Approx(-49 + 0.22 + 0.111 + 0.07).margin(0.05));
  CHECK(h.bodyOf(3).state().position.x() > -46);
  // Outside the area.
  h.placeBall(-20, 0);
  h.placeAgent(1, -20.8, 0);
  h.act(goalie, "(catch)");
  CHECK(h.ball().state().position.x() == Approx(-20).margin(0.05));
}

TEST_CASE("pan and tilt stay within their ranges and are reported", "[soccer]") {
  SoccerMatch h;
  h.importField();
  Puppet& a = h.join("A", 1);
  setProperty(h.at("/usr/scene/AgentAspect1/body/PanTiltEffector"), "sigma", 0);
  h.act(a, "(pantilt 30 50)");
  h.run(2);
  CHECK(getProperty(h.stateOf(1), "pan").toNumber() == 30);
  CHECK(getProperty(h.stateOf(1), "tilt").toNumber() == 10);
  h.act(a, "(pantilt 500 10)");
  h.act(a, "(pantilt 500 10)");
  CHECK(getProperty(h.stateOf(1), "pan").toNumber() == 90);
  CHECK(getProperty(h.stateOf(1), "tilt").toNumber() == 20);
  h.run(12);
  CHECK(a.all.find("(AgentState (pan_tilt 90 20) (battery 100.00) (temp 23.00))") != std::string::npos);
}

TEST_CASE("robots without a team collide with no other robot, and become solid when they join one", "[soccer]") {
  const bool detached = GENERATE(true, false);
  SoccerMatch h;
  setProperty(h.kernel.create("TeamlessAspect", "/sys/server/gamecontrol/TeamlessAspect"), "enabled", detached);
  h.importField();
  h.connect("x");
  Puppet& y = h.connect("y");
  h.placeAgent(1, -5, 5);
  h.placeAgent(2, -4.9, 5);
  h.run(10);
  CHECK((std::abs(h.bodyOf(2).state().position.x() + 4.9) < 0.01) == detached);
  h.act(y, "(init (unum 1)(teamname A))");
  h.run(1);
  h.touch(1);
  CHECK(h.get("/sys/server/gamecontrol/BallStateAspect", "lastUnum").toInteger() == 0);
  h.placeAgent(1, -20, 5);
  h.touch(2);
  CHECK(h.get("/sys/server/gamecontrol/BallStateAspect", "lastUnum").toInteger() == 1);
  h.placeAgent(1, -5, 5);
  h.placeAgent(2, -4.9, 5);
  h.run(10);
  CHECK((std::abs(h.bodyOf(2).state().position.x() + 4.9) < 0.01) == detached);
}

TEST_CASE("a new team takes the side of one whose players have all left, and begins without goals", "[soccer]") {
  SoccerMatch h;
  h.importField();
  h.join("A", 1), h.join("A", 2), h.join("B", 1);
  h.trainer("(score (left 3)(right 1))");
  const auto team = [&h](const char* side) {
    return h.get("/sys/server/gamecontrol/GameStateAspect", side).toString();
  };
  h.trainer("(kill (unum 1)(team Left))");
  h.run(2);
  h.join("C", 1);
  CHECK(team("teamLeft") == "A");
  h.trainer("(kill (unum 2)(team Left))");
  h.run(2);
  CHECK(team("teamLeft") == "A");  // for the score board
  h.join("C", 3);
  CHECK(team("teamLeft") == "C");
  CHECK(team("teamRight") == "B");
  CHECK(h.score() == "{0, 1}");
  h.join("A", 4);
  CHECK(team("teamLeft") == "C");
}
