#include "boxed_lcp.h"

namespace spark::articulated {

void BoxedLcp::resize(std::size_t rows) {
  rows_ = rows;
  a.assign(rows * rows, 0);
  for (auto* v : {&b, &low, &high, &x_, &w_, &column_}) v->assign(rows, 0);
}

// With the rows in C swept, column i says what a unit of x_i does: to x_C by -A_CC^-1 A_Ci (kept with its sign turned),
// to w_N by what is left of A_Ni. Sweeping twice undoes it.
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

BoxedLcp::Step BoxedLcp::longest(std::size_t i, double direction, const std::vector<State>& states) const {
  const std::size_t n = rows_;
  const double slope = a[i * n + i];
  Step step;
  if (slope > 0) step = {Event::settled, i, std::abs(w_[i]) / slope};
  const double room = direction > 0 ? high[i] - x_[i] : x_[i] - low[i];
  if (room < step.size) step = {direction > 0 ? Event::atHigh : Event::atLow, i, room};
  for (std::size_t k = 0; k < i; ++k) {
    if (low[k] == high[k]) continue;
    const double rate = direction * a[k * n + i];
    if (states[k] == State::holds) {
      const double dx = -rate;
      if (dx == 0) continue;
      const double s = dx < 0 ? (low[k] - x_[k]) / dx : (high[k] - x_[k]) / dx;
      if (s < step.size) step = {dx < 0 ? Event::reachesLow : Event::reachesHigh, k, s};
    } else if (states[k] == State::low ? rate < 0 : rate > 0) {
      const double s = -w_[k] / rate;
      if (s < step.size) step = {Event::leaves, k, s};
    }
  }
  step.size = std::max(step.size, 0.0);
  return step;
}

bool BoxedLcp::drive(std::size_t i, std::vector<State>& states, std::size_t& changes) {
  const std::size_t n = rows_;
  w_[i] = b[i];
  for (std::size_t k = 0; k < n; ++k) w_[i] += original_[i * n + k] * x_[k];
  if (low[i] == 0 && w_[i] >= 0) return states[i] = State::low, true;
  if (high[i] == 0 && w_[i] <= 0) return states[i] = State::high, true;
  const double direction = w_[i] <= 0 ? 1 : -1;
  for (; changes < 20 * n + 100; ++changes) {
    const Step step = longest(i, direction, states);
    if (step.event == Event::none || step.size == HUGE_VAL) return false;
    for (std::size_t k = 0; k <= i; ++k) {
      const double rate = direction * a[k * n + i] * step.size;
      if (k < i && states[k] == State::holds)
        x_[k] -= rate;
      else
        w_[k] += rate;
    }
    x_[i] += direction * step.size;
    switch (step.event) {
      case Event::settled:
        states[i] = State::holds;
        sweep(i);
        return true;
      case Event::atLow:
      case Event::atHigh:
        states[i] = step.event == Event::atLow ? State::low : State::high;
        x_[i] = states[i] == State::low ? low[i] : high[i];
        return true;
      case Event::leaves:
        states[step.row] = State::holds;
        sweep(step.row);
        break;
      default:
        states[step.row] = step.event == Event::reachesLow ? State::low : State::high;
        x_[step.row] = states[step.row] == State::low ? low[step.row] : high[step.row];
        w_[step.row] = 0;
        sweep(step.row);
        break;
    }
  }
  return false;
}

bool BoxedLcp::solve(std::vector<State>& states) {
  states.assign(rows_, State::off);
  original_ = a;
  std::size_t changes = 0;
  for (std::size_t i = 0; i < rows_; ++i)
    if (!drive(i, states, changes)) return false;
  return true;
}

}  // namespace spark::articulated
