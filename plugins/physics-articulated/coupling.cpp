#include "coupling.h"

namespace spark::articulated {

namespace {

double dot(const double* a, const double* b, std::size_t n) {
  double even = 0, odd = 0;
  std::size_t i = 0;
  for (; i + 1 < n; i += 2) {
    even += a[i] * b[i];
    odd += a[i + 1] * b[i + 1];
  }
  if (i < n) even += a[i] * b[i];
  return even + odd;
}

}  // namespace

void Coupling::reserve(std::size_t rows, std::size_t reach) {
  reaches_.reserve(rows * reach);
  members_.reserve(rows);
  touching_.reserve(rows * rows);
  lower_.reserve(rows * rows);
  for (auto* v : {&inverse_, &forces_}) v->reserve(rows);
  holding_.reserve(rows);
}

void Coupling::form(const Elimination& trees, const Rows& rows) {
  reaches_.clear();
  for (Member& m : members_) {
    m.start = static_cast<int>(reaches_.size());
    trees.reach(rows[m.row], reaches_);
    m.end = static_cast<int>(reaches_.size());
  }
  const std::size_t n = members_.size();
  touching_.resize(n * n);
  const Reach* all = reaches_.data();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j <= i; ++j)
      touching_[i * n + j] = Elimination::touch(all + members_[i].start, all + members_[i].end, all + members_[j].start,
                                                all + members_[j].end);
}

void Coupling::factor(const Rows& rows) {
  // What elimination leaves of a row that says what others say is rounding.
  constexpr double kRounding = 1e-13;
  const std::size_t n = members_.size(), m = holding_.size();
  lower_.resize(m * m);
  inverse_.resize(m);
  for (std::size_t i = 0; i < m; ++i) {
    const auto row = static_cast<std::size_t>(holding_[i]);
    double* li = lower_.data() + i * m;
    // L_i D first, then L_i.
    for (std::size_t j = 0; j < i; ++j)
      li[j] = touching_[row * n + static_cast<std::size_t>(holding_[j])] - dot(li, lower_.data() + j * m, j);
    double pivot = touching_[row * n + row] + rows[members_[row].row].softness;
    const double least = kRounding * pivot;
    for (std::size_t j = 0; j < i; ++j) {
      const double scaled = li[j] * inverse_[j];
      pivot -= li[j] * scaled;
      li[j] = scaled;
    }
    inverse_[i] = pivot > least ? 1 / pivot : 0;
  }
}

void Coupling::solve(Elimination& trees, Rows& rows, bool targets) {
  holding_.clear();
  for (std::size_t i = 0; i < members_.size(); ++i)
    if (rows[members_[i].row].holds()) holding_.push_back(static_cast<int>(i));
  if (holding_.empty()) return;
  factor(rows);
  const std::size_t m = holding_.size();
  forces_.resize(m);
  for (std::size_t i = 0; i < m; ++i) {
    const Member& member = members_[static_cast<std::size_t>(holding_[i])];
    const double target = targets ? rows[member.row].target : 0;
    forces_[i] = target - trees.touchLoads(reaches_.data() + member.start, reaches_.data() + member.end);
    forces_[i] -= dot(lower_.data() + i * m, forces_.data(), i);
  }
  for (std::size_t i = 0; i < m; ++i) forces_[i] *= inverse_[i];
  for (std::size_t i = m; i-- > 0;)
    for (std::size_t j = 0; j < i; ++j) forces_[j] -= lower_[i * m + j] * forces_[i];
  for (std::size_t i = 0; i < m; ++i) {
    const Member& member = members_[static_cast<std::size_t>(holding_[i])];
    rows[member.row].force = forces_[i];
    trees.push(reaches_.data() + member.start, reaches_.data() + member.end, forces_[i]);
  }
}

}  // namespace spark::articulated
