#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <functional>
#include <nlohmann/json.hpp>

#include "client.h"
#include "humanoid/player.h"
#include "process.h"
#include "test_support.h"

using namespace spark::test;
using humanoid::HumanoidPlayer;
using humanoid::Task;
using Json = nlohmann::json;
using spark::Element;
using spark::Predicates;

namespace {
/// Positions of the robot's torso and the ball [m].
struct Look {
  humanoid::Vec3 torso = humanoid::Vec3::Zero(), ball = humanoid::Vec3::Zero();
};

/// A match in lockstep with a single player of the given robot type, which kicks off after three seconds.
class Training {
 public:
  /// Time does not advance before the player has joined, so the same seed gives the same match.
  Training(int type, int seed)
      : host_(joined({(binFolder() / "sparkhost").string(),
                      "--config",
                      "soccer.lua",
                      "--seed",
                      std::to_string(seed),
                      "--sync",
                      "--rate",
                      "max",
                      "--expect",
                      "1",
                      "--agent-port",
                      "0",
                      "--monitor-port",
                      "0",
                      "--log-level",
                      "error",
                      "--set",
                      "Soccer.AutomaticKickOff=true",
                      "--set",
                      "Soccer.WaitBeforeKickOff=3"},
                     withoutLimits())),
        ports_(Json::parse(host_.line())),
        agent_(ports_["agentPort"].get<unsigned short>()),
        player_("Red", 10, type) {
    Predicates actions;
    player_.start(actions);
    send(actions);
    receive();
  }
  HumanoidPlayer& player() { return player_; }

  /// One cycle in which the player acts.
  void play() {
    Predicates actions;
    player_.think(percepts_, actions);
    send(actions);
    receive();
  }
  /// One cycle in which `message` moves the robot instead. The player gets its percepts, but its actions are discarded.
  void meddle(const std::string& message) {
    Predicates unused, actions;
    player_.think(percepts_, unused);
    spark::readSexp(message, actions);
    send(actions);
    receive();
  }
  /// Plays until `done`, for at most `seconds` of simulated time; returns whether it was done.
  bool playUntil(double seconds, const std::function<bool()>& done) {
    for (double t = 0; t < seconds; t += humanoid::kCycle) {
      if (done()) return true;
      play();
    }
    return false;
  }
  /// The same, with a check of the monitor's frame once a second.
  bool watchUntil(double seconds, const std::function<bool(const Look&)>& done) {
    for (double t = 0; t < seconds; ++t) {
      playUntil(1, [] { return false; });
      if (done(look())) return true;
    }
    return false;
  }
  /// The positions in the next monitor frame.
  Look look() {
    Client monitor(ports_["monitorPort"].get<unsigned short>());
    Predicates scene;
    play();  // the host accepts the monitor between two cycles
    play();
    spark::readSexp(monitor.receive(), scene);
    Look found;
    for (const Element part : scene) collect(part, humanoid::Vec3::Zero(), found);
    return found;
  }

 private:
  void send(Predicates& actions) {
    actions.open("syn").close();
    std::string text;
    spark::writeSexp(actions, 4, text);
    agent_.send(text);
  }
  void receive() {
    percepts_.clear();
    spark::readSexp(agent_.receive(), percepts_);
  }
  /// Positions of the meshes of torso and ball. All body parts of a robot are children of one fixed transform.
  static void collect(const Element& node, humanoid::Vec3 place, Look& found) {
    if (!node.isList()) return;
    if (const Element m = node.named("SLT"))
      place += humanoid::Vec3(m.at(13).number(), m.at(14).number(), m.at(15).number());
    if (const Element mesh = node.named("load")) {
      if (mesh.at(1).text().starts_with("models/naobody")) found.torso = place;
      if (mesh.at(1).text() == "models/soccerball.obj") found.ball = place;
    }
    for (const Element child : node) collect(child, place, found);
  }

  Process host_;
  Json ports_;
  Client agent_;
  HumanoidPlayer player_;
  Predicates percepts_;
};

constexpr double kStanding = 0.3;  // m, minimum height of a standing torso
}  // namespace

/// One of these attempts must succeed: the walk depends on rounding, so it may end in a wrong position on one machine
/// only.
constexpr int kAttempts = 6;

/// "" if the robot got up after a fall on its face (or back), walked and pushed the ball; otherwise the step that
/// failed.
std::string getUpWalkAndPush(int type, bool forward, int seed) {
  Training training(type, seed);
  HumanoidPlayer& player = training.player();
  REQUIRE(training.playUntil(20, [&] { return player.percepts().playMode == "KickOff_Left"; }));
  const std::string ankles = forward ? "(rle5 2)(lle5 2)(rle3 -1)(lle3 -1)" : "(rle5 -2)(lle5 -2)";
  for (int cycle = 0; cycle < 300 && player.posture().lying() == humanoid::Lying::no; ++cycle) training.meddle(ankles);
  REQUIRE(player.posture().lying() != humanoid::Lying::no);
  REQUIRE(training.look().torso.z() < kStanding);

  if (!training.playUntil(150, [&] {
        return player.task() != Task::getUp && player.task() != Task::fall && player.posture().tilt() < 0.3;
      }))
    return "get up";
  const auto [stood, ball] = training.look();
  if (stood.z() < kStanding) return "stand";
  const humanoid::Vec3 from = stood, lay = ball;
  if (!training.watchUntil(120, [&](const Look& now) { return (now.torso - from).head<2>().norm() > 1; }))
    return "walk";
  if (!training.watchUntil(150, [&](const Look& now) { return (now.ball - lay).head<2>().norm() > 1; }))
    return "push the ball";
  return "";
}

TEST_CASE("A humanoid gets up from either side, walks to the ball and pushes it") {
  for (int type = 0; type < humanoid::kRobotTypes; ++type)
    for (const bool forward : {true, false}) {
      std::string failed = "begin", all;
      for (int seed = 1; seed <= kAttempts && !failed.empty(); ++seed) {
        failed = getUpWalkAndPush(type, forward, seed);
        all += failed + " ";
      }
      CAPTURE(type, forward, all);
      REQUIRE(failed.empty());
    }
}
