// Vision and hearing of players, messages to monitors, trainer commands.
#include <algorithm>

#include "match_house.h"

using namespace spark;
using namespace spark::test;

namespace {

void disableVisionNoise(SoccerMatch& h, int agent) {
  const Value off(false);
  callMethod(h.at("/usr/scene/AgentAspect" + std::to_string(agent) + "/body/VisionPerceptor"), "addNoise",
             std::span(&off, 1));
}

}  // namespace

TEST_CASE(
    "vision is relative to the field's axes from the team's view, covers all directions and excludes the player itself",
    "[soccer]") {
  SoccerMatch h;
  h.importField();
  Puppet &a = h.join("A", 1), &b = h.join("B", 2);
  h.setMode("PlayOn");
  disableVisionNoise(h, 1), disableVisionNoise(h, 2);
  h.placeAgent(1, -10, 0);
  h.placeAgent(2, 10, 0);
  h.placeBall(0, 10);
  h.run(2);
  a.all.clear(), b.all.clear();
  h.run(6);
  INFO(a.all);
  // A faces +x, so the ball is ahead to the left. B faces -x, so the ball is ahead to the right.
  CHECK(a.all.find("(B (pol 14.14 45.00 -0.4") != std::string::npos);
  CHECK(b.all.find("(B (pol 14.14 -45.00 -0.4") != std::string::npos);
  CHECK(a.all.find("(P (team B) (id 2) (pol 20.00 0.00 ") != std::string::npos);
  CHECK(b.all.find("(P (team A) (id 1) (pol 20.00 0.00 ") != std::string::npos);
  CHECK(lacks(a.all, "(team A)", b.all));
  // Behind: its own corner flag, 42 m back and 34 m to the left.
  CHECK(a.all.find("(F1L (pol 54.04 141.01 -0.23))") != std::string::npos);
  CHECK(b.all.find("(F2R (pol 54.04 141.01 -0.23))") != std::string::npos);
  for (const char* mark : {"F1L", "F2L", "F1R", "F2R", "G1L", "G2L", "G1R", "G2R"})
    CHECK(a.all.find(mark) != std::string::npos);
  CHECK(count(a.all, "(See ") == 2);  // every third cycle
}

TEST_CASE("vision has small noise that differs each time", "[soccer]") {
  SoccerMatch h;
  h.importField();
  Puppet& a = h.join("A", 1);
  h.setMode("PlayOn");
  h.placeAgent(1, -10, 0);
  h.placeBall(40, 0);
  h.run(3);
  a.all.clear();
  h.run(60);
  Predicates p;
  readSexp(a.all, p);
  double sum = 0, squares = 0;
  int n = 0;
  for (const Element e : p) {
    if (e.head() != "See") continue;
    const double d = e.named("B").named("pol").at(1).number();
    sum += d, squares += d * d, ++n;
  }
  REQUIRE(n == 20);
  const double mean = sum / n, sigma = std::sqrt(std::max(0.0, squares / n - mean * mean));
  CHECK(mean == Approx(50).margin(0.1));
  CHECK(sigma > 0.005);
  CHECK(sigma < 0.2);
}

namespace {
/// The players in a See percept, in its order: "A3 B1 ".
std::string seen(const std::string& percepts) {
  Predicates p;
  readSexp(percepts, p);
  std::string out;
  for (const Element e : p)
    for (const Element object : e)
      if (object.head() == "P")
        out += fmt::format("{}{} ", object.named("team").at(1).text(), object.named("id").at(1).text());
  return out;
}
}  // namespace

TEST_CASE("a player with limited vision range sees all objects within it in scene order", "[soccer]") {
  SoccerMatch h;
  h.importField();
  h.set("VisionNoise", false);
  struct {
    const char* team;
    int unum;
    double x, y;
  } const positions[] = {{"A", 1, 0, 0}, {"B", 9, -9, 0},     {"A", 7, 40, 30},  {"B", 2, 0, 11},
                         {"A", 4, 5, 5}, {"B", 3, 9.5, -0.5}, {"A", 5, -40, -30}};
  std::vector<Puppet*> puppets;
  for (const auto& p : positions) puppets.push_back(&h.join(p.team, p.unum));
  h.setMode("PlayOn");
  const auto look = [&] {
    for (std::size_t i = 0; i < puppets.size(); ++i)
      h.placeAgent(static_cast<int>(i) + 1, positions[i].x, positions[i].y);
    h.placeBall(8, 8);
    h.run(2);
    for (Puppet* p : puppets) p->all.clear();
    h.run(3);
  };
  const auto seenBy = [&](int i) { return seen(puppets[i]->all); };
  look();
  CHECK(seenBy(0) == "B9 A7 B2 A4 B3 A5 ");
  const std::string far = puppets[0]->all;
  // An eye with a longer range than those for which the grid was built.
  Node& body = h.kernel.root().require<Node>("/usr/scene/AgentAspect1/body");
  setProperty(body.require<Leaf>("VisionPerceptor"), "range", 10);
  look();
  CHECK(seenBy(0) == "B9 A4 B3 ");
  CHECK(lacks(puppets[0]->all, "(B ", far));
  CHECK(seenBy(4) == "A1 B9 A7 B2 B3 A5 ");
  h.set("VisionRange", 30);
  look();
  CHECK(seenBy(0) == "B9 A4 B3 ");
  CHECK(seenBy(1) == "A1 B2 A4 B3 ");
  CHECK(seenBy(2).empty());
  CHECK(seenBy(6).empty());
  h.set("VisionRange", 200);
  look();
  CHECK(seenBy(6) == "A1 B9 A7 B2 A4 B3 ");
}

TEST_CASE("teams may be larger than in soccer", "[soccer]") {
  SoccerMatch h;
  h.importField();
  for (const char* limit : {"TeamSize", "MaxRobotTypeCount", "MaxSumTwoRobotTypes"}) h.set(limit, 14);
  for (int unum : {1, 12, 14, 15}) h.join("A", unum);
  h.join("A", 0);
  CHECK(getProperty(h.stateOf(3), "unum").toInteger() == 14);
  CHECK(getProperty(h.stateOf(4), "unum").toInteger() == 0);
  CHECK(getProperty(h.stateOf(5), "unum").toInteger() == 2);
  h.setMode("PlayOn");
  h.touch(3);
  h.run(3);
  CHECK(h.get("/sys/server/gamecontrol/BallStateAspect", "lastUnum").toInteger() == 14);
}

TEST_CASE("cone vision sees only objects in the cone, which pan turns", "[soccer]") {
  SoccerMatch h;
  h.importField();
  Puppet& a = h.join("A", 1);
  h.setMode("PlayOn");
  Node& body = h.kernel.root().require<Node>("/usr/scene/AgentAspect1/body");
  body.remove(*body.child("VisionPerceptor"));
  Leaf& eye = body.create("RestrictedVisionPerceptor", "eye");
  const Value off(false);
  callMethod(eye, "addNoise", std::span(&off, 1));
  callMethod(eye, "setViewCones", std::vector<Value>{30, 30});
  h.placeAgent(1, 0, 0);
  h.placeBall(10, 0);
  h.run(3);
  CHECK(a.heard.find("(B (pol 10.00 0.00") != std::string::npos);
  CHECK(a.heard.find("G1R") != std::string::npos);
  const std::string ahead = a.heard;
  setProperty(h.stateOf(1), "pan", 20);
  h.run(3);
  CHECK(a.heard.find("(B (pol 10.00 -20.00") != std::string::npos);
  CHECK(lacks(ahead, "F1R", a.heard));  // 33 degrees to the left
}

TEST_CASE("cone vision in the head's frame looks along y", "[soccer]") {
  SoccerMatch h;
  h.importField();
  Puppet& a = h.join("A", 1);
  h.setMode("PlayOn");
  Node& body = h.kernel.root().require<Node>("/usr/scene/AgentAspect1/body");
  body.remove(*body.child("VisionPerceptor"));
  Leaf& eye = body.create("RestrictedVisionPerceptor", "eye");
  const Value off(false);
  callMethod(eye, "addNoise", std::span(&off, 1));
  callMethod(eye, "setStaticSenseAxis", std::span(&off, 1));
  callMethod(eye, "setViewCones", std::vector<Value>{120, 120});
  h.placeAgent(1, 0, 0);
  h.placeBall(0, 10);
  h.run(3);
  INFO(a.heard);
  CHECK(a.heard.find("(B (pol 10.00 0.00") != std::string::npos);
  h.placeBall(-5, 5);  // ahead to the left
  h.run(3);
  CHECK(a.heard.find("(B (pol 7.07 45.00") != std::string::npos);
  const std::string aside = a.heard;
  h.placeBall(0, -10);  // behind
  h.run(3);
  CHECK(lacks(a.heard, "(B ", aside));
}

namespace {

/// Checks that all objects in the agent's last See are at the true positions that the eye reports. Returns their
/// number.
std::size_t checkedSights(SoccerMatch& h, IEye& eye, int agent) {
  auto& control = h.kernel.root().require<IGameControl>("/sys/server/gamecontrol");
  const auto& aspect = h.kernel.root().require<AgentAspect>("/usr/scene/AgentAspect" + std::to_string(agent));
  Element see;
  for (int i = 0; i < 3 && !see; ++i) {
    h.run(1);
    for (const Element e : *control.percepts(aspect))
      if (e.head() == "See") see = e;
  }
  std::vector<IEye::Sight> sights;
  eye.sights(sights);
  std::size_t checked = 0;
  const auto check = [&](const std::string& name, const Element& polar) {
    INFO(name);
    const auto at = std::find_if(sights.begin(), sights.end(), [&](const IEye::Sight& s) { return s.name == name; });
    REQUIRE(at != sights.end());
    const Vec3f place = eye.placeOf(polar.at(1).number(), polar.at(2).number(), polar.at(3).number());
    CHECK((place - at->place).norm() < 1e-3f);
    // The x axis of the view points ahead.
    const Vec3f way = rigidInverse(eye.view()).block<3, 3>(0, 0) * (at->place - positionOf(eye.view()));
    CHECK(std::abs(radToDeg(std::atan2(way.y(), way.x()))) <= eye.cone()[0] / 2 + 0.01);
    ++checked;
  };
  for (const Element e : see) {
    if (!e.isList()) continue;
    if (e.head() != "P") {
      check(std::string(e.head()), e.at(1));
      continue;
    }
    const std::string name =
        "P " + std::string(e.named("team").at(1).text()) + " " + std::to_string(e.named("id").at(1).integer());
    for (const Element part : e)
      if (part.isList() && part.head() == "pol")
        check(name, part);
      else if (part.isList() && part.named("pol"))
        check(name + " " + std::string(part.head()), part.named("pol"));
  }
  return checked;
}

}  // namespace

TEST_CASE("an eye converts its percepts to world positions in any orientation", "[soccer]") {
  SoccerMatch h;
  h.importField();
  h.join("A", 1), h.join("B", 2), h.join("B", 3);
  h.setMode("PlayOn");
  h.placeAgent(3, 9, 7);
  h.placeBall(12, 5, 3);
  const Value off(false);
  const auto turn = [&](int agent, double x, double y) {
    h.bodyOf(agent).setPose({Vec3(x, y, 2), toPose(rotationDeg(17, 5, 40)).rotation});
  };
  disableVisionNoise(h, 1), disableVisionNoise(h, 2);
  turn(1, -8, 3), turn(2, 20, 1);
  for (const int agent : {1, 2}) {
    const std::string body = "/usr/scene/AgentAspect" + std::to_string(agent) + "/body";
    auto& all = h.kernel.root().require<IEye>(body + "/VisionPerceptor");
    CHECK(all.cone() == std::array<double, 2>{360, 180});
    CHECK(all.range() == std::numeric_limits<double>::infinity());
    CHECK(checkedSights(h, all, agent) == 11);
    setProperty(h.at(body + "/VisionPerceptor"), "staticSenseAxis", false);
    turn(agent, 3, 3);
    CHECK(checkedSights(h, all, agent) == 11);

    auto& node = h.kernel.root().require<Node>(body);
    node.remove(h.at(body + "/VisionPerceptor"));
    Leaf& cone = node.create("RestrictedVisionPerceptor", "eye");
    callMethod(cone, "addNoise", std::span(&off, 1));
    callMethod(cone, "setViewCones", std::vector<Value>{75, 60});
    setProperty(cone, "range", 70);
    auto& eye = h.kernel.root().require<IEye>(body + "/eye");
    CHECK(eye.cone() == std::array<double, 2>{150, 120});
    CHECK(eye.range() == 70);
    setProperty(h.stateOf(agent), "pan", 30);
    setProperty(h.stateOf(agent), "tilt", -10);
    CHECK(checkedSights(h, eye, agent) >= 3);
    setProperty(cone, "staticSenseAxis", false);
    CHECK(eye.cone() == std::array<double, 2>{74, 60});
    turn(agent, 30, -30);
    CHECK(checkedSights(h, eye, agent) >= 2);
  }
}

TEST_CASE("other players hear a message in every second cycle, and the speaker hears each of its messages",
          "[soccer]") {
  SoccerMatch h;
  h.importField();
  Puppet &a = h.join("A", 1), &mate = h.join("A", 2), &b = h.join("B", 1);
  h.setMode("PlayOn");
  h.placeAgent(1, 0, 10), h.placeAgent(2, 0, 0), h.placeAgent(3, 10, 10);
  h.run(3);
  for (Puppet* p : {&a, &mate, &b}) p->all.clear();
  for (int i = 0; i < 6; ++i) {
    a.next = "(say m" + std::to_string(i) + ")";
    h.run(1);
  }
  h.run(3);
  for (int i = 0; i < 6; ++i) {
    const std::string word = "m" + std::to_string(i) + ")";
    CHECK(count(a.all, "self " + word) == 1);
    CHECK(count(mate.all, "90.00 " + word) == (i % 2 == 0));
    CHECK(count(b.all, "-0.00 " + word) + count(b.all, " 0.00 " + word) ==
          (i % 2 == 0));  // ahead in B's view of the field
  }
  CHECK(mate.all.find("(hear A ") != std::string::npos);
}

TEST_CASE("messages that are too long, unprintable or out of range are not delivered", "[soccer]") {
  SoccerMatch h;
  h.importField();
  Puppet &a = h.join("A", 1), &mate = h.join("A", 2);
  h.setMode("PlayOn");
  h.placeAgent(1, -40, 0), h.placeAgent(2, 20, 0);
  mate.all.clear();
  h.act(a, "(say far)");
  h.run(2);
  h.placeAgent(2, -35, 0);
  h.act(a, "(say 123456789012345678901)");
  h.run(2);
  h.act(a, "(say \"two words\")");
  h.run(2);
  const std::string before = mate.all;
  CHECK(h.text.find("without blanks and brackets, found byte 32") != std::string::npos);
  h.act(a, "(say 12345678901234567890)");
  h.run(2);
  CHECK(mate.all.find("180.00 12345678901234567890)") != std::string::npos);
  CHECK(lacks(before, "hear", mate.all));
}

TEST_CASE("monitors receive field, modes, teams, score and fouls", "[soccer]") {
  SoccerMatch h;
  h.importField();
  const auto environment = [&h] {
    Environment env;
    for (const char* item : {"GameStateItem", "SoccerRuleItem"})
      h.kernel.root().require<IMonitorItem>(std::string("/sys/server/monitor/") + item).contribute(env);
    std::string text;
    writeSexp(env.predicates, 3, text);
    return text;
  };
  const std::string before = environment();
  h.join("A", 1);
  h.trainer("(score (left 3)(right 2))");
  const std::string env = environment();
  CHECK(lacks(before, "team_left", env));
  CHECK(env.starts_with("(FieldLength 104.000)(FieldWidth 68.000)"));
  CHECK(env.find("(play_modes BeforeKickOff KickOff_Left KickOff_Right PlayOn") != std::string::npos);
  CHECK(env.find("(team_left A)(half 1)(score_left 3)(score_right 2)(play_mode 0)") != std::string::npos);
  callMethod(h.at("/sys/server/gamecontrol/SoccerRuleAspect"), "reportFoul", std::vector<Value>{6, "right", 4});
  const std::string foul = environment();
  CHECK(foul.find("(foul 1 6 2 4)") != std::string::npos);
  CHECK(lacks(environment(), "foul", foul));
}

TEST_CASE("trainers move ball and players and set modes and times, and invalid commands are ignored with a reason",
          "[soccer]") {
  SoccerMatch h;
  h.importField();
  h.join("A", 1), h.join("B", 2);
  CHECK(h.trainer("(playMode PlayOn)").empty());
  CHECK(h.mode() == "PlayOn");
  CHECK(h.trainer("(ball (pos 3 4 0.111)(vel 1 0 0))").empty());
  h.run(1);
  CHECK(h.ball().state().position.isApprox(Vec3(3.02, 4, 0.111), 0.01));
  CHECK(h.trainer("(agent (unum 1)(team Left)(pos -3 1 0.22))").empty());
  CHECK(h.bodyOf(1).state().position.isApprox(Vec3(-3, 1, 0.22), 0.001));
  CHECK(h.trainer("(agent (unum 2)(team Right)(move 5 6 0.22 -90)(battery 40))").empty());
  CHECK(h.bodyOf(2).state().rotation(0, 1) == Approx(1).margin(1e-3));  // its y axis points along +x
  CHECK(getProperty(h.stateOf(2), "battery").toNumber() == 40);
  CHECK(h.trainer("(time 12.5)").empty());
  CHECK(h.gameTime() == 12.5);
  CHECK(h.trainer("(select (unum 2)(team Right))").empty());
  CHECK(getProperty(h.stateOf(2), "selected").toBool());
  CHECK(h.trainer("(select)").empty());
  CHECK(getProperty(h.stateOf(1), "selected").toBool());
  CHECK_FALSE(getProperty(h.stateOf(2), "selected").toBool());
  CHECK(h.trainer("(repos (unum 1)(team Left))").empty());
  CHECK(h.bodyOf(1).state().position.isApprox(Vec3(-3.6, -34.5, 1.0), 0.01));
  CHECK(h.trainer("(select (unum -1))").empty());
  CHECK(h.trainer("(playMode Kickoff)") == "expected a play mode, found 'Kickoff'");
  CHECK(h.trainer("(kickOff left)") == "expected Left, Right or None, found 'left'");
  CHECK(h.trainer("(ball (pos 1 nan 0))") == "expected (pos x y z) or (vel x y z)");
  CHECK(h.trainer("(agent (unum 9)(team Left)(pos 0 0 0))") == "no such player");
  CHECK(h.trainer("(score (left 1))") == "expected (left a)(right b), both 0 or more");
  CHECK(h.trainer("(time -1)") == "expected a time of 0 to 1000000 s");
  CHECK(h.trainer("(time 1e300)") == "expected a time of 0 to 1000000 s");  // infinite in single precision
  CHECK(h.trainer("(ball (vel 1e300 0 0))") == "expected (pos x y z) or (vel x y z)");
  h.trainer("(agent (unum 1)(team Left)(temperature -1e300)(pos 1e300 0 0))");
  CHECK(getProperty(h.stateOf(1), "temperature").toNumber() == 20);
  CHECK(h.bodyOf(1).state().position.norm() < 100);
  CHECK(h.trainer("(dance)") == "unknown");
  CHECK(h.gameTime() == 12.5);
}

TEST_CASE("a trainer that repeatedly switches modes does not fill the log", "[soccer]") {
  SoccerMatch h;
  h.importField();
  h.join("A", 1);
  h.text.clear();
  for (int i = 0; i < 100; ++i) h.trainer("(playMode PlayOn)"), h.trainer("(playMode corner_kick_left)");
  CHECK(std::count(h.text.begin(), h.text.end(), '\n') < 10);
  h.run(1);
  h.text.clear();
  h.trainer("(playMode PlayOn)");
  CHECK(h.text.find("PlayOn after") != std::string::npos);
}

TEST_CASE("cone vision sees the visible part of field lines", "[soccer]") {
  SoccerMatch h;
  h.importField();
  Puppet& a = h.join("A", 1);
  h.setMode("PlayOn");
  Node& body = h.kernel.root().require<Node>("/usr/scene/AgentAspect1/body");
  body.remove(*body.child("VisionPerceptor"));
  Leaf& eye = body.create("RestrictedVisionPerceptor", "eye");
  const Value off(false), on(true);
  callMethod(eye, "addNoise", std::span(&off, 1));
  callMethod(eye, "setStaticSenseAxis", std::span(&off, 1));
  callMethod(eye, "setSenseLine", std::span(&on, 1));
  callMethod(eye, "setViewCones", std::vector<Value>{90, 90});
  h.placeAgent(1, 0, 24);  // 10 m from the touch line, which is visible from 10 m right to 10 m left
  h.run(3);
  INFO(a.heard);
  CHECK(a.heard.find("(L (pol 14.14 -45.00 -0.8") != std::string::npos);  // clipped at both edges
  CHECK(a.heard.find(") (pol 14.14 45.00 -0.8") != std::string::npos);
  Predicates nan;
  nan.open("L").add(std::nan("")).close();
  std::string written;
  writeSexp(nan, 2, written);
  CHECK(lacks(a.heard, "nan", written));
}
