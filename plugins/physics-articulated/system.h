#pragma once
/// \file
/// An island as a system of equations: bodies, rows, and which rows hold.

#include "coupling.h"

namespace spark::articulated {

struct System {
  Rows rows;
  Elimination trees;
  Coupling coupling;

  /// Motions and forces for the states that the rows are in.
  void solve();
  /// How all rows' left sides answer to a force of 1 along one row, nothing else acting.
  void respond(const Row& row);
  /// What is left of a row's equation where it does not hold; 0 where it does.
  double residual(const Row& row) const { return trees.along(row) + row.softness * row.force - row.target; }
  /// A row began to hold, or ceased to.
  void changed(const Row& row);

 private:
  void factor();
  void push(const Row& row, double force);
  void readForces();
};

}  // namespace spark::articulated
