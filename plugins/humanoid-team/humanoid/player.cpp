#include "player.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>

namespace humanoid {

namespace {
constexpr double kJointShare = 0.8;       // fraction of the remaining angle that a joint covers in a cycle
constexpr double kBallMemory = 4;         // time for which a position is used: of the ball [s]
constexpr double kMateMemory = 1.5;       // of a team-mate's message [s]
constexpr double kOtherMemory = 0.8;      // of an observed player [s]
constexpr double kAtBall = 0.4;           // distance at which a player may have played the ball [m]
constexpr double kTouch = 0.2;            // distance at which a player has touched the ball [m]
constexpr double kDuel = 1.0;             // distance of an opponent to the ball in a duel [m]
constexpr double kBarred = 8;             // after this time another player is assumed to have touched the ball [s]
constexpr double kRest = 0.1;             // smallest time to lie before getting up [s]
constexpr double kMaxRest = 0.35;         // after this time it gets up even if it still rolls [s]
constexpr double kUpright = radians(40);  // largest tilt
constexpr double
    kPropped = 1,
    kSits = 1.2;  // time without being upright, or without a foot on the ground, after which it counts as lying [s]
constexpr double kStill = 1;             // angular speed of a robot at rest [rad/s]
constexpr double kSlip = 0.78;           // real speed as a fraction of the commanded one
constexpr double kSettling = 0.03;       // change of angles per cycle towards the stance [rad]
constexpr double kForgets = 6;           // after this time the count of attempts to get up is reset [s]
constexpr double kSteady = 0.5;          // time of stepping on the spot after getting up [s]
constexpr double kBeamEvery = 0.1;       // between two beams [s]
constexpr double kBeamTime = 1.0;        // from the start of a pause in which it beams [s]
constexpr double kSettlesAfter = 0.5;    // from its last beam until it knows its place [s]
constexpr double kAstray = radians(30);  // of a heading that is the opposite one
constexpr double kAskEvery = 1;          // between two inits without an answer [s]
constexpr int kSaySlots = 22;            // cycles in which each of eleven players speaks once

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

// ---- percepts ----

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

/// A robot that is propped up on its limbs, or sits, counts as lying, too.
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
    if (p.team == team_ && p.unum == unum_) continue;  // its own arms
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

/// A message is `unum:x:y:d`: position of the ball and length of the speaker's path to it [cm].
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

/// Length of the own path to the ball [m]; longer for a player that lies, and much longer for one that may not touch
/// it.
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

// ---- actions ----

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

/// Positions of the other players relative to the robot, except those within `nearBall` of the ball [m].
std::vector<Vec2> HumanoidPlayer::inTheWay(double nearBall) const {
  std::vector<Vec2> places;
  for (const Other& o : others_)
    if ((o.place - ball_).norm() > nearBall) places.push_back(localisation_.toRobot(o.place));
  return places;
}

void HumanoidPlayer::takePlace(const Vec2& place, spark::Predicates& actions) {
  standStill();
  noticeSide();
  if (percepts_.now - pausedSince_ > kBeamTime || percepts_.now - beamAt_ < kBeamEvery) return;
  actions.open("beam").add(place.x()).add(place.y()).add(0).close();
  beamAt_ = percepts_.now;
  posture_.reset();
}

/// Servers may not announce that teams have changed sides. A player that has beamed stands in its own half and looks
/// ahead; if the landmarks say the opposite, they are those of the other side.
void HumanoidPlayer::noticeSide() {
  const bool settled = percepts_.now - pausedSince_ > kBeamTime + kSettlesAfter;
  if (!settled || !localisation_.known() || localisation_.place().x() < 1 ||
      std::abs(localisation_.heading()) < kPi - kAstray)
    return;
  percepts_.side = percepts_.side == "left" ? "right" : "left";
  localisation_.lose();
}

void HumanoidPlayer::getUp() {
  walking_ = false;
  const double lain = percepts_.now - lyingSince_;
  if (lain < kRest || (percepts_.gyro.norm() > kStill && lain < kMaxRest)) return;
  fell_ = lying();
  // After two failures try the movement for another side.
  static constexpr std::array other{Lying::onSide, Lying::onSide, Lying::onSide, Lying::onBack};
  if (percepts_.now - triedAt_ > kForgets) attempts_ = 0;
  triedAt_ = percepts_.now;
  const bool again = ++attempts_ % 3 == 0;
  risesFrom_ = again ? other.at(static_cast<std::size_t>(fell_)) : fell_;
  getUp_.start(movementOf(type_, risesFrom_), pose_);
  rise();
}

/// Starts again if it lies on another side after the first frame. Steps on the spot for a moment when it stands.
void HumanoidPlayer::rise() {
  getUp_.step(percepts_, posture_, pose_);
  const Lying lies = posture_.lying();
  uprightAt_ = footAt_ = percepts_.now;
  if (getUp_.begun() && lies != Lying::no && lies != fell_) return getUp_.stop();
  if (getUp_.playing() || lies != Lying::no) return;
  roseAt_ = percepts_.now;
  localisation_.lose();  // while it lay, its measurements were wrong
  walk_.start(pose_);
  walking_ = true;
}

/// Steps on the spot with velocity 0.
void HumanoidPlayer::walk(const Velocity& velocity) {
  if (!walking_) walk_.start(pose_);
  walking_ = true;
  armsDown(build_, pose_);
  const bool steady = percepts_.now - roseAt_ > kSteady;
  walk_.step(steady ? velocity : Velocity{}, percepts_, posture_, pose_);
}

/// Stops walking, then takes the stance.
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

/// Turns the head to the ball, or sweeps while the position of the ball is unknown.
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
  const long cycle = std::lround(percepts_.now / kCycle);
  if (cycle % kSaySlots != 2 * (unum_ - 1) || !localisation_.known() || percepts_.now - ballAt_ > 1) return;
  const auto cm = [](double m) { return std::clamp(static_cast<int>(std::lround(m * 100)), -9999, 9999); };
  actions.open("say").add(fmt::format("{}:{}:{}:{}", unum_, cm(ball_.x()), cm(ball_.y()), cm(toBall()))).close();
}

}  // namespace humanoid
