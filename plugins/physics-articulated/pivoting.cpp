#include "pivoting.h"

namespace spark::articulated {

namespace {

/// The state that is consistent with the force or residual that was computed in the row's present state.
RowState consistentState(const System& system, const Row& row, const BoundedRow& limits) {
  switch (row.state) {
    case RowState::holds:
      if (row.force <= row.low + limits.forceTolerance) return RowState::atLow;
      if (row.force >= row.high - limits.forceTolerance) return RowState::atHigh;
      return RowState::holds;
    case RowState::atLow:
      return system.residual(row) < -limits.motionTolerance ? RowState::holds : RowState::atLow;
    case RowState::atHigh:
      return system.residual(row) > limits.motionTolerance ? RowState::holds : RowState::atHigh;
    default:
      return RowState::holds;
  }
}

/// A pseudo-random bit of a pass and a row: a hash, so that it is repeatable and has no pattern for a cycle to follow.
bool randomBit(std::uint64_t pass, std::uint64_t row) {
  // The finaliser of SplitMix64 (Steele, Lea and Flood 2014).
  std::uint64_t z = (pass * 0x9e3779b97f4a7c15u) ^ (row * 0xbf58476d1ce4e5b9u);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return ((z >> 33) & 1) != 0;
}

}  // namespace

void Pivoting::findViolated(const System& system) {
  violated_.clear();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = system.rows[rows[i].row];
    if (consistentState(system, row, rows[i]) != row.state) violated_.push_back(toIndex(i));
  }
}

/// Flips all violated rows, or about half of them and at least one.
void Pivoting::flip(System& system, std::uint32_t pass, bool half) {
  bool flipped = false;
  for (std::size_t k = 0; k < violated_.size(); ++k) {
    const bool last = k + 1 == violated_.size();
    if (half && !(last && !flipped) && !randomBit(pass, k)) continue;
    const BoundedRow& limits = rows[violated_[k]];
    Row& row = system.rows[limits.row];
    row.state = consistentState(system, row, limits);
    system.stateChanged(row);
    flipped = true;
  }
}

bool Pivoting::solve(System& system) {
  // Passes that may fail to reduce the number of violations before only halves are flipped.
  constexpr int kMaxFailures = 1;
  std::size_t fewest = SIZE_MAX;
  int failuresLeft = 0;
  for (std::uint32_t pass = 0; pass < maxPasses; ++pass) {
    system.solve();
    ++passes;
    findViolated(system);
    if (violated_.empty()) return true;
    const bool fewer = violated_.size() < fewest;
    if (fewer) fewest = violated_.size();
    failuresLeft = fewer ? kMaxFailures : failuresLeft - 1;
    flip(system, pass, failuresLeft < 0);
  }
  return solveExactly(system);
}

bool Pivoting::solveExactly(System& system) {
  const std::size_t n = rows.size();
  if (n > maxExactRows) return false;
  ++exactSolutions;
  const auto at = [&](std::size_t i) -> Row& { return system.rows[rows[i].row]; };
  // w = A x + b of the bounded rows, with all other rows as equations. b is their residual without any of their forces.
  for (std::size_t i = 0; i < n; ++i) {
    at(i).state = RowState::off;
    system.stateChanged(at(i));
  }
  system.solve();
  lcp_.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    lcp_.b[i] = system.residual(at(i));
    lcp_.low[i] = at(i).low, lcp_.high[i] = at(i).high;
  }
  // A is their Delassus matrix plus D, one column (or row: it is symmetric) per unit force.
  for (std::size_t i = 0; i < n; ++i) {
    system.respondTo(at(i));
    for (std::size_t j = 0; j < n; ++j) lcp_.a[i * n + j] = system.trees.motionAlong(at(j));
    lcp_.a[i * n + i] += at(i).softness;
  }
  const bool found = lcp_.solve(states_);
  for (std::size_t i = 0; i < n; ++i) {
    at(i).state = states_[i];
    system.stateChanged(at(i));
  }
  system.solve();
  return found;
}

}  // namespace spark::articulated
