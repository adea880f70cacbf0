#pragma once

#include <vector>

#include "api/math.h"

namespace spark::soccer {

class Pitch;
struct Player;
struct Bounds;

/// The safe-reposition search of the installed base: finds a position to which the referee can move a player without
/// harm to others.
///
/// A position is rejected if it would bring one player too many into the own penalty area, lies behind a goal, is too
/// near to the ball, or overlaps another player. The search then tries positions one AgentRadius further towards the
/// player's own end and one further from the middle of the field, the one nearest to the player first. Each rejected
/// position adds its two neighbours:
///
///     target  x  x  o        x: rejected, o: candidate
///        x    x  o
///        o    o               grid of AgentRadius
class SafeReposition {
 public:
  /// Returns `target` [m], or the first safe position near it; `target` when MaxNumSafeRepositionAttempts positions
  /// were rejected. Keeps z. `avoidBall`: positions near the ball are not safe.
  Vec3 find(const Pitch& pitch, const Player& player, const Vec3& target, bool avoidBall);

 private:
  struct Candidate {
    int i = 0, j = 0;     ///< grid steps in x and y
    double distance = 0;  ///< from the player's current position [m]
  };
  bool isSafe(const Pitch& pitch, const Player& player, double x, double y, bool avoidBall) const;
  /// Adds a grid position to the candidates, unless it was one before.
  void addCandidate(int i, int j);
  /// Removes and returns the nearest candidate; among equals the one that was added first.
  Candidate takeNearest();

  // State of one search; members only to keep their capacity.
  std::vector<Bounds> obstacles_;          ///< of the other players
  std::vector<Candidate> candidates_;      ///< not tried yet
  std::vector<std::pair<int, int>> seen_;  ///< all candidates so far
  Vec3 origin_ = Vec3::Zero(), target_ = Vec3::Zero();
  double stepX_ = 0, stepY_ = 0;  ///< grid spacing with sign [m]
};

}  // namespace spark::soccer
