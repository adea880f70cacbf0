#include "tactics.h"

#include <algorithm>
#include <cmath>

#include "kick.h"

// What a player does, first line that fits:
//
//     lies, or tips over                  -> get up, or let it happen
//     before a kick-off, after a goal     -> be beamed to the place in the formation
//     does not know where he or the ball is -> turn and look
//     the others' ball                    -> keep away from it
//     nearest to the ball                 -> behind it as seen from the goal, then kick, or walk into it
//     everybody else                      -> a place that moves with the ball

namespace humanoid {

namespace {
constexpr double kTipping = radians(50);  // of tilt: no step saves him
constexpr double kKeepAway = 2.4;         // m from the ball at the others' restarts
constexpr double kBehind = 0.25;          // m behind the ball from where to approach it
constexpr double kAround = 0.45;          // m beside the ball when he has to get round it
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

double angleOf(const Vec2& v) { return std::atan2(v.y(), v.x()); }

Decision walkTo(const Vec2& target, double facing) { return {Task::walk, target, facing, true}; }

Decision keepAway(const Situation& s) {
  const Vec2 back = kOwnGoal - s.ball;
  const Vec2 from = (s.place - s.ball).norm() > 0.1 ? Vec2(s.place - s.ball) : back;
  if (from.norm() > kKeepAway) return {Task::stand, s.place, s.heading, true};
  return walkTo(s.ball + back.normalized() * kKeepAway, angleOf(-back));
}

/// The kick's direction: at the goal; from beside it at least forward.
Vec2 aim(const Vec2& ball) {
  const Vec2 way = kTheirGoal - ball;
  return way.norm() > 0.5 ? Vec2(way.normalized()) : Vec2(1, 0);
}

Decision attack(const Situation& s) {
  const Vec2 way = aim(s.ball), from = s.place - s.ball, across(-way.y(), way.x());
  const double behind = -from.dot(way), beside = from.dot(across), facing = angleOf(way);
  if (behind < 0.05 && from.norm() < 1.2)  // before the ball: round it
    return walkTo(s.ball + across * (beside < 0 ? -kAround : kAround) - way * 0.1, facing);
  const bool aligned = std::abs(normalized(s.heading - facing)) < radians(20);
  if (from.norm() > 0.45 || !aligned) return walkTo(s.ball - way * kBehind, facing);
  const bool rightFoot = beside > 0;  // the ball is to the right of a player who is to its left
  const double off = std::abs(beside) - Kick::kBallSide;
  if (std::abs(off) < 0.035 && behind < Kick::kBallForward + 0.03) return {Task::kick, s.ball, facing, rightFoot};
  return walkTo(s.ball - way * (Kick::kBallForward - 0.02) + across * (rightFoot ? Kick::kBallSide : -Kick::kBallSide), facing);
}

Decision wait(const Situation& s) {
  const Vec2 target = waitingPlace(s.unum, s.ball);
  const double facing = angleOf(s.ball - s.place);
  if ((target - s.place).norm() > 0.6) return walkTo(target, facing);
  if (std::abs(normalized(s.heading - facing)) > radians(40)) return walkTo(s.place, facing);
  return {Task::stand, s.place, s.heading, true};
}
}  // namespace

Decision decide(const Situation& s) {
  if (s.lying != Lying::no) return {Task::getUp, s.place, s.heading, true};
  if (s.tilt > kTipping) return {Task::fall, s.place, s.heading, true};
  if (pausedMode(s.playMode)) return {Task::takePlace, kickOffPlace(s.unum), 0, true};
  if (s.playMode == "GameOver") return {Task::stand, s.place, s.heading, true};
  if (!s.located || !s.ballKnown) return {Task::search, s.place, s.heading, true};
  if (theirBall(s.playMode, s.side)) return (s.ball - s.place).norm() < kKeepAway + 0.5 ? keepAway(s) : wait(s);
  return s.nearest && (s.unum != 1 || s.ball.x() < -12) ? attack(s) : wait(s);
}

Vec2 kickOffPlace(int unum) {
  const auto& p = kFormation.at(static_cast<std::size_t>(std::clamp(unum, 1, 11)));
  return {p[0], p[1]};
}

Vec2 waitingPlace(int unum, const Vec2& ball) {
  if (unum == 1) return {-14.3, std::clamp(ball.y(), -0.8, 0.8)};
  const Vec2 home = kickOffPlace(unum);
  Vec2 place(std::clamp(home.x() + 0.6 * ball.x() + (home.x() > -3 ? 1.0 : 0.0), -13.0, 12.0), home.y() + 0.3 * ball.y());
  const Vec2 off = place - ball;
  if (off.norm() < 1.5) place = ball + (off.norm() > 0.1 ? Vec2(off.normalized()) : Vec2(-1, 0)) * 1.5;
  return place;
}

bool pausedMode(std::string_view playMode) { return playMode == "BeforeKickOff" || playMode == "Goal_Left" || playMode == "Goal_Right"; }

bool theirBall(std::string_view playMode, std::string_view side) {
  if (playMode == "PlayOn" || playMode == "GameOver" || pausedMode(playMode)) return false;
  const bool left = playMode.ends_with("left") || playMode.ends_with("Left");
  return left != (side == "left");
}

Steering steer(const Vec2& target, double facing) {
  const double distance = target.norm(), bearing = std::atan2(-target.x(), target.y());  // to the left
  if (distance < 0.5) return {1.2 * target.y(), 1.2 * target.x(), 1.2 * facing};
  if (std::abs(bearing) > radians(150) && distance < 0.8) return {-distance, 0, 0};
  return {std::abs(bearing) > radians(60) ? 0 : std::cos(bearing) * std::min(distance, 1.0), 0, 1.5 * bearing};
}

}  // namespace humanoid
