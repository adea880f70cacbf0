#pragma once
/// \file
/// Rows that cannot be part of a tree: contacts between two moving bodies, joints that close loops, and rows so stiff
/// that a body's inertia would drown in them. Their forces come from one dense system, as large as there are such rows:
///
///     (R + D) x = r - J u0        R_ij: how rows i and j touch through the trees;  u0: the motion without these forces

#include <vector>

#include "elimination.h"

namespace spark::articulated {

class Coupling {
 public:
  void begin() { members_.clear(); }
  void add(int row) { members_.push_back({row, 0, 0}); }
  std::size_t size() const { return members_.size(); }
  /// Room for rows that reach that many bodies each.
  void reserve(std::size_t rows, std::size_t reach);

  /// Finds how the rows touch each other; again after every factor() of the trees that changed something.
  void form(const Elimination& trees, const Rows& rows);
  /// Between the trees' passes forward and backward: finds the forces of the rows that hold, and adds what they do.
  void solve(Elimination& trees, Rows& rows, bool targets);

 private:
  struct Member {
    int row, start, end;  ///< its reach
  };
  void factor(const Rows& rows);
  std::vector<Member> members_;
  std::vector<Reach> reaches_;
  std::vector<double> touching_;                  ///< row by row, all members
  std::vector<int> holding_;                      ///< members whose rows hold
  std::vector<double> lower_, inverse_, forces_;  ///< L below the diagonal row by row, 1 / D, and what is solved for
};

}  // namespace spark::articulated
