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
/// Places of the robot's torso and the ball [m].
struct Look {
  humanoid::Vec3 torso = humanoid::Vec3::Zero(), ball = humanoid::Vec3::Zero();
};

/// A match of one player of the given robot type against nobody, in lockstep: a kick-off for him after three seconds.
class Training {
 public:
  /// The clock stands until he is there: with the same seed the same happens.
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

  /// One cycle of the player's.
  void play() {
    Predicates actions;
    player_.think(percepts_, actions);
    send(actions);
    receive();
  }
  /// One cycle in which other hands move the robot, who knows what happens to him.
  void meddle(const std::string& message) {
    Predicates unused, actions;
    player_.think(percepts_, unused);
    spark::readSexp(message, actions);
    send(actions);
    receive();
  }
  /// Plays until `done`, at most for `seconds` of simulated time; true when it was done.
  bool playUntil(double seconds, const std::function<bool()>& done) {
    for (double t = 0; t < seconds; t += humanoid::kCycle) {
      if (done()) return true;
      play();
    }
    return false;
  }
  /// The same, with a monitor that looks once a second.
  bool watchUntil(double seconds, const std::function<bool(const Look&)>& done) {
    for (double t = 0; t < seconds; ++t) {
      playUntil(1, [] { return false; });
      if (done(look())) return true;
    }
    return false;
  }
  /// What a monitor sees.
  Look look() {
    Client monitor(ports_["monitorPort"].get<unsigned short>());
    Predicates scene;
    play();  // a cycle in which the monitor is noticed
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
  /// Where the meshes of torso and ball hang. Every robot's body parts are children of a transform that stays where it
  /// is.
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

constexpr double kStanding = 0.3;  // m, least height of a standing torso
}  // namespace

/// Of so many attempts one must succeed: a walk over rough numbers may end in the wrong place on one machine and not on
/// another.
constexpr int kAttempts = 6;

/// "" when the robot that was thrown on its face (or back) got up, walked and pushed the ball; else what it failed to
/// do.
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

TEST_CASE("A humanoid gets up after falling, on either side, walks to the ball and pushes it") {
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
