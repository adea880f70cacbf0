#pragma once
/// \file
/// Decisions of a player. They have no memory: the same situation gives the same decision.

#include <string>
#include <vector>

#include "localisation.h"

namespace humanoid {

/// The input of a decision. Positions are in the team's frame (opponents' goal at +x) [m].
struct Situation {
  std::string playMode, side;  ///< side: "left", "right"
  int unum = 1;
  Lying lying = Lying::no;
  double tilt = 0;  ///< of the torso [rad]
  bool located = false, ballKnown = false,
       nearest = false;    ///< nearest: no team-mate reports a shorter path to the ball
  bool barred = false;     ///< it took the restart: another player must touch the ball before it may again
  bool contested = false;  ///< an opponent is at the ball
  Vec2 place = Vec2::Zero(), ball = Vec2::Zero();
  double heading = 0;  ///< rad
};

/// walk: to a position and stop there; run: through a position; push: the ball is straight ahead, hit it with a foot.
enum class Task { takePlace, fall, getUp, search, stand, walk, run, push };

/// What to do in this cycle.
struct Decision {
  Task task = Task::stand;
  Vec2 target = Vec2::Zero();  ///< walk, run, push: where to go [m]; takePlace: where to beam [m]
  double facing = 0;           ///< walk, push: heading at the target [rad]
};

/// Decides what to do.
Decision decide(const Situation& s);
/// Position of player 1..11 at kick-offs [m].
Vec2 kickOffPlace(int unum);
/// Length of the path to the ball [m]. Going around the ball, to push it towards the goal, adds up to 2 m.
double wayToBall(const Vec2& place, const Vec2& ball);
/// Position of player 1..11 while others are nearer to the ball [m].
Vec2 waitingPlace(int unum, const Vec2& ball);
/// True for play modes in which players may beam and the ball is not in play.
bool pausedMode(std::string_view playMode);
/// True when only the other team may touch the ball. `side`: of the own team.
bool theirBall(std::string_view playMode, std::string_view side);
/// A velocity [m/s, m/s, rad/s], not limited: Walk clamps it.
struct Steering {
  double forward, right, turn;
};
/// How to walk to a point: sideways or after turning towards it, whichever is faster. `target`: relative to the robot,
/// x to its right, y forward [m]; `facing`: rotation to make at the target [rad].
Steering steer(const Vec2& target, double facing);
/// Like steer(), without stopping at the target.
Steering run(const Vec2& target);
/// How to push the ball with a foot. `target`: point that the centre of the robot must pass so that a foot hits the
/// ball; `facing`: as above. The forward speed is limited so that the lateral error vanishes in time.
Steering push(const Vec2& target, double facing);
/// The target, or a point beside another robot that blocks the path. All relative to the robot, x to its right, y
/// forward [m].
Vec2 pass(const Vec2& target, const std::vector<Vec2>& others);

}  // namespace humanoid
