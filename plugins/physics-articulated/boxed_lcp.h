#pragma once
/// \file
/// The exact way to find which bounds hold, for the rare steps in which the quick way (pivoting.h) does not come to an
/// end.

#include <vector>

#include "rows.h"

namespace spark::articulated {

/// Find x with  w = A x + b,  low <= x <= high,  w >= 0 where x = low,  w <= 0 where x = high,  else w = 0.  A is
/// symmetric positive semidefinite; low <= 0 <= high.
///
/// Dantzig's way: one row after the other is driven from 0 to where its conditions are met, while those before it keep
/// theirs. Whenever one of these runs into a bound or leaves it, it changes sides. All that is asked of A at any time
/// is the matrix "swept" on the rows that hold, A_CC^-1 and what follows from it, and one change of side is one sweep:
/// rows^2 operations.
class BoxedLcp {
 public:
  std::vector<double> a, b, low, high;  ///< a: row by row, all of it

  void resize(std::size_t rows);
  /// Which rows hold and at which bounds the others stand; false when rounding does not let it end. Uses up a.
  bool solve(std::vector<State>& states);

 private:
  enum class Event { none, settled, atLow, atHigh, leaves, reachesLow, reachesHigh };
  struct Step {
    Event event = Event::none;
    std::size_t row = 0;
    double size = HUGE_VAL;
  };
  void sweep(std::size_t k);
  bool drive(std::size_t i, std::vector<State>& states, std::size_t& changes);
  Step longest(std::size_t i, double direction, const std::vector<State>& states) const;
  std::size_t rows_ = 0;
  std::vector<double> original_, x_, column_;
  std::vector<double> w_;  ///< of rows that stand at a bound; those that hold have none
};

}  // namespace spark::articulated
