#pragma once
/// \file
/// Which rows hold, and which stand at a bound: motors that give all they have, stops that are left, contacts that
/// part, friction that slips.

#include "boxed_lcp.h"
#include "system.h"

namespace spark::articulated {

/// A row with bounds, and how far from them it counts as being at them.
struct Bounded {
  int row = 0;
  double motion = 0;  ///< of the equation, m/s^2 or rad/s^2
  double force = 0;   ///< N, Nm
};

/// Finds the states in which every row keeps its conditions. There is only one such solution: with softness > 0 the
/// matrix is positive definite, however the search began.
///
/// Block principal pivoting: solve, turn all rows over that break their conditions, solve again. Mostly there is
/// nothing to turn, since it begins with the states of the step before. When the number of broken rows does not fall,
/// only a (repeatable) random half of them is turned, which breaks cycles; when passes run out, the rows with bounds
/// are solved exactly (BoxedLcp).
///
/// A row within rounding of a bound stands at it, whatever its state was before: so the outcome depends on the island
/// alone and not on where the search began, and a world that was saved and restored goes on with the same digits.
class Pivoting {
 public:
  int mostPasses = 30;
  /// Rows that are solved exactly at most.
  int mostExactRows = 400;
  std::vector<Bounded> rows;

  void reserve(std::size_t most) {
    rows.reserve(most);
    broken_.reserve(most);
  }
  /// False: no states were found, the motions mean nothing.
  bool settle(System& system);
  /// Counted since the object was made.
  std::int64_t passes = 0, exactSolutions = 0;

 private:
  /// Rows that break their conditions, in `broken_`.
  void findBroken(const System& system);
  void turn(System& system, int pass, bool half);
  bool solveExactly(System& system);
  std::vector<int> broken_;
  BoxedLcp exact_;
  std::vector<State> states_;
};

}  // namespace spark::articulated
