#pragma once
/// \file
/// What a player decides to do, from what he knows. No memory but what is handed in: the same situation gives the same
/// decision.

#include <string>
#include <vector>

#include "localisation.h"

namespace humanoid {

/// What matters for a decision. Places on the field as the team sees it (opponents' goal at +x) [m].
struct Situation {
  std::string playMode, side;  ///< side: "left", "right"
  int unum = 1;
  Lying lying = Lying::no;
  double tilt = 0;  ///< rad, of the torso
  bool located = false, ballKnown = false,
       nearest = false;    ///< nearest: no team-mate says that his way to the ball is shorter
  bool barred = false;     ///< he took the restart: another one must touch the ball before he does
  bool contested = false;  ///< an opponent is at the ball
  Vec2 place = Vec2::Zero(), ball = Vec2::Zero();
  double heading = 0;  ///< rad
};

/// walk: to a place, to stop there; run: through it; push: the ball is right ahead, it is to meet a foot.
enum class Task { takePlace, fall, getUp, search, stand, walk, run, push };

/// What to do next.
struct Decision {
  Task task = Task::stand;
  Vec2 target = Vec2::Zero();  ///< walk, run, push: where to, on the field; takePlace: where to be beamed
  double facing = 0;           ///< walk, push: heading at the target [rad]
};

Decision decide(const Situation& s);
/// Where number 1..11 stands at kick-off.
Vec2 kickOffPlace(int unum);
/// Length of the way to the ball [m]. Going round it, to push it towards the goal, counts as up to 2 m more.
double wayToBall(const Vec2& place, const Vec2& ball);
/// Where number 1..11 waits when others are nearer to the ball.
Vec2 waitingPlace(int unum, const Vec2& ball);
/// True for modes in which players may be beamed and nobody plays.
bool pausedMode(std::string_view playMode);
/// True when only the other team may touch the ball. `side`: of the own team.
bool theirBall(std::string_view playMode, std::string_view side);
/// How to walk to a point: straight, or turned towards it, which is sooner. `target`: from the robot, x to its right, y
/// forward [m]; `facing`: turn to make at the target [rad]. Unlimited: the gait cuts it.
struct Steering {
  double forward, right, turn;
};
Steering steer(const Vec2& target, double facing);
/// The same without stopping there.
Steering run(const Vec2& target);
/// How to push the ball with a foot. `target`: where the middle of the robot is to pass, so that a foot meets the ball;
/// `facing`: as above. It walks on no faster than it gets rid of its sideways error.
Steering push(const Vec2& target, double facing);
/// Where to go instead when others are in the way. All from the robot, x to its right, y forward [m].
Vec2 pass(const Vec2& target, const std::vector<Vec2>& others);

}  // namespace humanoid
