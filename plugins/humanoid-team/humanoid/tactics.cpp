#include "tactics.h"

#include <algorithm>
#include <cmath>

// The decision of a player; the first line that applies counts:
//
//     lies, or falls                      -> get up, or wait until it lies
//     before a kick-off, after a goal     -> beam to its position in the formation
//     own or ball position unknown        -> turn and search
//     opponents' restart                  -> keep away from the ball
//     has taken a restart                 -> keep away until another player has touched the ball
//     shortest path to the ball           -> go behind it, as seen from the goal, then push it
//     otherwise                           -> a position that moves with the ball

namespace humanoid {

namespace {
constexpr double kTipping = radians(50);      // tilt beyond which no step prevents the fall
constexpr double kKeepAway = 2.4;             // distance to the ball at opponents' restarts [m]
constexpr double kBehind = 0.35;              // distance behind the ball at which it turns towards it [m]
constexpr double kAround = 0.5;               // distance to the ball on the way around it [m]
constexpr double kFurther = radians(55);      // angle around the ball to the next waypoint
constexpr double kAtHand = 0.8;               // within this distance it goes behind the ball, or pushes it [m]
constexpr double kFar = 2;                    // beyond this distance it does not go around the ball yet [m]
constexpr double kTurned = radians(40);       // largest heading error for a push
constexpr double kFoot = 0.05;                // lateral offset of the foot that hits the ball [m]
constexpr double kToes = 0.1;                 // forward offset of that foot [m]
constexpr double kExact = 0.03;               // tolerated lateral error [m]
constexpr double kAhead = 0.5;                // distance of the point ahead that it walks to [m]
constexpr double kMouth = 0.3, kShot = 3;     // lateral range of the aim at the goal, up to that distance [m]
constexpr double kWiden = 0.25;               // additional lateral range per distance
constexpr double kAsideInDuel = radians(60);  // additional angle when an opponent is at the ball
constexpr double kStraight = 4;               // within this distance of the goal it aims at it even in a duel [m]
constexpr double kRound = 2;                  // additional path length for half a turn around the ball [m]
constexpr double kClear = 0.65;               // distance between two robots that pass each other [m]
constexpr double kLookOut = 1.4;              // distance ahead within which other robots are avoided [m]
constexpr double kForward = 0.7, kBackward = 0.35, kSideways = 0.18;  // typical walking speeds [m/s]
constexpr double kTurn = 1;                                           // typical turning speed [rad/s]
constexpr double kMaxBackward = 0.5, kMaxSideways = 0.25;             // largest wanted speeds [m/s]
const Vec2 kTheirGoal(15, 0), kOwnGoal(-15, 0);

constexpr std::array<std::array<double, 2>, 12> kFormation{{{0, 0},
                                                            {-14.4, 0},
                                                            {-10, 4.5},
                                                            {-11, 1.6},
                                                            {-11, -1.6},
                                                            {-10, -4.5},
                                                            {-6, 5},
                                                            {-6.5, 0},
                                                            {-6, -5},
                                                            {-2.4, 2.5},
                                                            {-2.3, 0},
                                                            {-2.4, -2.5}}};

/// Positions of waiting field players relative to the ball [m]. Two are behind it, to take over when the first one
/// loses the ball.
constexpr std::array<std::array<double, 2>, 12> kFromBall{{{0, 0},
                                                           {0, 0},
                                                           {-4, 4.5},
                                                           {-5, 1},
                                                           {-2, -1.2},
                                                           {-4, -4.5},
                                                           {-1, 5},
                                                           {-1.6, 1},
                                                           {-1, -5},
                                                           {0.8, 2.2},
                                                           {3.5, 0},
                                                           {0.8, -2.2}}};

double angleOf(const Vec2& v) { return std::atan2(v.y(), v.x()); }

Decision walkTo(const Vec2& target, double facing) { return {Task::walk, target, facing}; }

Decision keepAway(const Situation& s) {
  const Vec2 back = kOwnGoal - s.ball;
  const Vec2 from = (s.place - s.ball).norm() > 0.1 ? Vec2(s.place - s.ball) : back;
  if (from.norm() > kKeepAway) return {Task::stand, s.place, s.heading};
  return walkTo(s.ball + back.normalized() * kKeepAway, angleOf(-back));
}

/// Direction in which to push the ball: between the posts; from far away as far to the side as the player approaches
/// from, and more so in a duel.
Vec2 aim(const Situation& s) {
  const Vec2 from = s.ball - s.place;
  const double distance = (kTheirGoal - s.ball).norm(), width = kMouth + kWiden * std::max(0.0, distance - kShot);
  if (distance < 0.3) return {1, 0};
  const double more = s.contested && distance > kStraight ? kAsideInDuel : 0, goal = angleOf(kTheirGoal - s.ball);
  const double right = normalized(angleOf(kTheirGoal - Vec2(0, width) - s.ball) - goal) - more;
  const double left = normalized(angleOf(kTheirGoal + Vec2(0, width) - s.ball) - goal) + more;
  const double off = from.norm() < 0.05 ? 0 : std::clamp(normalized(angleOf(from) - goal), right, left);
  return {std::cos(goal + off), std::sin(goal + off)};
}

/// Goes around the ball to its far side from the goal, then walks through it: a foot pushes it with every step.
Decision attack(const Situation& s) {
  const Vec2 way = aim(s), from = s.place - s.ball, across(-way.y(), way.x());
  const double behind = -from.dot(way), beside = from.dot(across), side = beside < 0 ? -1 : 1, facing = angleOf(way);
  const bool near = from.norm() < kAtHand, turned = std::abs(normalized(s.heading - facing)) < kTurned;
  const Vec2 meet = s.ball + across * (side * kFoot);
  if (near && turned && behind > 0.04 && std::abs(beside) < 0.1 + 0.35 * behind) return {Task::push, meet, facing};
  if (!near && behind > 0 && std::abs(beside) < 0.09 + 0.4 * behind)
    return {Task::run, meet + way * (kAhead - behind), facing};
  const Vec2 back = s.ball - way * kBehind;
  const double at = angleOf(from), left = normalized(angleOf(-way) - at);
  if (std::abs(left) < kFurther) return near ? walkTo(back, facing) : Decision{Task::run, back, facing};
  if (from.norm() > kFar) return {Task::run, back, facing};
  const double next = at + std::clamp(left, -kFurther, kFurther);
  return walkTo(s.ball + Vec2(std::cos(next), std::sin(next)) * kAround, facing);
}

Decision wait(const Situation& s) {
  const Vec2 target = waitingPlace(s.unum, s.ball);
  const double facing = angleOf(s.ball - s.place);
  if ((target - s.place).norm() > 0.6) return walkTo(target, facing);
  if (std::abs(normalized(s.heading - facing)) > radians(40)) return walkTo(s.place, facing);
  return {Task::stand, s.place, s.heading};
}
}  // namespace

Decision decide(const Situation& s) {
  if (s.lying != Lying::no) return {Task::getUp, s.place, s.heading};
  if (s.tilt > kTipping) return {Task::fall, s.place, s.heading};
  if (pausedMode(s.playMode)) return {Task::takePlace, kickOffPlace(s.unum), 0};
  if (s.playMode == "GameOver") return {Task::stand, s.place, s.heading};
  if (!s.located || !s.ballKnown) return {Task::search, s.place, s.heading};
  if (theirBall(s.playMode, s.side)) return (s.ball - s.place).norm() < kKeepAway + 0.5 ? keepAway(s) : wait(s);
  if (s.barred) return keepAway(s);
  return s.nearest && (s.unum != 1 || s.ball.x() < -12) ? attack(s) : wait(s);
}

Vec2 kickOffPlace(int unum) {
  const auto& p = kFormation.at(static_cast<std::size_t>(std::clamp(unum, 1, 11)));
  return {p[0], p[1]};
}

double wayToBall(const Vec2& place, const Vec2& ball) {
  return (ball - place).norm() + kRound * 0.5 * (1 - std::cos(angleOf(ball - place) - angleOf(kTheirGoal - ball)));
}

Vec2 waitingPlace(int unum, const Vec2& ball) {
  if (unum == 1) return {-14.3, std::clamp(ball.y(), -0.8, 0.8)};
  const auto& from = kFromBall.at(static_cast<std::size_t>(std::clamp(unum, 1, 11)));
  Vec2 place(std::clamp(0.85 * ball.x() + from[0], -13.0, 13.0), std::clamp(0.5 * ball.y() + from[1], -9.0, 9.0));
  const Vec2 off = place - ball;
  if (off.norm() < 1.5) place = ball + (off.norm() > 0.1 ? Vec2(off.normalized()) : Vec2(-1, 0)) * 1.5;
  return place;
}

bool pausedMode(std::string_view playMode) {
  return playMode == "BeforeKickOff" || playMode == "Goal_Left" || playMode == "Goal_Right";
}

bool theirBall(std::string_view playMode, std::string_view side) {
  if (playMode == "PlayOn" || playMode == "GameOver" || pausedMode(playMode)) return false;
  const bool left = playMode.ends_with("left") || playMode.ends_with("Left");
  return left != (side == "left");
}

Vec2 pass(const Vec2& target, const std::vector<Vec2>& others) {
  const double distance = target.norm();
  if (distance < 0.1) return target;
  const Vec2 way = target / distance, left(-way.y(), way.x());
  double nearest = std::min(kLookOut, distance + 0.3);
  Vec2 round = target;
  for (const Vec2& other : others) {
    const double along = other.dot(way), beside = other.dot(left);
    if (along < 0 || along > nearest || std::abs(beside) > kClear) continue;
    nearest = along;
    round = way * std::max(along, 0.2) + left * (beside > 0 ? beside - kClear : beside + kClear);
  }
  return round;
}

Steering steer(const Vec2& target, double facing) {
  const double distance = target.norm(), bearing = std::atan2(-target.x(), target.y());  // to the left
  const double along = target.y() > 0 ? target.y() / kForward : -target.y() / kBackward;
  const double straight = std::max({along, std::abs(target.x()) / kSideways, std::abs(facing) / kTurn});
  const double turned = (std::abs(bearing) + std::abs(normalized(facing - bearing))) / kTurn + distance / kForward;
  if (straight > turned)
    return {std::abs(bearing) > radians(60) ? 0 : std::cos(bearing) * std::min(distance, 1.0), 0, 2 * bearing};
  const Vec2 speed = 1.8 * target;
  const double slower = std::max({1.0, std::abs(speed.x()) / kMaxSideways, speed.y(), -speed.y() / kMaxBackward});
  return {speed.y() / slower, speed.x() / slower, 1.8 * facing};
}

Steering run(const Vec2& target) {
  const double bearing = std::atan2(-target.x(), target.y());
  return {std::abs(bearing) > radians(70) ? 0 : std::cos(bearing), 0, 2.2 * bearing};
}

Steering push(const Vec2& target, double facing) {
  const double aside = std::abs(target.x()) - kExact, ahead = std::max(0.0, target.y() - kToes);
  return {aside > 0 ? std::min(1.0, ahead * kSideways / aside) : 1, 3 * target.x(), 2.2 * facing};
}

}  // namespace humanoid
