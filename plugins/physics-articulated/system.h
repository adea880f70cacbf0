#pragma once
/// \file
/// An island as a system of linear equations, for given states of its rows.

#include "coupling.h"

namespace spark::articulated {

/// Bodies, rows and coupling of an island. Memory is kept from step to step.
struct System {
  Rows rows;
  Elimination trees;
  Coupling coupling;

  /// Solves for the motions of all nodes and the forces of all rows, with the rows that hold as equations and the
  /// forces of the others at their bounds.
  void solve();
  /// Computes the motions of all nodes under a unit force along `row` alone: a column of the Delassus matrix of the
  /// rows that do not hold. Row forces are meaningless afterwards, until the next solve().
  void respondTo(const Row& row);
  /// J u + D x - r: 0 for a row that holds, but for rounding.
  double residual(const Row& row) const { return trees.motionAlong(row) + row.softness * row.force - row.target; }
  /// To be called after a row began or ceased to hold. `row` is one of `rows`.
  void stateChanged(const Row& row);

 private:
  void factor();
  void addForce(const Row& row, double force);
  void readForces();
};

}  // namespace spark::articulated
