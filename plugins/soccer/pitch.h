#pragma once
/// \file
/// What rules and effectors see of the match: ball, goals, players and the settings, looked up once per shape of the
/// tree.

#include <vector>

#include "agent_state.h"
#include "api/agents.h"
#include "api/phases.h"
#include "api/physics.h"
#include "safe_place.h"
#include "soccer_settings.h"
#include "spark/random.h"

namespace spark::soccer {

/// An axis-aligned box.
struct Bounds {
  Vec3 low = Vec3::Constant(HUGE_VAL), high = Vec3::Constant(-HUGE_VAL);
  bool empty() const { return low.x() > high.x(); }
  bool touchesSphere(const Vec3& centre, double radius) const {
    return !empty() && (centre - centre.cwiseMax(low).cwiseMin(high)).norm() <= radius;
  }
};

/// A rectangle on the ground.
struct Area {
  double minX = 0, minY = 0, maxX = 0, maxY = 0;
  bool contains(double x, double y, double pad = 0) const {
    return x > minX - pad && x < maxX + pad && y > minY - pad && y < maxY + pad;
  }
  /// As Bounds of any height.
  bool touches(const Bounds& b) const {
    return !b.empty() && b.high.x() > minX && b.low.x() < maxX && b.high.y() > minY && b.low.y() < maxY;
  }
};

/// An agent with a robot that is a player.
struct Player {
  AgentAspect* agent = nullptr;  ///< the outermost aspect
  AgentState* state = nullptr;
  std::uint64_t changedAt = 0;  ///< the agent's, when its parts were looked up
  IRigidBody* torso = nullptr;  ///< first body of the innermost aspect; nullptr: a robot without bodies
  std::vector<IRigidBody*> bodies;
  std::vector<ICollider*> colliders;

  Side side() const { return state->side(); }
  /// Of the torso, now [m].
  Vec3 position() const { return torso ? torso->state().position : Vec3(Vec3::Zero()); }
  /// Of all colliders, now.
  Bounds bounds() const;
  /// Moves all bodies so that the torso stands at `target`; orientations stay, velocities are taken away.
  void moveTo(const Vec3& target) const;
  /// As moveTo, and the torso is put upright with this yaw [rad] (protocol section 2.3).
  void moveTo(const Vec3& target, double yaw) const;
  /// Turns all bodies about the torso, which gets this orientation; velocities are taken away.
  void turnTo(const Mat3& orientation) const;

 private:
  /// Moves and turns all bodies as one, so that the torso gets this pose.
  void place(const Vec3& target, const Mat3& orientation) const;
};

/// Owned by game state, valid for its kernel. refresh() at the start of whatever runs in the simulation's thread.
class Pitch {
 public:
  /// Looks everything up again if the shape of the tree changed. Throws nothing: what is missing is nullptr.
  void refresh(Kernel& kernel);

  /// False when there are no settings: nothing below may be called then.
  bool ready() const { return settings_ != nullptr; }
  const SoccerSettings& settings() const { return *settings_; }
  /// In the order of agents' numbers; only those with an AgentState.
  const std::vector<Player>& players() const { return players_; }
  const Player* player(Side side, int unum) const;
  const Player* playerOfAgent(int agentNumber) const;
  /// The player to whom a collider (or anything else below an agent) belongs, nullptr when there is none.
  const Player* playerOf(const Leaf* leaf) const;
  int count(Side side) const;

  IRigidBody* ball() const { return ball_; }
  ICollisionRecorder* ballRecorder() const { return ballRecorder_; }
  /// Of the goal that `side` defends.
  ICollisionRecorder* goalRecorder(Side side) const { return side == Side::left ? leftGoal_ : rightGoal_; }
  ISceneServer* scene() const { return scene_; }
  IGameControl* gameControl() const { return gameControl_; }

  Vec3 ballPosition() const { return ball_ ? ball_->state().position : Vec3(Vec3::Zero()); }
  /// Puts the ball somewhere at rest.
  void placeBall(const Vec3& position) const;
  Vec3 centre() const { return {0, 0, settings_->ballRadius}; }
  /// The penalty area that `side` defends.
  Area penaltyArea(Side side) const;
  /// Everything on the other side of the centre line, seen from `side`.
  Area opponentHalf(Side side) const;
  /// Outside of both penalty areas: an inner point comes to the area's front corner on its side; y stays on the field,
  /// z as it is.
  Vec3 freeBallPosition(const Vec3& wanted) const;

  /// s: the simulated clock now.
  double now() const { return simulation_ ? simulation_->time() : 0; }

  // What the referee does to players (protocol section 6.6). Orientations stay, velocities are taken away, and the time
  // is noted: rules that spare who was just moved ask movedWithin(player, 1.0). Bodies are moved at once, transforms
  // follow at the next place phase.
  /// Moves to `target` or the first safe place near it. `avoidBall`: not beside the ball either.
  void moveSafely(const Player& player, const Vec3& target, bool avoidBall) const;
  /// Moves to `target` whoever stands there, as for a player who is held in the air.
  void hold(const Player& player, const Vec3& target) const;
  /// Beside the field on the side away from the ball, as after a foul; z [m].
  void putOutside(const Player& player, double z) const;
  /// The referee moved the player less than so many seconds ago.
  bool movedWithin(const Player& player, double seconds) const { return now() - player.state->movedAt() < seconds; }

  // Clearing. Players are taken in an order that `random` shuffles.
  /// Calls each(side) for both sides, in an order that a coin decides.
  template <class F>
  void bothSides(RandomStream& random, F each) const {
    const Side first = random.below(2) == 0 ? Side::left : Side::right;
    each(first);
    each(opponent(first));
  }
  /// Moves away who touches the sphere: `distance` towards his own end, or in y where that would be behind his goal
  /// line.
  void clearSphere(Side side, const Vec3& centre, double radius, double distance, RandomStream& random) const;
  /// As clearSphere for one player.
  void clearSphere(const Player& player, const Vec3& centre, double radius, double distance) const;
  /// Moves out of a rectangle, `distance` beyond its edge on the team's own side.
  void clearArea(Side side, const Area& area, double distance, RandomStream& random) const;
  /// Out of the opponents' half, to `distance` on the own side, unless all of him is within `circle` of the centre (0:
  /// no circle).
  void clearOpponentHalf(Side side, double circle, double distance, RandomStream& random) const;
  /// To where they may stand at a kick-off of `side`.
  void clearForKickOff(Side side, RandomStream& random) const;
  /// Pushes who is nearer than `within` radially to `distance` from the centre.
  void repel(Side side, const Vec3& centre, double within, double distance, RandomStream& random) const;

 private:
  template <class F>
  void shuffled(Side side, RandomStream& random, F each) const;
  void findPlayers();
  /// Index of the player of an agent, players_.size() when there is none.
  std::size_t indexOf(const Leaf* agent) const;

  TreeWatch tree_;
  SoccerSettings* settings_ = nullptr;
  ISceneServer* scene_ = nullptr;
  IGameControl* gameControl_ = nullptr;
  ISimulation* simulation_ = nullptr;
  IRigidBody* ball_ = nullptr;
  ICollisionRecorder *ballRecorder_ = nullptr, *leftGoal_ = nullptr, *rightGoal_ = nullptr;
  std::vector<Player> players_;
  std::vector<std::pair<const Leaf*, std::size_t>>
      byAgent_;  ///< players by the address of their agent, to look up only
  mutable std::vector<const Player*> order_;
  mutable SafePlace safePlace_;
};

}  // namespace spark::soccer
