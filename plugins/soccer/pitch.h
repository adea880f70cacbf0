#pragma once
/// \file
/// The match as rules and effectors see it: ball, goals, players and settings, looked up again when the shape of the
/// tree changed; and the moves that the referee makes.

#include <vector>

#include "agent_state.h"
#include "api/agents.h"
#include "api/phases.h"
#include "api/physics.h"
#include "safe_reposition.h"
#include "soccer_settings.h"
#include "spark/random.h"

namespace spark::soccer {

/// An axis-aligned box [m]; empty by default.
struct Bounds {
  Vec3 low = Vec3::Constant(HUGE_VAL), high = Vec3::Constant(-HUGE_VAL);
  bool empty() const { return low.x() > high.x(); }
  /// True when the box and the sphere have a point in common.
  bool intersectsSphere(const Vec3& centre, double radius) const {
    return !empty() && (centre - centre.cwiseMax(low).cwiseMin(high)).norm() <= radius;
  }
};

/// An axis-aligned rectangle on the ground [m].
struct Area {
  double minX = 0, minY = 0, maxX = 0, maxY = 0;
  /// True when the point is inside the rectangle extended by `pad` [m] on each side. Its border is outside.
  bool contains(double x, double y, double pad = 0) const {
    return x > minX - pad && x < maxX + pad && y > minY - pad && y < maxY + pad;
  }
  /// True when the box, seen from above, overlaps the rectangle.
  bool intersects(const Bounds& b) const {
    return !b.empty() && b.high.x() > minX && b.low.x() < maxX && b.high.y() > minY && b.low.y() < maxY;
  }
};

/// An agent whose robot has an AgentState. All pointers are valid until the shape of the tree changes.
struct Player {
  AgentAspect* agent = nullptr;  ///< the outermost aspect
  AgentState* state = nullptr;   ///< never nullptr in Pitch::players()
  std::uint64_t changedAt = 0;   ///< the agent's changedAt() when its parts were looked up
  IRigidBody* torso = nullptr;   ///< first body of the innermost aspect; nullptr: the robot has no bodies
  std::vector<IRigidBody*> bodies;
  std::vector<ICollider*> colliders;

  /// Side of its team; none before init.
  Side side() const { return state->side(); }
  /// Current position of the torso [m].
  Vec3 position() const { return torso ? torso->state().position : Vec3(Vec3::Zero()); }
  /// Current bounds of all colliders.
  Bounds bounds() const;
  /// Moves all bodies rigidly so that the torso is at `target` [m]. Keeps orientations, zeroes velocities.
  void moveTo(const Vec3& target) const;
  /// Moves and rotates all bodies rigidly so that the torso is upright at `target` [m] with this yaw [rad]. Zeroes
  /// velocities.
  void moveTo(const Vec3& target, double yaw) const;
  /// Rotates all bodies rigidly about the torso so that it gets this orientation. Zeroes velocities.
  void rotateTo(const Mat3& orientation) const;

 private:
  /// Moves and rotates all bodies rigidly so that the torso gets this pose.
  void setPose(const Vec3& target, const Mat3& orientation) const;
};

/// The match. Owned by game state. Every function that runs in the simulation's thread gets it by
/// GameStateAspect::pitch(), which calls refresh().
class Pitch {
 public:
  /// Looks everything up again if the shape of the tree changed. What is missing becomes nullptr. Does not throw.
  void refresh(Kernel& kernel);

  /// False when there are no settings: none of the functions below may be called then.
  bool ready() const { return settings_ != nullptr; }
  const SoccerSettings& settings() const { return *settings_; }
  /// All agents with an AgentState, sorted by the agents' numbers.
  const std::vector<Player>& players() const { return players_; }
  /// The player with this side and uniform number; nullptr if there is none.
  const Player* player(Side side, int unum) const;
  /// The player of the agent with this number; nullptr if there is none.
  const Player* playerOfAgent(int agentNumber) const;
  /// The player that a collider (or any other node below an agent) belongs to; nullptr if there is none.
  const Player* playerOf(const Leaf* leaf) const;
  /// Number of players of a side.
  int count(Side side) const;

  /// The ball's body; nullptr if the scene has none.
  IRigidBody* ball() const { return ball_; }
  /// The recorder of the ball's collider; nullptr if there is none.
  ICollisionRecorder* ballRecorder() const { return ballRecorder_; }
  /// The recorder of the trigger box in the goal that `side` defends; nullptr if there is none.
  ICollisionRecorder* goalRecorder(Side side) const { return side == Side::left ? leftGoal_ : rightGoal_; }
  ISceneServer* scene() const { return scene_; }
  IGameControl* gameControl() const { return gameControl_; }

  /// Current position of the ball [m]; the origin if there is no ball.
  Vec3 ballPosition() const { return ball_ ? ball_->state().position : Vec3(Vec3::Zero()); }
  /// Moves the ball to `position` [m] and zeroes its velocities.
  void placeBall(const Vec3& position) const;
  /// Position of the ball at the centre mark [m].
  Vec3 centre() const { return {0, 0, settings_->ballRadius}; }
  /// The penalty area that `side` defends.
  Area penaltyArea(Side side) const;
  /// The half of the ground that the opponents of `side` defend, without limits beyond the field.
  Area opponentHalf(Side side) const;
  /// Position of a dropped ball or free kick: a point inside a penalty area is moved to the area's front corner, and y
  /// is clamped to the field [m]. Keeps z.
  Vec3 freeBallPosition(const Vec3& wanted) const;

  /// Simulated time [s].
  double now() const { return simulation_ ? simulation_->time() : 0; }

  // Moves of the referee. They keep orientations, zero velocities and record the time for movedWithin(), which is used
  // by rules that exempt players that have just been moved. Bodies move at once; transforms follow in the next place
  // phase.

  /// Moves the player to `target` [m] or the first safe position near it. `avoidBall`: not close to the ball.
  void moveSafely(const Player& player, const Vec3& target, bool avoidBall) const;
  /// Moves the player to `target` [m], even if that position is occupied.
  void relocate(const Player& player, const Vec3& target) const;
  /// Moves the player to its position beside the field, on the side away from the ball, at height `z` [m].
  void moveOffField(const Player& player, double z) const;
  /// True when the referee moved the player less than `seconds` ago.
  bool movedWithin(const Player& player, double seconds) const { return now() - player.state->movedAt() < seconds; }

  // Clearing. `random` shuffles the order of the players, as in the installed base. All lengths in m.

  /// Calls each(side) for both sides, in random order.
  template <class F>
  void bothSides(RandomStream& random, F each) const {
    const Side first = random.below(2) == 0 ? Side::left : Side::right;
    each(first);
    each(opponent(first));
  }
  /// Moves all players of `side` that intersect the sphere to x = centre -/+ `distance`, towards their own end; if that
  /// is behind their goal line, to y = centre +/- `distance`, towards the middle.
  void clearSphere(Side side, const Vec3& centre, double radius, double distance, RandomStream& random) const;
  /// Like clearSphere, for one player.
  void clearSphere(const Player& player, const Vec3& centre, double radius, double distance) const;
  /// Moves all players of `side` out of the rectangle, to `distance` beyond its edge towards their own end.
  void clearArea(Side side, const Area& area, double distance, RandomStream& random) const;
  /// Moves all players of `side` out of the opponents' half, to `distance` from the centre line. Players entirely
  /// within `circle` of the centre stay; 0: all are moved.
  void clearOpponentHalf(Side side, double circle, double distance, RandomStream& random) const;
  /// Moves both teams to where they may be at a kick-off of `side`.
  void clearForKickOff(Side side, RandomStream& random) const;
  /// Moves all players of `side` that are closer than `within` to `centre` radially away, to `distance` from it.
  void repel(Side side, const Vec3& centre, double within, double distance, RandomStream& random) const;

 private:
  template <class F>
  void forEachShuffled(Side side, RandomStream& random, F each) const;
  void findPlayers();
  /// Index of the agent's player; players_.size() if there is none.
  std::size_t indexOf(const Leaf* agent) const;

  TreeWatch tree_;
  SoccerSettings* settings_ = nullptr;
  ISceneServer* scene_ = nullptr;
  IGameControl* gameControl_ = nullptr;
  ISimulation* simulation_ = nullptr;
  IRigidBody* ball_ = nullptr;
  ICollisionRecorder *ballRecorder_ = nullptr, *leftGoal_ = nullptr, *rightGoal_ = nullptr;
  std::vector<Player> players_;
  /// Indices of players, sorted by the address of the agent. Only for lookups: the order differs between runs.
  std::vector<std::pair<const Leaf*, std::size_t>> byAgent_;
  mutable std::vector<const Player*> order_;  ///< of forEachShuffled()
  mutable SafeReposition safeReposition_;
};

}  // namespace spark::soccer
