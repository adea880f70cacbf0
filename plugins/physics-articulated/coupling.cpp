#include "coupling.h"

namespace spark::articulated {

namespace {

/// The scalar product, with even and odd elements summed apart.
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

void Coupling::reserve(std::size_t rows, std::size_t pathLength) {
  pathTerms_.reserve(rows * pathLength);
  members_.reserve(rows);
  delassus_.reserve(rows * rows);
  lower_.reserve(rows * rows);
  for (auto* v : {&inverseD_, &forces_}) v->reserve(rows);
  active_.reserve(rows);
}

void Coupling::assemble(const Elimination& trees, const Rows& rows) {
  pathTerms_.clear();
  for (Member& m : members_) {
    m.begin = toIndex(pathTerms_.size());
    trees.appendPathResponse(rows[m.row], pathTerms_);
    m.end = toIndex(pathTerms_.size());
  }
  const std::size_t n = members_.size();
  delassus_.resize(n * n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j <= i; ++j)
      delassus_[i * n + j] = Elimination::delassusTerm(pathOf(members_[i]), pathOf(members_[j]));
}

/// LDL^T factorisation of the Delassus matrix of the active rows plus their softness, row by row.
void Coupling::factor(const Rows& rows) {
  // A pivot below this fraction of its diagonal element is rounding: the row is redundant and gets no force.
  constexpr double kRounding = 1e-13;
  const std::size_t n = members_.size(), m = active_.size();
  lower_.resize(m * m);
  inverseD_.resize(m);
  for (std::size_t i = 0; i < m; ++i) {
    const std::size_t row = active_[i];
    double* li = lower_.data() + i * m;
    // First L_ij D_j = A_ij - sum over k < j of (L_ik D_k) L_jk.
    for (std::size_t j = 0; j < i; ++j) li[j] = delassus_[row * n + active_[j]] - dot(li, lower_.data() + j * m, j);
    // Then D_i = A_ii - sum over j of L_ij D_j L_ij, and L_ij.
    double pivot = delassus_[row * n + row] + rows[members_[row].row].totalSoftness();
    const double least = kRounding * pivot;
    for (std::size_t j = 0; j < i; ++j) {
      const double scaled = li[j] * inverseD_[j];
      pivot -= li[j] * scaled;
      li[j] = scaled;
    }
    inverseD_[i] = pivot > least ? 1 / pivot : 0;
  }
}

void Coupling::solve(Elimination& trees, Rows& rows, bool useTargets) {
  active_.clear();
  for (std::size_t i = 0; i < members_.size(); ++i)
    if (rows[members_[i].row].active()) active_.push_back(toIndex(i));
  if (active_.empty()) return;
  factor(rows);
  const std::size_t m = active_.size();
  forces_.resize(m);
  // L^-1 (r - J u0).
  for (std::size_t i = 0; i < m; ++i) {
    const Member& member = members_[active_[i]];
    const double target = useTargets ? rows[member.row].totalTarget() : 0;
    forces_[i] = target - trees.predictedMotion(pathOf(member));
    forces_[i] -= dot(lower_.data() + i * m, forces_.data(), i);
  }
  // x = L^-T D^-1 L^-1 (r - J u0).
  for (std::size_t i = 0; i < m; ++i) forces_[i] *= inverseD_[i];
  for (std::size_t i = m; i-- > 0;)
    for (std::size_t j = 0; j < i; ++j) forces_[j] -= lower_[i * m + j] * forces_[i];
  for (std::size_t i = 0; i < m; ++i) {
    const Member& member = members_[active_[i]];
    rows[member.row].force = forces_[i];
    trees.applyForce(pathOf(member), forces_[i]);
  }
}

}  // namespace spark::articulated
