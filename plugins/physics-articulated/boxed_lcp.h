#pragma once
/// \file
/// A direct solver of linear complementarity problems with bounds, for the rare steps in which block pivoting
/// (pivoting.h) does not end.

#include <vector>

#include "rows.h"

namespace spark::articulated {

/// Finds x with
///
///     w = A x + b,  low <= x <= high,  w >= 0 where x = low,  w <= 0 where x = high,  w = 0 elsewhere.
///
/// A is symmetric positive semidefinite and low <= 0 <= high.
///
/// The algorithm is Dantzig's (Cottle and Dantzig 1968; for contact forces Baraff 1994, "Fast contact force computation
/// for nonpenetrating rigid bodies"). One row after the other is driven from x = 0 to where its conditions hold, while
/// the rows before it keep theirs; whenever one of these reaches a bound or leaves it, it changes sides. The matrix is
/// kept swept on the set C of rows with w = 0 (Goodnight 1979, "A tutorial on the SWEEP operator"), so a change of side
/// costs one sweep: rows^2 operations.
class BoxedLcp {
 public:
  std::vector<double> a;             ///< A by rows, in full; solve() overwrites it
  std::vector<double> b, low, high;  ///< by row; bounds may be infinite

  /// Sets the number of rows. Fills all inputs with 0.
  void resize(std::size_t rows);
  /// Finds which rows hold (w = 0) and at which bounds the others are. Returns false if no end was found, because of
  /// rounding or an A that is not positive semidefinite; `states` is then meaningless.
  bool solve(std::vector<RowState>& states);

 private:
  /// What ends a step of the driven row: itself, or a row before it.
  enum class Event { none, settled, atLow, atHigh, leaves, reachesLow, reachesHigh };
  struct Step {
    Event event = Event::none;
    std::size_t row = 0;
    double size = HUGE_VAL;
  };
  void sweep(std::size_t k);
  bool drive(std::size_t i, std::vector<RowState>& states, std::size_t& changes);
  Step ratioTest(std::size_t i, double direction, const std::vector<RowState>& states) const;
  std::size_t rows_ = 0;
  std::vector<double> original_;  ///< A, not swept
  std::vector<double> x_;
  std::vector<double> w_;       ///< of rows at a bound; meaningless for rows that hold
  std::vector<double> column_;  ///< scratch of sweep()
};

}  // namespace spark::articulated
