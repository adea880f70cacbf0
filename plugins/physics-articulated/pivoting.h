#pragma once
/// \file
/// Finds which bounded rows hold and which are at a bound: motors at their maximal force, stops and contacts that open,
/// friction that slips.

#include "boxed_lcp.h"
#include "system.h"

namespace spark::articulated {

/// A row with bounds, and the tolerances within which it counts as being at one of them.
struct BoundedRow {
  Index row = 0;               ///< in System::rows
  double motionTolerance = 0;  ///< of the row's residual [m/s^2 or rad/s^2]
  double forceTolerance = 0;   ///< of its force [N or Nm]
};

/// Finds the states in which all rows meet their conditions. With D > 0 the matrix of the problem is positive definite,
/// and the solution is unique (Cottle, Pang and Stone 1992, chapter 3).
///
/// The algorithm is block principal pivoting (Júdice and Pires 1994, "A block principal pivoting algorithm for
/// large-scale strictly monotone linear complementarity problems"): solve, flip the states of all rows that violate
/// their conditions, solve again. Mostly nothing is to be flipped, because the search begins with the states of the
/// last step. When two passes in a row do not reduce the number of violations, a repeatable pseudo-random half of them
/// is flipped instead, which breaks cycles. (Júdice and Pires flip single rows then, as in Murty's algorithm.) After
/// `maxPasses` passes Dantzig's algorithm (BoxedLcp) solves for the bounded rows.
///
/// A row within its tolerance of a bound is put at that bound, whatever its state was. So the result depends on the
/// island alone and not on where the search began, and a saved and restored world continues with the same digits.
class Pivoting {
 public:
  std::uint32_t maxPasses = 30;     ///< of block pivoting, in each search
  std::size_t maxExactRows = 400;   ///< searches with more bounded rows do not use Dantzig's algorithm
  std::vector<BoundedRow> rows;     ///< the bounded rows; to be filled before solve()
  std::int64_t passes = 0;          ///< of block pivoting, since construction
  std::int64_t exactSolutions = 0;  ///< uses of Dantzig's algorithm, since construction

  /// Allocates memory for `count` bounded rows.
  void reserve(std::size_t count) {
    rows.reserve(count);
    violated_.reserve(count);
  }
  /// Finds the states of `rows` and solves the system with them. Returns false if no states were found; motions and
  /// forces are then meaningless.
  bool solve(System& system);

 private:
  void findViolated(const System& system);
  void flip(System& system, std::uint32_t pass, bool half);
  bool solveExactly(System& system);
  std::vector<Index> violated_;  ///< indices in `rows` of those that violate their conditions
  BoxedLcp lcp_;
  std::vector<RowState> states_;
};

}  // namespace spark::articulated
