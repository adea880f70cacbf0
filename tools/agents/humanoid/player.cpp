#include "player.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>

namespace humanoid {

namespace {
constexpr double kJointShare = 0.8;          // of the way left that a joint makes in a cycle
constexpr double kBallMemory = 4;            // s
constexpr double kMateMemory = 1.5;          // s
constexpr double kOtherMemory = 0.8;         // s that a player is taken to be where he was seen
constexpr double kAtBall = 0.4;              // m: he plays the ball, or may have
constexpr double kTouch = 0.2;               // m from the ball: he has touched it
constexpr double kDuel = 1.0;                // m from the ball: an opponent plays it, too
constexpr double kBarred = 8;                // s after which another player is assumed to have touched the ball
constexpr double kRest = 0.1;                // s that he lies, at least, before he gets up
constexpr double kMostRest = 0.35;           // s after which he tries although he still rolls
constexpr double kUpright = radians(40);     // of tilt at most
constexpr double kPropped = 1, kSits = 1.2;  // s without standing upright, without a foot on the ground: he lies
constexpr double kStill = 1;                 // rad/s
constexpr double kSlip = 0.78;               // of the speed that is walked
constexpr double kSettling = 0.03;           // rad in a cycle towards the stance
constexpr double kForgets = 6;               // s after which an attempt to get up is another one
constexpr double kSteady = 0.5;              // s that he treads on the spot then
constexpr double kBeamEvery = 0.1;           // s
constexpr double kBeamTime = 1.0;            // s in which he is beamed to his place
constexpr double kAskEvery = 1;              // s between two inits that were not answered
constexpr int kSaySlots = 22;                // cycles in which each of eleven speaks once

void armsDown(const Build& build, Pose& pose) {
  pose[Joint::rShoulderPitch] = pose[Joint::lShoulderPitch] = radians(-100);
  pose[Joint::rShoulderYaw] = -build.armsOut;
  pose[Joint::lShoulderYaw] = build.armsOut;
  for (const Joint j : {Joint::rArmRoll, Joint::rElbow, Joint::lArmRoll, Joint::lElbow, Joint::rToe, Joint::lToe})
    pose[j] = 0;
}
}  // namespace

HumanoidPlayer::HumanoidPlayer(std::string team, int unum, int type)
    : team_(std::move(team)),
      unum_(std::clamp(unum, 1, 11)),
      type_(type),
      build_(buildOf(type)),
      drive_(build_),
      gait_(gaitOf(type)),
      walk_(build_, gait_) {
  armsDown(build_, pose_);
  walk_.stand(pose_);
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
  drive_.drive(pose_, percepts_.joints, walking_ ? gait_.share : kJointShare, actions);
}

// ---- what he knows ----

void HumanoidPlayer::sense(const spark::Predicates& message) {
  read(message, team_, percepts_);
  posture_.update(percepts_);
  const Velocity& v = walk_.velocity();
  const Vec2 moved = walking_ ? Vec2(Vec2(v.right, v.forward) * kSlip * kCycle) : Vec2(Vec2::Zero());
  localisation_.update(percepts_, posture_, moved);
  ballFromHere_ = Eigen::Rotation2Dd(-(posture_.level() * percepts_.gyro).z() * kCycle) * (ballFromHere_ - moved);
  senseBall();
  senseOthers();
  hear();
  watchRestart();
  if (posture_.tilt() < kUpright) uprightAt_ = percepts_.now;
  if (percepts_.rightFoot || percepts_.leftFoot || pausedMode(percepts_.playMode)) footAt_ = percepts_.now;
  if (lying() == Lying::no)
    lyingSince_ = -1;
  else if (lyingSince_ < 0)
    lyingSince_ = percepts_.now;
}

/// Propped up on his limbs, or sitting, he lies as well.
Lying HumanoidPlayer::lying() const {
  if (posture_.lying() != Lying::no) return posture_.lying();
  if (percepts_.now - uprightAt_ > kPropped) return posture_.forward() > 0 ? Lying::onFront : Lying::onBack;
  return percepts_.now - footAt_ > kSits ? Lying::onBack : Lying::no;
}

void HumanoidPlayer::senseBall() {
  if (percepts_.ball) {
    ballFromHere_ = localisation_.level(*percepts_.ball, percepts_, posture_).head<2>();
    if (localisation_.known()) ballAt_ = percepts_.now;
  }
  ball_ = localisation_.toField(ballFromHere_);
}

void HumanoidPlayer::senseOthers() {
  std::erase_if(others_, [this](const Other& o) { return percepts_.now - o.seenAt > kOtherMemory; });
  if (!localisation_.known()) return;
  for (const SeenPlayer& p : percepts_.players) {
    if (p.team == team_ && p.unum == unum_) continue;  // his own arms
    const Vec2 place = localisation_.toField(localisation_.level(p.place, percepts_, posture_).head<2>());
    const auto known = std::find_if(others_.begin(), others_.end(),
                                    [&](const Other& o) { return o.unum == p.unum && o.team == p.team; });
    if (known != others_.end())
      *known = {p.team, p.unum, percepts_.now, place};
    else
      others_.push_back({p.team, p.unum, percepts_.now, place});
  }
}

/// A player that took a restart may not touch the ball again before another player has.
void HumanoidPlayer::watchRestart() {
  const bool ours = !pausedMode(percepts_.playMode) && percepts_.playMode != "PlayOn" &&
                    !theirBall(percepts_.playMode, percepts_.side);
  const bool atBall = percepts_.now - ballAt_ < 1 && (ball_ - localisation_.place()).norm() < kAtBall;
  if (restart_ && percepts_.playMode == "PlayOn" && atBall) barredSince_ = percepts_.now;
  restart_ = ours;
  if (barredSince_ < 0) return;
  const bool touched = std::any_of(others_.begin(), others_.end(),
                                   [this](const Other& o) { return (o.place - ball_).norm() < kTouch; }) ||
                       std::any_of(mates_.begin(), mates_.end(),
                                   [this](const Mate& m) { return m.heardAt > barredSince_ && m.toBall < kTouch; });
  if (touched || percepts_.now - barredSince_ > kBarred || percepts_.playMode != "PlayOn") barredSince_ = -1;
}

/// A message is `unum:x:y:d`: the ball's place and the speaker's way to it, in cm.
void HumanoidPlayer::hear() {
  for (const std::string& text : percepts_.heard) {
    int unum = 0, x = 0, y = 0, d = 0;
    if (std::sscanf(text.c_str(), "%d:%d:%d:%d", &unum, &x, &y, &d) != 4 || unum < 1 || unum > 11) continue;
    mates_[static_cast<std::size_t>(unum)] = {percepts_.now, d / 100.0};
    if (percepts_.now - ballAt_ < kMateMemory) continue;
    ball_ = Vec2(x, y) / 100.0;
    ballFromHere_ = localisation_.toRobot(ball_);
    ballAt_ = percepts_.now - 0.5 * kBallMemory;
  }
}

/// Adds distance for a player that lies, and puts one that may not touch the ball out of the running.
double HumanoidPlayer::toBall() const {
  return wayToBall(localisation_.place(), ball_) + (lyingSince_ >= 0 || getUp_.playing() ? 2 : 0) +
         (barredSince_ >= 0 ? 20 : 0);
}

Situation HumanoidPlayer::situation() const {
  Situation s;
  s.playMode = percepts_.playMode;
  s.side = percepts_.side;
  s.unum = unum_;
  s.lying = lying();
  s.tilt = posture_.tilt();
  s.located = localisation_.known();
  s.ballKnown = percepts_.now - ballAt_ < kBallMemory;
  s.place = localisation_.place();
  s.heading = localisation_.heading();
  s.ball = ball_;
  s.barred = barredSince_ >= 0;
  s.contested = std::any_of(others_.begin(), others_.end(),
                            [this](const Other& o) { return o.team != team_ && (o.place - ball_).norm() < kDuel; });
  s.nearest = true;
  for (int i = 1; i <= 11; ++i) {
    const Mate& mate = mates_[static_cast<std::size_t>(i)];
    if (i != unum_ && percepts_.now - mate.heardAt < kMateMemory && (mate.toBall < toBall() - 0.1 * (i > unum_)))
      s.nearest = false;
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
  if (getUp_.playing()) return rise();
  task_ = decision.task;
  switch (decision.task) {
    case Task::takePlace:
      return takePlace(decision.target, actions);
    case Task::fall:
      walking_ = false;
      return settle();
    case Task::getUp:
      return getUp();
    case Task::search:
      return walk({0, 0, 0.6});
    case Task::stand:
      return percepts_.playMode == "GameOver" ? standStill() : walk({});
    case Task::walk: {
      const Vec2 target = localisation_.toRobot(decision.target);
      const Steering s = steer(pass(target, inTheWay(0)), normalized(decision.facing - localisation_.heading()));
      return walk({s.forward, s.right, s.turn});
    }
    case Task::run: {
      const Steering s = run(pass(localisation_.toRobot(decision.target), inTheWay(kAtBall)));
      return walk({s.forward, s.right, s.turn});
    }
    case Task::push: {
      const Steering s =
          push(localisation_.toRobot(decision.target), normalized(decision.facing - localisation_.heading()));
      return walk({s.forward, s.right, s.turn});
    }
  }
}

/// The others from the robot, without those so near to the ball.
std::vector<Vec2> HumanoidPlayer::inTheWay(double nearBall) const {
  std::vector<Vec2> places;
  for (const Other& o : others_)
    if ((o.place - ball_).norm() > nearBall) places.push_back(localisation_.toRobot(o.place));
  return places;
}

void HumanoidPlayer::takePlace(const Vec2& place, spark::Predicates& actions) {
  standStill();
  if (percepts_.now - pausedSince_ > kBeamTime || percepts_.now - beamAt_ < kBeamEvery) return;
  actions.open("beam").add(place.x()).add(place.y()).add(0).close();
  beamAt_ = percepts_.now;
  posture_.reset();
}

void HumanoidPlayer::getUp() {
  walking_ = false;
  const double lain = percepts_.now - lyingSince_;
  if (lain < kRest || (percepts_.gyro.norm() > kStill && lain < kMostRest)) return;
  fell_ = lying();
  // what failed twice would fail again
  static constexpr std::array other{Lying::onSide, Lying::onSide, Lying::onSide, Lying::onBack};
  if (percepts_.now - triedAt_ > kForgets) attempts_ = 0;
  triedAt_ = percepts_.now;
  const bool again = ++attempts_ % 3 == 0;
  getUp_.start(movementOf(type_, again ? other.at(static_cast<std::size_t>(fell_)) : fell_), pose_);
  rise();
}

/// Who lies on another side after the first pose begins anew; who stands treads on the spot for a moment.
void HumanoidPlayer::rise() {
  getUp_.step(percepts_, posture_, pose_);
  const Lying lies = posture_.lying();
  uprightAt_ = footAt_ = percepts_.now;
  if (getUp_.begun() && lies != Lying::no && lies != fell_) return getUp_.stop();
  if (getUp_.playing() || lies != Lying::no) return;
  roseAt_ = percepts_.now;
  localisation_.lose();  // while it lay it saw the world askew
  walk_.start(pose_);
  walking_ = true;
}

/// Treads on the spot where there is nowhere to go.
void HumanoidPlayer::walk(const Velocity& velocity) {
  if (!walking_) walk_.start(pose_);
  walking_ = true;
  armsDown(build_, pose_);
  const bool steady = percepts_.now - roseAt_ > kSteady;
  walk_.step(steady ? velocity : Velocity{}, percepts_, posture_, pose_);
}

/// Walks to a halt, then stretches.
void HumanoidPlayer::standStill() {
  if (walking_ && !walk_.mayStop()) return walk({});
  walking_ = false;
  settle();
}

void HumanoidPlayer::settle() {
  Pose stance = pose_;
  armsDown(build_, stance);
  walk_.stand(stance);
  for (std::size_t i = index(Joint::rShoulderPitch); i < kJoints; ++i)
    pose_.at(i) = towards(pose_.at(i), stance.at(i), kSettling);
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
  const auto moved = [](double from, double to) { return towards(from, to, 0.04); };
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
