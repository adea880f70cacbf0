#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <map>

#include "humanoid/get_up.h"
#include "humanoid/joint_drive.h"
#include "humanoid/legs.h"
#include "humanoid/localisation.h"
#include "humanoid/player.h"
#include "humanoid/tactics.h"

using namespace humanoid;

namespace {
Mat3 about(const Vec3& axis, double rad) { return Eigen::AngleAxisd(rad, axis.normalized()).toRotationMatrix(); }

/// Position of the sole relative to the hip, and its orientation, from the joint axes in the robot's description.
std::pair<Vec3, Mat3> soleOf(const Build& build, bool right, const Pose& pose) {
  const std::size_t first = index(right ? Joint::rHipYaw : Joint::lHipYaw);
  const double side = right ? 1 : -1;
  const Mat3 hip = about(Vec3(-1, 0, side), pose.at(first)) * about(Vec3::UnitY(), pose.at(first + 1)) *
                   about(Vec3::UnitX(), pose.at(first + 2));
  const Mat3 shank = hip * about(Vec3::UnitX(), pose.at(first + 3));
  const Mat3 foot = shank * about(Vec3::UnitX(), pose.at(first + 4)) * about(Vec3::UnitY(), pose.at(first + 5));
  return {hip * Vec3(0, kKneeForward, -build.thigh) + shank * Vec3(0, 0, -build.shank) + foot * Vec3(0, 0, -kSole),
          foot};
}

spark::Predicates message(const std::string& text) {
  spark::Predicates p;
  spark::readSexp(text, p);
  return p;
}

/// The marks that a robot at `place` (left team's frame) with this heading sees, upright and looking ahead.
Percepts view(const Vec2& place, double heading, std::initializer_list<const char*> names) {
  Percepts p;
  p.side = "left";
  p.seeing = true;
  for (const Landmark& mark : landmarks())
    for (const char* name : names)
      if (mark.name == name) {
        const Vec2 way = Eigen::Rotation2Dd(kPi / 2 - heading) * (mark.place.head<2>() - place);
        p.sightings.push_back({&mark, Vec3(way.x(), way.y(), mark.place.z() - 0.35 - kCameraHeight)});
      }
  return p;
}

Situation playing() {
  Situation s;
  s.playMode = "PlayOn";
  s.side = "left";
  s.unum = 10;
  s.located = s.ballKnown = s.nearest = true;
  return s;
}
}  // namespace

TEST_CASE("Angles are normalized to one turn") {
  REQUIRE(normalized(3 * kPi + 0.5) == Approx(-kPi + 0.5));
  REQUIRE(normalized(-kPi - 0.5) == Approx(kPi - 0.5));
  REQUIRE(normalized(0.25) == Approx(0.25));
}

TEST_CASE("A team of eleven respects the league's limits of robot types") {
  std::map<int, int> count;
  for (int unum = 1; unum <= 11; ++unum) ++count[robotType(unum)];
  REQUIRE(count.size() == kRobotTypes);
  for (const auto& [a, n] : count) {
    REQUIRE((a >= 0 && a < kRobotTypes));
    REQUIRE(n <= 7);
    for (const auto& [b, m] : count) REQUIRE((a == b || n + m <= 9));
  }
}

TEST_CASE("Inverse kinematics puts the soles at the desired poses for all builds and both legs") {
  for (int type = 0; type < kRobotTypes; ++type)
    for (const bool right : {true, false})
      for (const double yaw : {0.0, right ? -0.4 : 0.4})
        for (const double pitch : {-0.1, 0.15}) {
          const Build& build = buildOf(type);
          Foot foot;
          foot.place = Vec3(right ? 0.02 : -0.02, 0.03, -0.9 * legLength(build));
          foot.yaw = yaw;
          foot.pitch = pitch;
          Pose pose{};
          placeFoot(build, right, foot, pose);
          const auto [place, turn] = soleOf(build, right, pose);
          CAPTURE(type, right, yaw, pitch, place.transpose(), foot.place.transpose());
          REQUIRE((place - foot.place).norm() < 1e-6);
          REQUIRE((turn - about(Vec3::UnitZ(), yaw) * about(Vec3::UnitX(), pitch)).norm() < 1e-6);
        }
}

TEST_CASE("A position out of reach gives a straight leg in its direction") {
  const Build& build = buildOf(0);
  Foot foot;
  foot.place = Vec3(0, 0, -1);
  Pose pose{};
  placeFoot(build, true, foot, pose);
  REQUIRE(soleOf(build, true, pose).first.z() == Approx(-legLength(build)).margin(0.001));
}

TEST_CASE("Joints reach their targets within their speed, including the pending command") {
  JointDrive drive(buildOf(2));
  Pose angle{}, wanted{}, underWay{};
  wanted[Joint::rKnee] = radians(-60);
  wanted[Joint::rAnkleRoll] = radians(20);
  for (int cycle = 0; cycle < 40; ++cycle) {
    spark::Predicates out;
    drive.drive(wanted, angle, 0.8, out);
    for (std::size_t i = 0; i < kJoints; ++i) angle.at(i) += underWay.at(i) * kCycle;  // a command acts one cycle later
    for (const spark::Element e : out)
      for (std::size_t i = 0; i < kJoints; ++i)
        if (kJointFacts[i].effector == e.head()) underWay.at(i) = e.at(1).number();
    REQUIRE(std::abs(underWay[Joint::rKnee]) < 6.14);
    REQUIRE(std::abs(underWay[Joint::rAnkleRoll]) < 3.48);
    REQUIRE(angle[Joint::rKnee] > radians(-60.5));
  }
  REQUIRE(degrees(angle[Joint::rKnee]) == Approx(-60).margin(0.1));
  REQUIRE(degrees(angle[Joint::rAnkleRoll]) == Approx(20).margin(0.1));
}

TEST_CASE("A message is parsed into game, joints, feet, marks, ball, players and hearing") {
  Percepts p;
  read(message("(time (now 12.34))(GS (unum 7) (team right) (sl 1) (sr 2) (t 5.00) (pm KickOff_Left))"
               "(hear Red 5.00 self 1:2:3:4)"
               "(hear Red 5.00 -12.00 2:100:-50:33)(hear Blue 5.00 3.00 secret)(GYR (n torso) (rt 90.00 0.00 -0.09))"
               "(ACC (n torso) (a 0.00 0.10 9.81))(HJ (n hj1) (ax 45.00))(See (G2R (pol 10.00 90.00 0.00)) "
               "(B (pol 2.00 0.00 -30.00)) (P (team Blue) (id 3) (head (pol 1.00 0.00 0.00))) "
               "(L (pol 1.00 2.00 3.00) (pol 1.00 2.00 3.00)))"
               "(HJ (n llj6) (ax -3.00))(FRP (n lf) (c 0.00 0.00 0.00) (f 0.00 0.00 20.00))"),
       "Red", p);
  REQUIRE(p.now == 12.34);
  REQUIRE(p.side == "right");
  REQUIRE(p.unum == 7);
  REQUIRE((p.scoreLeft == 1 && p.scoreRight == 2 && p.playMode == "KickOff_Left"));
  REQUIRE(p.heard == std::vector<std::string>{"2:100:-50:33"});
  REQUIRE(p.gyro.x() == Approx(kPi / 2));
  REQUIRE(p.joints[Joint::headYaw] == Approx(radians(45)));
  REQUIRE(p.joints[Joint::lAnkleRoll] == Approx(radians(-3)));
  REQUIRE((p.leftFoot && !p.rightFoot));
  REQUIRE(p.sightings.size() == 1);
  REQUIRE((p.sightings[0].place - Vec3(-10, 0, 0)).norm() < 1e-9);  // 90 degrees is left
  REQUIRE((*p.ball - Vec3(0, std::sqrt(3.0), -1)).norm() < 1e-9);
  REQUIRE(p.players.at(0).unum == 3);
  read(message("(time (now 12.36))(GS (sl 1) (sr 2) (t 5.00) (pm PlayOn))"), "Red", p);
  REQUIRE((p.side == "right" && !p.seeing && !p.ball && p.heard.empty() && !p.leftFoot));
}

TEST_CASE("Two marks determine position and heading, and for the right team the field is rotated") {
  for (const double heading : {0.0, 0.7, -2.5}) {
    Localisation here;
    Percepts p = view({-4, 2}, heading, {"F1R", "G2R"});
    here.update(p, Posture(), Vec2::Zero());
    REQUIRE(here.known());
    REQUIRE((here.place() - Vec2(-4, 2)).norm() < 1e-6);
    REQUIRE(normalized(here.heading() - heading) == Approx(0).margin(1e-6));
    REQUIRE((here.toField(here.toRobot({3, 1})) - Vec2(3, 1)).norm() < 1e-9);
    p.side = "right";
    Localisation there;
    there.update(p, Posture(), Vec2::Zero());
    REQUIRE((there.place() - Vec2(4, -2)).norm() < 1e-6);
    REQUIRE(std::abs(normalized(there.heading() - heading)) == Approx(kPi).margin(1e-6));
  }
}

TEST_CASE("Between sightings the position follows steps and turns, and becomes unknown after a while") {
  Localisation here;
  here.update(view({0, 0}, 0, {"F1R", "F2R"}), Posture(), Vec2::Zero());
  Percepts blind;
  blind.side = "left";
  for (int i = 0; i < 50; ++i) here.update(blind, Posture(), Vec2(0, 0.01));
  REQUIRE((here.place() - Vec2(0.5, 0)).norm() < 1e-6);
  REQUIRE(here.known());
  blind.gyro.z() = 1;
  for (int i = 0; i < 50; ++i) here.update(blind, Posture(), Vec2::Zero());
  REQUIRE(here.heading() == Approx(1).margin(1e-6));
  for (int i = 0; i < 200; ++i) here.update(blind, Posture(), Vec2::Zero());
  REQUIRE_FALSE(here.known());
}

TEST_CASE("The posture determines on which side the robot lies") {
  const auto lyingWith = [](const Vec3& acceleration) {
    Posture posture;
    Percepts p;
    p.acceleration = acceleration;
    for (int i = 0; i < 300; ++i) posture.update(p);
    return posture.lying();
  };
  REQUIRE(lyingWith({0, 0, 9.81}) == Lying::no);
  REQUIRE(lyingWith({0, -9.81, 0}) == Lying::onFront);  // the back is up
  REQUIRE(lyingWith({0, 9.81, 0}) == Lying::onBack);
  REQUIRE(lyingWith({9.81, 0, 0.5}) == Lying::onSide);
  Posture falling;
  Percepts p;
  p.acceleration = Vec3::Zero();
  p.gyro = Vec3(-kPi / 2, 0, 0);  // forward, at 90 degrees per second
  for (int i = 0; i < 25; ++i) falling.update(p);
  REQUIRE(degrees(falling.forward()) == Approx(45).margin(2));
}

TEST_CASE("A movement plays its frames in time, symmetrically, and holds the first one") {
  static constexpr std::array<Keyframe, 2> frames{
      {{0.2, -40, 30, 10, 20, -15, 5, 60, -90, 30}, {0.1, 0, 0, 0, 0, 0, 0, 0, -20, 0}}};
  const Movement movement{frames};
  GetUp getUp;
  Percepts percepts;
  Posture posture;
  Pose pose{};
  getUp.start(movement, pose);
  int cycles = 0, begun = 0;
  while (getUp.playing()) {
    getUp.step(percepts, posture, pose);
    if (++cycles == 24) {
      REQUIRE(degrees(pose[Joint::rShoulderPitch]) == Approx(-40));
      REQUIRE(degrees(pose[Joint::rShoulderYaw]) == Approx(-30));
      REQUIRE(degrees(pose[Joint::lShoulderYaw]) == Approx(30));
      REQUIRE(degrees(pose[Joint::lHipRoll]) == Approx(5));
      REQUIRE(degrees(pose[Joint::rAnkleRoll]) == Approx(5));
    }
    begun += getUp.begun();
  }
  REQUIRE(cycles == 30);
  REQUIRE(begun == 1);
  REQUIRE(degrees(pose[Joint::lKnee]) == Approx(-20));
  REQUIRE(degrees(pose[Joint::rShoulderYaw]) == Approx(0).margin(1e-9));
}

TEST_CASE("Near the end of a movement the ankles control the torso's lean") {
  static constexpr std::array<Keyframe, 2> frames{
      {{0.1, 0, 0, 0, 0, 0, 0, 0, 0, 10}, {0.1, 0, 0, 0, 0, 0, 0, 0, 0, 10}}};
  const Movement movement{frames, 0.5, 0, 20, 20};
  GetUp getUp;
  Percepts percepts;
  Posture posture;  // upright: 20 degrees less than desired
  Pose pose{};
  getUp.start(movement, pose);
  while (getUp.playing()) getUp.step(percepts, posture, pose);
  REQUIRE(degrees(pose[Joint::rAnklePitch]) == Approx(20));
}

TEST_CASE("All types have movements for all lying postures within the joint limits") {
  for (int type = 0; type < kRobotTypes; ++type)
    for (const Lying lying : {Lying::onFront, Lying::onBack, Lying::onSide})
      for (const Keyframe& k : movementOf(type, lying).frames) {
        CAPTURE(type, static_cast<int>(lying));
        REQUIRE(k.seconds > 0.03);
        REQUIRE((std::abs(k.shoulderPitch) <= 120 && std::abs(k.armRoll) <= 120 && k.shoulderOut >= 0 &&
                 k.shoulderOut <= 95));
        REQUIRE((k.elbow >= -1 && k.elbow <= 90 && k.hipYaw <= 1 && k.hipYaw >= -90 && std::abs(k.legOut) <= 25));
        REQUIRE((k.hipPitch >= -25 && k.hipPitch <= 100 && k.knee >= -130 && k.knee <= 1 && k.ankle >= -45 &&
                 k.ankle <= 75));
      }
}

TEST_CASE("Getting up has priority over moving into position, and that over searching the ball") {
  Situation s = playing();
  s.tilt = radians(55);
  REQUIRE(decide(s).task == Task::fall);
  s.lying = Lying::onBack;
  s.playMode = "BeforeKickOff";
  REQUIRE(decide(s).task == Task::getUp);
  s.lying = Lying::no;
  s.tilt = 0;
  REQUIRE(decide(s).task == Task::takePlace);
  REQUIRE(decide(s).target.x() < 0);
  s.playMode = "PlayOn";
  s.ballKnown = false;
  REQUIRE(decide(s).task == Task::search);
  s.playMode = "GameOver";
  REQUIRE(decide(s).task == Task::stand);
}

TEST_CASE("The nearest player goes behind the ball and then through it, towards the goal") {
  Situation s = playing();
  s.place = {-2, 0.1};
  Decision d = decide(s);
  REQUIRE(d.task == Task::run);
  REQUIRE(d.target.x() > s.place.x());
  s.place = {-0.2, 0.05};
  d = decide(s);
  REQUIRE(d.task == Task::push);
  REQUIRE((d.target - s.ball).norm() < 0.1);
  REQUIRE(std::abs(d.facing) < radians(20));
  s.heading = radians(90);  // turns first
  REQUIRE(decide(s).task == Task::walk);
  s.place = {0.6, 0.05};  // in front of the ball: walk around it
  d = decide(s);
  REQUIRE(d.task == Task::walk);
  REQUIRE(std::abs(d.target.y()) > 0.3);
  REQUIRE(d.target.x() < 0.3);
}

TEST_CASE("The way to the ball is longer for a player that must walk around it") {
  REQUIRE(wayToBall({2, 0}, {5, 0}) == Approx(3));
  REQUIRE(wayToBall({6.2, 0}, {5, 0}) > 3);
  REQUIRE(wayToBall({6, 0}, {5, 0}) > wayToBall({5, 1}, {5, 0}));
}

TEST_CASE("In a duel the ball is played sideways, but not near the goal") {
  Situation s = playing();
  s.contested = true;
  for (const double x : {0.0, 12.0}) {
    s.ball = {x, 0};
    s.place = {x - 0.2, 0.2};
    const Decision d = decide(s);
    CAPTURE(x, degrees(d.facing));
    REQUIRE((d.facing < radians(-30)) == (x < 11));
  }
}

TEST_CASE("A nearby position is approached without a turn, backwards or sideways, and a distant one is faced first") {
  REQUIRE(steer({0, -0.6}, 0).forward < -0.2);
  REQUIRE(steer({0, -0.6}, 0).turn == Approx(0).margin(1e-9));
  REQUIRE(steer({0.3, 0}, 0).right > 0.2);
  REQUIRE(steer({0, -5}, 0).forward == 0);
  REQUIRE(std::abs(steer({0, -5}, 0).turn) > 1);
  REQUIRE(std::abs(steer({0, -0.6}, kPi).turn) > 1);  // the robot must face that direction anyway
}

TEST_CASE("A player does not walk past a ball that is not in front of its foot yet") {
  REQUIRE(push({0, 0.3}, 0).forward == 1);
  const Steering aside = push({0.15, 0.15}, 0);
  REQUIRE((aside.right > 0.2 && aside.forward < 0.2));
  REQUIRE(push({0.15, 0.02}, 0).forward == 0);
}

TEST_CASE("The player that took the restart leaves the ball to others") {
  Situation s = playing();
  s.place = {-0.3, 0};
  s.barred = true;
  REQUIRE(decide(s).task == Task::walk);
  REQUIRE(decide(s).target.x() < -1);
}

TEST_CASE("Players are passed on the nearer side, and only those in the way are considered") {
  REQUIRE((pass({0, 5}, {{0.1, 0.8}}) - Vec2(0, 5)).norm() > 1);
  REQUIRE(pass({0, 5}, {{0.1, 0.8}}).x() < 0);
  REQUIRE(pass({0, 5}, {{-0.1, 0.8}}).x() > 0);
  REQUIRE((pass({0, 5}, {{0, -0.5}, {1, 0.8}, {0, 3}}) - Vec2(0, 5)).norm() < 1e-9);
}

TEST_CASE("Other players keep a distance, the goalie stays at its goal, and none approaches the opponents' restart") {
  Situation s = playing();
  s.nearest = false;
  s.place = {-0.3, 0};
  REQUIRE(decide(s).task == Task::walk);
  for (int unum = 2; unum <= 11; ++unum) REQUIRE((waitingPlace(unum, {1, 1}) - Vec2(1, 1)).norm() > 1.4);
  s.unum = 1;
  s.nearest = true;
  REQUIRE(decide(s).target.x() < -14);
  s.unum = 10;
  s.playMode = "KickIn_Right";
  s.place = {-1, 0};
  const Decision d = decide(s);
  REQUIRE(d.task == Task::walk);
  REQUIRE((d.target - s.ball).norm() > 2);
  s.playMode = "KickIn_Left";
  REQUIRE((decide(s).target - s.ball).norm() < 0.6);
}

TEST_CASE("A player that is not at its target yet moves") {
  for (double bearing = -3.1; bearing <= 3.1; bearing += 0.1)
    for (const double distance : {0.2, 0.49, 0.51, 0.79, 0.81, 5.0}) {
      const Steering s = steer(Vec2(-std::sin(bearing), std::cos(bearing)) * distance, 0);
      CAPTURE(bearing, distance);
      REQUIRE((std::abs(s.forward) > 0.1 || std::abs(s.right) > 0.1 || std::abs(s.turn) > 0.1));
    }
}

TEST_CASE("Play modes determine which team has the ball") {
  REQUIRE(theirBall("KickOff_Left", "right"));
  REQUIRE_FALSE(theirBall("KickOff_Left", "left"));
  REQUIRE(theirBall("goal_kick_right", "left"));
  REQUIRE_FALSE(theirBall("PlayOn", "left"));
  REQUIRE((pausedMode("Goal_Left") && pausedMode("BeforeKickOff") && !pausedMode("GameOver")));
}

TEST_CASE("A player requests robot and team, beams, and answers every message with all joints of its type") {
  for (const int type : {0, 4}) {
    HumanoidPlayer player("Red", 9, type);
    spark::Predicates actions;
    player.start(actions);
    std::string out;
    spark::writeSexp(actions, 2, out);
    REQUIRE(out == "(scene rsg/agent/nao/nao_hetero.rsg " + std::to_string(type) + ")");
    actions.clear();
    player.think(message("(time (now 1.00))(GS (sl 0) (sr 0) (t 0.00) (pm BeforeKickOff))"), actions);
    out.clear();
    spark::writeSexp(actions, 2, out);
    REQUIRE(out.starts_with("(init (unum 9) (teamname Red))"));
    actions.clear();
    player.think(message("(time (now 1.02))(GS (unum 9) (team left) (sl 0) (sr 0) (t 0.00) (pm BeforeKickOff))"),
                 actions);
    out.clear();
    spark::writeSexp(actions, 2, out);
    REQUIRE(out.starts_with("(beam -2.40 2.50 0)"));
    std::size_t joints = 0;
    for (const spark::Element e : actions)
      for (const JointFacts& j : kJointFacts) joints += j.effector == e.head();
    REQUIRE(joints == (type == 4 ? 24 : 22));
  }
}
