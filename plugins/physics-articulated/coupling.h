#pragma once
/// \file
/// The coupling rows: those that cannot be part of a tree. They are the rows of contacts between two moving bodies, of
/// loop joints, and contacts with the static world that are too stiff to be folded into a body's inertia. Their forces
/// x come from one dense system,
///
///     (J T^-1 J^T + D) x = r - J u0,
///
/// with the Delassus matrix J T^-1 J^T of the rows that hold, T the equations of the trees, and u0 the motion without
/// these forces. Memory grows with the square of the number of rows, time with its cube.

#include <vector>

#include "elimination.h"

namespace spark::articulated {

/// The coupling rows of an island. Memory is kept from step to step.
class Coupling {
 public:
  /// Removes all rows.
  void begin() { members_.clear(); }
  /// Adds row `row` of the island.
  void add(Index row) { members_.push_back({row, 0, 0}); }
  std::size_t size() const { return members_.size(); }
  /// Allocates memory for `rows` rows with path responses of up to `pathLength` nodes.
  void reserve(std::size_t rows, std::size_t pathLength);

  /// Computes path responses and the Delassus matrix of all rows. To be called after each Elimination::factor() that
  /// returned true.
  void assemble(const Elimination& trees, const Rows& rows);
  /// Between Elimination::forward() and backward(): solves for the total forces of the active rows, and applies them to
  /// the trees. With `useTargets` false, r is 0.
  void solve(Elimination& trees, Rows& rows, bool useTargets);

 private:
  struct Member {
    Index row;
    Index begin, end;  ///< of its path response, in pathTerms_
  };
  PathResponse pathOf(const Member& m) const { return {pathTerms_.data() + m.begin, pathTerms_.data() + m.end}; }
  void factor(const Rows& rows);
  std::vector<Member> members_;
  std::vector<PathTerm> pathTerms_;
  std::vector<double> delassus_;  ///< members x members by rows; the lower triangle with the diagonal is valid
  std::vector<Index> active_;     ///< members whose rows are active
  std::vector<double> lower_;     ///< L below its unit diagonal, active x active by rows
  std::vector<double> inverseD_;  ///< 1 / D of the factorisation; 0 for redundant rows
  std::vector<double> forces_;    ///< x of the active rows
};

}  // namespace spark::articulated
