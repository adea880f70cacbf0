#include <map>
#include <set>
#include <sstream>

#include "absence.h"
#include "frame_text.h"
#include "stadium.h"

// Every trainer command of existing programs with the effect that was recorded or is expected, and invalid commands.

using namespace spark;
using namespace spark::test;

namespace {

/// Left player 1, right player 2 and the ball at rest, in PlayOn.
struct Training {
  Stadium s;
  Player &left, &right;
  explicit Training(const Stadium::Settings& settings = {}) : s(settings), left(s.join("A", 1)), right(s.join("B", 2)) {
    s.trainer("(playMode PlayOn)");
    s.trainer(Stadium::put(left, -3, 1) + Stadium::put(right, 5, 2));
  }
  std::string name(const Player& p) const {
    return fmt::format("(unum {})(team {})", p.unum, p.side == Side::left ? "Left" : "Right");
  }
  /// Sends a command for the left player.
  void about(const std::string& command, const std::string& parts = {}) {
    s.trainer("(" + command + " " + name(left) + parts + ")");
  }
  Value state(const char* property, int agent = 1) {
    return s.get(fmt::format("/usr/scene/AgentAspect{}/body/AgentState", agent), property);
  }
  /// Axis 0, 1 or 2 of the first pose in the last message.
  Vec3 axis(int i) const {
    const std::string& m = s.monitor().lastMessage();
    const FrameText matrix(m.substr(m.find("(SLT ")));
    const auto at = static_cast<std::size_t>(4 * i);
    return {matrix.numbers.at(at), matrix.numbers.at(at + 1), matrix.numbers.at(at + 2)};
  }
};

bool near(const Vec3& a, const Vec3& b, double d = 0.02) { return (a - b).norm() <= d; }

}  // namespace

TEST_CASE("(playMode name) sets every mode by its exact name and does not move the ball") {
  Training t;
  t.s.trainer(Stadium::ballTo(2, 3));
  for (const char* mode : {"BeforeKickOff",
                           "KickOff_Left",
                           "KickOff_Right",
                           "KickIn_Left",
                           "KickIn_Right",
                           "corner_kick_left",
                           "corner_kick_right",
                           "goal_kick_left",
                           "goal_kick_right",
                           "offside_left",
                           "offside_right",
                           "Goal_Left",
                           "Goal_Right",
                           "free_kick_left",
                           "free_kick_right",
                           "direct_free_kick_left",
                           "direct_free_kick_right",
                           "GameOver",
                           "pass_left",
                           "pass_right",
                           "PlayOn"}) {
    t.s.trainer("(playMode " + std::string(mode) + ")");
    CHECK(t.s.mode() == mode);
  }
  for (const char* wild : {"(playMode goal_left)", "(playMode)", "(playMode (PlayOn))", "(playMode 3)",
                           "(playMode GameOver2)", "(playmode GameOver)"}) {
    t.s.trainer(wild);
    CHECK(t.s.mode() == "PlayOn");
  }
}

TEST_CASE("(kickOff side) starts play for a side, with None for the side due to kick off, and other words do nothing") {
  Training t;
  t.s.trainer("(playMode BeforeKickOff)");
  for (const char* wild : {"(kickOff)", "(kickOff left)", "(kickOff 1)", "(kickOff (Left))", "(kickOff Both)"}) {
    t.s.trainer(wild);
    CHECK(t.s.mode() == "BeforeKickOff");
  }
  t.s.trainer("(kickOff Left)");
  CHECK(t.s.mode() == "KickOff_Left");
  t.s.trainer("(kickOff Right)");
  CHECK(t.s.mode() == "KickOff_Right");
  t.s.trainer("(playMode BeforeKickOff)");
  t.s.trainer("(kickOff None)");
  CHECK(t.s.mode().starts_with("KickOff_"));
}

TEST_CASE("(ball ...) sets position and velocity of the ball independently") {
  Training t;
  t.s.trainer("(ball (pos 1 2 0.5) (vel 1 0 0))");
  CHECK(near(t.s.ball(), Vec3(1.02, 2, 0.496)));
  t.s.trainer("(ball (vel 0 0 5))");
  CHECK(t.s.ball().z() > 0.55);
  const double z = t.s.ball().z();
  t.s.trainer("(ball (pos -4 -4 " + std::to_string(z) + "))");  // the velocity is kept
  CHECK(t.s.ball().z() > z + 0.05);
  t.s.trainer("(ball (pos 2 2 0.042)(vel 0 0 0))");
  CHECK(near(t.s.ball(), Vec3(2, 2, 0.042)));
}

TEST_CASE("(dropBall) resumes play at the ball's position and moves players away from it") {
  Training t;
  t.s.trainer("(playMode KickIn_Left)" + Stadium::ballTo(1, 1) + Stadium::put(t.left, 0.5, 1));
  t.s.trainer("(dropBall)");
  CHECK(t.s.mode() == "PlayOn");
  CHECK(near(t.s.ball(), Vec3(1, 1, 0.042), 0.05));
  CHECK(Stadium::distance(t.s.at(t.left), t.s.ball()) > 1.9);
}

TEST_CASE("(agent ...) moves, turns and changes the named player") {
  Training t({{"Soccer.ConstantTemperature", false}});
  t.about("agent", "(pos -3 1 0.4)");
  CHECK(near(t.s.at(t.left), Vec3(-3, 1, 0.4)));
  t.about("agent", " (move -2 1.5 0.4 45)");
  CHECK(near(t.s.at(t.left), Vec3(-2, 1.5, 0.4)));
  const double h = std::sqrt(0.5);
  CHECK(near(t.axis(0), Vec3(h, h, 0)));  // its x axis is 45 degrees to the left of the field's
  t.about("agent", "(rot 0 0 90)");
  CHECK(near(t.s.at(t.left), Vec3(-2, 1.5, 0.4)));
  CHECK(near(t.axis(0), Vec3(0, 1, 0)));
  CHECK(near(t.axis(1), Vec3(-1, 0, 0)));
  t.about("agent", "(rot 90 0 0)");
  CHECK(near(t.axis(1), Vec3(0, 0, 1)));
  t.about("agent", "(battery 50)(temperature 30)");
  CHECK(t.state("battery").toNumber() == Approx(50));
  CHECK(t.state("temperature").toNumber() == Approx(30));
  CHECK(near(t.s.at(t.right), Vec3(5, 2, 0.3)));
}

TEST_CASE("(select ...) shows the marker, (agent) moves the selected player away, and (repos) moves it off the field") {
  Training t;
  const auto selected = [&] {
    return std::pair(t.state("selected", 1) == Value(true), t.state("selected", 2) == Value(true));
  };
  CHECK(selected() == std::pair(false, false));
  t.about("select");
  CHECK(selected() == std::pair(true, false));
  t.s.trainer("(select)");
  CHECK(selected() == std::pair(false, true));
  t.s.trainer("(select)");
  CHECK(selected() == std::pair(true, false));
  t.s.trainer("(agent)");
  CHECK(near(t.s.at(t.left), Vec3(-5.5, 1, 0.3), 0.05));
  CHECK(near(t.s.at(t.right), Vec3(5, 2, 0.3), 0.05));
  t.s.trainer("(repos)");
  CHECK(near(t.s.at(t.left), Vec3(-3.6, -10.5, 1), 0.05));
  t.s.trainer("(select (unum -1))(agent)(repos)(kill)");
  CHECK(selected() == std::pair(false, false));
  CHECK(near(t.s.at(t.right), Vec3(5, 2, 0.3), 0.05));
  t.s.trainer("(repos " + t.name(t.right) + ")");
  CHECK(near(t.s.at(t.right), Vec3(3, -10.5, 1), 0.05));
}

TEST_CASE("A robot's marker changes in diffs without a full message") {
  Stadium s;
  Player& p = s.connect();
  p.client.send("(scene rsg/agent/nao/nao.rsg)");
  s.run(3);
  p.client.send("(init (unum 1)(teamname A))");
  s.run(5);
  const int fulls = s.monitor().fullMessages();
  const auto marked = [&](const char* command, const char* expected) {
    s.trainer(command);
    const std::string& m = s.monitor().lastMessage();
    const std::size_t at = m.find("(setVisible ");
    REQUIRE(at != std::string::npos);
    CHECK(m.substr(at, 14) == expected);
    CHECK(count(m, "(setVisible ") == 1);
  };
  marked("(select (unum 1)(team Left))", "(setVisible 1)");
  marked("(select (unum -1))", "(setVisible 0)");
  marked("(select)", "(setVisible 1)");
  CHECK(s.monitor().fullMessages() == fulls);
}

TEST_CASE("(kill ...) removes the robot and closes its agent's connection") {
  Training t;
  const int fulls = t.s.monitor().fullMessages();
  t.s.trainer("(kill " + t.name(t.right) + ")");
  t.s.run(2);
  CHECK(!t.s.monitor().player(Side::right, 2));
  CHECK(t.s.monitor().fullMessages() == fulls + 1);
  CHECK(t.right.client.ended());
  t.about("select");
  t.s.trainer("(kill)");
  t.s.run(2);
  CHECK(!t.s.monitor().player(Side::left, 1));
  CHECK(t.left.client.ended());
}

TEST_CASE("(time t) and (score ...) set the game's clock and score") {
  Training t;
  t.s.trainer("(time 123.5)");
  CHECK(t.s.time() == Approx(123.52));
  t.s.trainer("(score (left 2)(right 1))");
  CHECK(t.s.score() == std::pair(2, 1));
  CHECK(t.s.monitor().lastMessageHas("score_left"));
  t.s.run(1);
  CHECK(!t.s.monitor().lastMessageHas("score_left"));
  t.s.trainer("(kickOff Right)");
  t.s.trainer("(time 200)");  // later than the maximum duration of a kick-off
  CHECK(t.s.mode() == "PlayOn");
}

TEST_CASE("(reqfullstate) requests a full message, (init) and (getAck) do nothing, and (killsim) ends the server") {
  Training t;
  t.s.run(1);
  CHECK(!isFull(t.s.monitor().lastMessage()));
  t.s.trainer("(reqfullstate)");
  CHECK(isFull(t.s.monitor().lastMessage()));
  t.s.trainer("(init)(getAck)(getAck x)");
  CHECK(!isFull(t.s.monitor().lastMessage()));
  CHECK(!t.s.over());
  t.s.command("(killsim)");
  t.s.run(1);
  CHECK(t.s.over());
}

TEST_CASE("Malformed or extreme commands change nothing, and each kind of mistake is logged once") {
  Training t;
  t.s.trainer("(select (unum 2)(team Right))" + Stadium::ballTo(1, 2));
  t.s.run(100);
  const auto scene = [&] {
    const std::string& m = t.s.monitor().lastMessage();
    return m.substr(m.find("(RSG"));
  };
  t.s.trainer("(reqfullstate)");
  const std::string before = scene();
  const Value battery = t.state("battery");
  const std::size_t said = t.s.log().size();
  const std::string numbers[] = {"nan", "inf", "-inf", "1e30",  "-1e30", "1e400",
                                 "x",   "(1)", "0x10", "1.5.2", "\"\"",  "1e"};
  std::vector<std::string> wild = {"(ball)",
                                   "(ball (pos))",
                                   "(ball (pos 1 2))",
                                   "(ball (vel 1))",
                                   "(ball pos 1 2 3)",
                                   "(ball (pos (1 2 3)))",
                                   "(agent (unum))",
                                   "(agent (team Left))",
                                   "(agent (unum 1)(team Left))",
                                   "(agent (unum 1)(team left)(pos 0 0 0))",
                                   "(agent (unum 1)(pos 0 0 0))",
                                   "(agent (unum 7)(team Left)(pos 0 0 0))",
                                   "(agent (unum 1.5)(team Left)(pos 0 0 0))",
                                   "(agent (unum one)(team Left)(pos 0 0 0))",
                                   "(agent x)",
                                   "(select (unum))",
                                   "(select (unum 99)(team Left))",
                                   "(kill (unum))",
                                   "(kill (unum 0)(team Left))",
                                   "(kill (unum 1)(team None))",
                                   "(kill (team Right))",
                                   "(kill x)",
                                   "(repos (unum))",
                                   "(repos (unum 3)(team Right))",
                                   "(repos x y)",
                                   "(time)",
                                   "(time -1)",
                                   "(time (1))",
                                   "(score)",
                                   "(score (left 1))",
                                   "(score (left 1)(right))",
                                   "(score (left -1)(right 1))",
                                   "(score (left 1.5)(right 1))",
                                   "(playMode)",
                                   "(playMode x)",
                                   "(kickOff)",
                                   "(kickOff x)",
                                   "(nosuchcommand 1 2 3)",
                                   "garbage",
                                   "()",
                                   "((()))",
                                   "(",
                                   ")",
                                   "(unbalanced (a",
                                   "\"",
                                   std::string(1, '\0'),
                                   std::string(60000, '('),
                                   "(agent " + std::string(50000, 'x') + ")"};
  for (const std::string& n : numbers) {
    wild.push_back("(ball (pos " + n + " 0 0))");
    wild.push_back("(ball (vel 0 0 " + n + "))");
    wild.push_back("(time " + n + ")");
    wild.push_back("(score (left " + n + ")(right 1))");
    wild.push_back("(agent (unum " + n + ")(team Left)(pos 0 0 0))");
    for (const char* part : {"pos 0 ", "move 0 0 0 ", "rot 0 0 ", "battery ", "temperature "})
      wild.push_back("(agent (unum 1)(team Left)(" + std::string(part) + n + (part[0] == 'p' ? " 0))" : "))"));
  }
  for (std::size_t i = 0; i < wild.size(); ++i) {
    t.s.command(wild[i]);
    if (i % 16 < 15 && i + 1 < wild.size()) continue;
    INFO("one of 16 up to " << wild[i].substr(0, 80));
    t.s.run(1);
    REQUIRE(t.s.score() == std::pair(0, 0));
    REQUIRE(t.s.mode() == "PlayOn");
  }
  t.s.trainer("(reqfullstate)");
  CHECK(difference(before, scene(), 1e-3) == "");
  CHECK(t.state("battery") == battery);
  const std::string log = t.s.log().substr(said);
  CHECK_THAT(log, Catch::Contains("there is no command 'nosuchcommand' here"));
  CHECK_THAT(log, Catch::Contains(": ball: expected (pos x y z) or (vel x y z)"));
  std::istringstream lines(log);
  std::set<std::string> kinds;
  for (std::string line; std::getline(lines, line);) {
    INFO(line);
    CHECK(kinds.insert(line.substr(line.find(": from "))).second);
  }
}
