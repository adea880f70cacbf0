#include "boxed_lcp.h"

namespace spark::articulated {

void BoxedLcp::resize(std::size_t rows) {
  rows_ = rows;
  a.assign(rows * rows, 0);
  for (auto* v : {&b, &low, &high, &x_, &w_, &column_}) v->assign(rows, 0);
}

/// Moves row k into C, or out of it. With C swept, column i of `a` is the response to a unit of x_i that keeps w_C = 0:
/// in the rows of C, A_CC^-1 A_Ci, the decrease of x_C; in the others, A_Ni - A_NC A_CC^-1 A_Ci, the increase of w_N.
/// Sweeping twice restores `a`.
void BoxedLcp::sweep(std::size_t k) {
  const std::size_t n = rows_;
  const double pivot = 1 / a[k * n + k];
  for (std::size_t i = 0; i < n; ++i) column_[i] = a[i * n + k];
  for (std::size_t i = 0; i < n; ++i) {
    if (i == k) continue;
    const double f = column_[i] * pivot;
    if (f == 0) continue;
    for (std::size_t j = 0; j < n; ++j) a[i * n + j] -= f * a[k * n + j];
    a[i * n + k] = -f;
  }
  for (std::size_t j = 0; j < n; ++j) a[k * n + j] *= pivot;
  a[k * n + k] = pivot;
}

/// How far x_i can move in `direction` (1 or -1) until its own conditions hold or a row before it has to change sides.
BoxedLcp::Step BoxedLcp::ratioTest(std::size_t i, double direction, const std::vector<RowState>& states) const {
  const std::size_t n = rows_;
  // The driven row: w_i becomes 0, or x_i reaches its bound.
  const double slope = a[i * n + i];
  Step step;
  if (slope > 0) step = {Event::settled, i, std::abs(w_[i]) / slope};
  const double room = direction > 0 ? high[i] - x_[i] : x_[i] - low[i];
  if (room < step.size) step = {direction > 0 ? Event::atHigh : Event::atLow, i, room};
  for (std::size_t k = 0; k < i; ++k) {
    if (low[k] == high[k]) continue;
    const double rate = direction * a[k * n + i];
    if (states[k] == RowState::holds) {
      // In C: x_k reaches a bound.
      const double dx = -rate;
      if (dx == 0) continue;
      const double s = dx < 0 ? (low[k] - x_[k]) / dx : (high[k] - x_[k]) / dx;
      if (s < step.size) step = {dx < 0 ? Event::reachesLow : Event::reachesHigh, k, s};
    } else if (states[k] == RowState::atLow ? rate < 0 : rate > 0) {
      // At a bound: w_k becomes 0.
      const double s = -w_[k] / rate;
      if (s < step.size) step = {Event::leaves, k, s};
    }
  }
  step.size = std::max(step.size, 0.0);
  return step;
}

/// Drives row i to where its conditions hold. `changes` counts the steps of all rows.
bool BoxedLcp::drive(std::size_t i, std::vector<RowState>& states, std::size_t& changes) {
  const std::size_t n = rows_;
  w_[i] = b[i];
  for (std::size_t k = 0; k < n; ++k) w_[i] += original_[i * n + k] * x_[k];
  // x_i = 0 may be a bound whose condition holds already.
  if (low[i] == 0 && w_[i] >= 0) return states[i] = RowState::atLow, true;
  if (high[i] == 0 && w_[i] <= 0) return states[i] = RowState::atHigh, true;
  const double direction = w_[i] <= 0 ? 1 : -1;
  for (; changes < 20 * n + 100; ++changes) {
    const Step step = ratioTest(i, direction, states);
    if (step.event == Event::none || step.size == HUGE_VAL) return false;
    // Move x_i, the x of C, and the w of the others.
    for (std::size_t k = 0; k <= i; ++k) {
      const double change = direction * a[k * n + i] * step.size;
      if (k < i && states[k] == RowState::holds)
        x_[k] -= change;
      else
        w_[k] += change;
    }
    x_[i] += direction * step.size;
    switch (step.event) {
      case Event::settled:
        states[i] = RowState::holds;
        sweep(i);
        return true;
      case Event::atLow:
      case Event::atHigh:
        states[i] = step.event == Event::atLow ? RowState::atLow : RowState::atHigh;
        x_[i] = states[i] == RowState::atLow ? low[i] : high[i];
        return true;
      case Event::leaves:
        states[step.row] = RowState::holds;
        sweep(step.row);
        break;
      default:  // reachesLow, reachesHigh
        states[step.row] = step.event == Event::reachesLow ? RowState::atLow : RowState::atHigh;
        x_[step.row] = states[step.row] == RowState::atLow ? low[step.row] : high[step.row];
        w_[step.row] = 0;
        sweep(step.row);
        break;
    }
  }
  return false;
}

bool BoxedLcp::solve(std::vector<RowState>& states) {
  states.assign(rows_, RowState::off);
  original_ = a;
  std::size_t changes = 0;
  for (std::size_t i = 0; i < rows_; ++i)
    if (!drive(i, states, changes)) return false;
  return true;
}

}  // namespace spark::articulated
