#pragma once

#include <vector>

#include "api/math.h"

namespace spark::soccer {

class Pitch;
struct Player;
struct Bounds;

/// The safe-reposition search of protocol section 6.6: where a player may be put without harm to others.
///
/// A place is refused that would bring one player too many into the own penalty area, that lies behind a goal, that is
/// too near to the ball, or where somebody stands. Then places one agent's radius further towards the own end and
/// further from the middle are tried, the nearest to the player first; each refused one leads to its two neighbours:
///
///     target  x  x  o        x: refused, o: waits its turn
///        x    x  o
///        o    o               each step is AgentRadius
class SafePlace {
 public:
  /// `target` or the first safe place near it; `target` when MaxNumSafeRepositionAttempts places were refused. z is
  /// kept.
  Vec3 find(const Pitch& pitch, const Player& player, const Vec3& target, bool avoidBall);

 private:
  struct Candidate {
    int i = 0, j = 0;  ///< steps in x and in y
    double distance = 0;
  };
  bool isSafe(const Pitch& pitch, const Player& player, double x, double y, bool avoidBall) const;
  void propose(int i, int j);
  Candidate nearest();

  // kept between searches so that none allocates
  std::vector<Bounds> others_;
  std::vector<Candidate> open_;
  std::vector<std::pair<int, int>> seen_;
  Vec3 from_ = Vec3::Zero(), target_ = Vec3::Zero();
  double stepX_ = 0, stepY_ = 0;
};

}  // namespace spark::soccer
