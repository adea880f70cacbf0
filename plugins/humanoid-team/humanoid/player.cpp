#include "player.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace humanoid {

namespace {
constexpr double kJointShare = 0.8;                        // of the way left that a joint makes in a cycle
constexpr double kBallMemory = 4;                          // s
constexpr double kMateMemory = 1.5;                        // s
constexpr double kRest = 0.3;                              // s that he lies still before he gets up
constexpr double kMostRest = 1.5;                          // s after which he tries all the same
constexpr std::array kPaces{1.0, 1.06, 0.94, 1.12, 0.88};  // what failed once would fail again
constexpr double kRestSpeed = 0.08;                        // rad in a cycle
constexpr double kStill = 0.2;                             // rad/s
constexpr double kBeamEvery = 0.1;                         // s
constexpr double kBeamTime = 1.0;                          // s in which he is beamed to his place
constexpr double kAskEvery = 1;                            // s between two inits that were not answered
constexpr int kSaySlots = 22;                              // cycles in which each of eleven speaks once

void armsDown(const Build& build, Pose& pose) {
  pose[Joint::rShoulderPitch] = pose[Joint::lShoulderPitch] = radians(-100);
  pose[Joint::rShoulderYaw] = -build.armsOut;
  pose[Joint::lShoulderYaw] = build.armsOut;
  for (const Joint j : {Joint::rArmRoll, Joint::rElbow, Joint::lArmRoll, Joint::lElbow, Joint::rToe, Joint::lToe}) pose[j] = 0;
}
}  // namespace

HumanoidPlayer::HumanoidPlayer(std::string team, int unum, int type)
    : team_(std::move(team)),
      unum_(std::clamp(unum, 1, 11)),
      type_(type),
      build_(buildOf(type)),
      drive_(build_),
      walk_(build_, gaitOf(type)),
      kick_(build_, gaitOf(type)),
      recovery_(recoveryOf(type)) {
  standStill();
}

void HumanoidPlayer::start(spark::Predicates& actions) const {
  actions.open("scene").add("rsg/agent/nao/nao_hetero.rsg").add(type_).close();
}

void HumanoidPlayer::think(const spark::Predicates& message, spark::Predicates& actions) {
  sense(message);
  if (percepts_.side.empty()) {
    if (percepts_.now - initAt_ > kAskEvery) actions.open("init").pair("unum", unum_).pair("teamname", team_).close();
    if (percepts_.now - initAt_ > kAskEvery) initAt_ = percepts_.now;
    standStill();
  } else {
    act(decideNow(), actions);
    say(actions);
  }
  look();
  drive_.drive(pose_, percepts_.joints, kJointShare, actions);
}

// ---- what he knows ----

void HumanoidPlayer::sense(const spark::Predicates& message) {
  read(message, team_, percepts_);
  posture_.update(percepts_);
  const Velocity& v = walk_.velocity();
  localisation_.update(percepts_, posture_, walking_ ? Vec2(Vec2(v.right, v.forward) * kCycle) : Vec2(Vec2::Zero()));
  senseBall();
  hear();
  if (posture_.lying() == Lying::no)
    lyingSince_ = -1;
  else if (lyingSince_ < 0)
    lyingSince_ = percepts_.now;
}

void HumanoidPlayer::senseBall() {
  if (!percepts_.ball || !localisation_.known()) return;
  ball_ = localisation_.toField(Localisation::level(*percepts_.ball, percepts_, posture_).head<2>());
  ballAt_ = percepts_.now;
}

/// A message is `unum:x:y:d`: the ball's place and the speaker's distance from it, in cm.
void HumanoidPlayer::hear() {
  for (const std::string& text : percepts_.heard) {
    int unum = 0, x = 0, y = 0, d = 0;
    if (std::sscanf(text.c_str(), "%d:%d:%d:%d", &unum, &x, &y, &d) != 4 || unum < 1 || unum > 11) continue;
    mates_[static_cast<std::size_t>(unum)] = {percepts_.now, d / 100.0};
    if (percepts_.now - ballAt_ < kMateMemory) continue;
    ball_ = Vec2(x, y) / 100.0;
    ballAt_ = percepts_.now - 0.5 * kBallMemory;
  }
}

/// Who lies has further to go.
double HumanoidPlayer::toBall() const { return (ball_ - localisation_.place()).norm() + (lyingSince_ >= 0 || busy() ? 2 : 0); }

Situation HumanoidPlayer::situation() const {
  Situation s;
  s.playMode = percepts_.playMode;
  s.side = percepts_.side;
  s.unum = unum_;
  s.lying = posture_.lying();
  s.tilt = posture_.tilt();
  s.located = localisation_.known();
  s.ballKnown = percepts_.now - ballAt_ < kBallMemory;
  s.place = localisation_.place();
  s.heading = localisation_.heading();
  s.ball = ball_;
  s.nearest = true;
  for (int i = 1; i <= 11; ++i) {
    const Mate& mate = mates_[static_cast<std::size_t>(i)];
    if (i != unum_ && percepts_.now - mate.heardAt < kMateMemory && (mate.toBall < toBall() - 0.1 * (i > unum_))) s.nearest = false;
  }
  return s;
}

Decision HumanoidPlayer::decideNow() const { return decide(situation()); }

// ---- what he does ----

void HumanoidPlayer::act(const Decision& decision, spark::Predicates& actions) {
  if (!pausedMode(percepts_.playMode))
    pausedSince_ = -1;
  else if (pausedSince_ < 0)
    pausedSince_ = percepts_.now;
  if (movement_.playing()) return movement_.step(pose_);
  if (recovery_.playing()) return recovery_.step(percepts_, posture_, pose_);
  if (kick_.playing() && decision.task != Task::getUp && decision.task != Task::fall) return kick_.step(pose_);
  task_ = decision.task;
  if (task_ != Task::getUp && task_ != Task::fall) attempts_ = 0;
  switch (decision.task) {
    case Task::takePlace:
      return takePlace(decision.target, actions);
    case Task::fall:
      return standStill();
    case Task::getUp:
      return getUp();
    case Task::search:
      return walk({0, 0, 0.6});
    case Task::stand:
      return walk({});
    case Task::walk: {
      const Steering s = steer(localisation_.toRobot(decision.target), normalized(decision.facing - localisation_.heading()));
      return walk({s.forward, s.right, s.turn});
    }
    case Task::kick:
      walk({});
      if (walking_) return;
      kick_.start(decision.rightFoot);
      return;
  }
}

void HumanoidPlayer::takePlace(const Vec2& place, spark::Predicates& actions) {
  standStill();
  if (percepts_.now - pausedSince_ > kBeamTime || percepts_.now - beamAt_ < kBeamEvery) return;
  actions.open("beam").add(place.x()).add(place.y()).add(0).close();
  beamAt_ = percepts_.now;
  posture_.reset();
}

/// From back or belly he lies still with straight limbs first: the movements were found from there. On a side he would tip back meanwhile.
void HumanoidPlayer::getUp() {
  walking_ = false;
  kick_.stop();
  if (posture_.lying() == Lying::onSide) return movement_.start(tipForward(), pose_);
  Pose stance = pose_;
  armsDown(build_, stance);
  walk_.stand(stance);
  double off = 0;
  for (std::size_t i = index(Joint::rShoulderPitch); i < kJoints; ++i) {
    pose_.at(i) += std::clamp(stance.at(i) - pose_.at(i), -kRestSpeed, kRestSpeed);
    off = std::max(off, std::abs(stance.at(i) - pose_.at(i)));
  }
  if (off > 0) restingSince_ = percepts_.now;
  if (off > 0 || percepts_.gyro.norm() > kStill) stillSince_ = percepts_.now;
  if (percepts_.now - stillSince_ < kRest && percepts_.now - restingSince_ < kMostRest) return;
  if (posture_.lying() == Lying::onBack) return movement_.start(rollOver(), pose_, attempts_++ % 2 == 1);
  recovery_.start(pose_, stance, kPaces[static_cast<std::size_t>(attempts_++) % kPaces.size()]);
}

/// Stops when both feet are down, and begins anew when there is somewhere to go.
void HumanoidPlayer::walk(const Velocity& velocity) {
  const bool wanted = std::abs(velocity.forward) > 0.01 || std::abs(velocity.right) > 0.01 || std::abs(velocity.turn) > 0.05;
  if (!walking_ && !wanted) return standStill();
  if (!walking_) walk_.start();
  walking_ = true;
  armsDown(build_, pose_);
  walk_.step(velocity, percepts_, posture_, pose_);
  if (!wanted && walk_.mayStop()) walking_ = false;
}

void HumanoidPlayer::standStill() {
  walking_ = false;
  armsDown(build_, pose_);
  walk_.stand(pose_);
}

/// Turns the head to the ball; sweeps while it does not know where that is.
void HumanoidPlayer::look() {
  const bool known = localisation_.known() && percepts_.now - ballAt_ < kBallMemory;
  double pan = radians(60) * std::sin(percepts_.now * 1.5), tilt = radians(-20);
  if (task_ == Task::getUp)
    pan = tilt = 0;
  else if (known) {
    const Vec2 way = localisation_.toRobot(ball_);
    pan = std::clamp(std::atan2(-way.x(), way.y()), radians(-100), radians(100));
  }
  const auto moved = [](double from, double to) { return from + std::clamp(to - from, -0.06, 0.06); };
  pose_[Joint::headYaw] = moved(pose_[Joint::headYaw], pan);
  pose_[Joint::headPitch] = moved(pose_[Joint::headPitch], tilt);
}

void HumanoidPlayer::say(spark::Predicates& actions) const {
  const auto cycle = static_cast<long>(percepts_.now / kCycle + 0.5);
  if (cycle % kSaySlots != 2 * (unum_ - 1) || !localisation_.known() || percepts_.now - ballAt_ > 1) return;
  const auto cm = [](double m) { return std::clamp(static_cast<int>(std::lround(m * 100)), -9999, 9999); };
  actions.open("say").add(fmt::format("{}:{}:{}:{}", unum_, cm(ball_.x()), cm(ball_.y()), cm(toBall()))).close();
}

}  // namespace humanoid
