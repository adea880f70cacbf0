#include "pivoting.h"

namespace spark::articulated {

namespace {

/// The state that a row's conditions want, given what was found for the one it is in.
State wanted(const System& system, const Row& row, const Bounded& limits) {
  switch (row.state) {
    case State::holds:
      if (row.force <= row.low + limits.force) return State::low;
      if (row.force >= row.high - limits.force) return State::high;
      return State::holds;
    case State::low:
      return system.residual(row) < -limits.motion ? State::holds : State::low;
    case State::high:
      return system.residual(row) > limits.motion ? State::holds : State::high;
    default:
      return State::holds;
  }
}

/// Even or odd, with no pattern that a cycle could follow.
bool chance(std::uint64_t pass, std::uint64_t row) {
  std::uint64_t z = (pass * 0x9e3779b97f4a7c15u) ^ (row * 0xbf58476d1ce4e5b9u);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return ((z >> 33) & 1) != 0;
}

}  // namespace

void Pivoting::findBroken(const System& system) {
  broken_.clear();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = system.rows[rows[i].row];
    if (wanted(system, row, rows[i]) != row.state) broken_.push_back(static_cast<int>(i));
  }
}

void Pivoting::turn(System& system, int pass, bool half) {
  bool turned = false;
  for (std::size_t k = 0; k < broken_.size(); ++k) {
    const bool last = k + 1 == broken_.size();
    if (half && !(last && !turned) && !chance(static_cast<std::uint64_t>(pass), k)) continue;
    const Bounded& limits = rows[static_cast<std::size_t>(broken_[k])];
    Row& row = system.rows[limits.row];
    row.state = wanted(system, row, limits);
    system.changed(row);
    turned = true;
  }
}

bool Pivoting::settle(System& system) {
  std::size_t fewest = SIZE_MAX;
  int retries = 0;
  for (int pass = 0; pass < mostPasses; ++pass) {
    system.solve();
    ++passes;
    findBroken(system);
    if (broken_.empty()) return true;
    constexpr int kRetries = 1;
    const bool fewer = broken_.size() < fewest;
    if (fewer) fewest = broken_.size();
    retries = fewer ? kRetries : retries - 1;
    turn(system, pass, retries < 0);
  }
  return solveExactly(system);
}

bool Pivoting::solveExactly(System& system) {
  const std::size_t n = rows.size();
  if (n > static_cast<std::size_t>(mostExactRows)) return false;
  ++exactSolutions;
  const auto at = [&](std::size_t i) -> Row& { return system.rows[rows[i].row]; };
  for (std::size_t i = 0; i < n; ++i) at(i).state = State::off, system.changed(at(i));
  system.solve();
  exact_.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    exact_.b[i] = system.residual(at(i));
    exact_.low[i] = at(i).low, exact_.high[i] = at(i).high;
  }
  for (std::size_t i = 0; i < n; ++i) {
    system.respond(at(i));
    for (std::size_t j = 0; j < n; ++j) exact_.a[i * n + j] = system.trees.along(at(j));
    exact_.a[i * n + i] += at(i).softness;
  }
  const bool found = exact_.solve(states_);
  for (std::size_t i = 0; i < n; ++i) at(i).state = states_[i], system.changed(at(i));
  system.solve();
  return found;
}

}  // namespace spark::articulated
