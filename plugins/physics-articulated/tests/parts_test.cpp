#include <catch2/catch.hpp>
#include <random>

#include "boxed_lcp.h"
#include "rotation.h"

using namespace spark;
using namespace spark::articulated;

TEST_CASE("portableAtan2 equals the C library's atan2 in all directions") {
  for (int i = -2000; i <= 2000; ++i) {
    const double angle = kPi * i / 2000, size = 1e-6 + std::abs(i);
    const double y = size * std::sin(angle), x = size * std::cos(angle);
    CHECK(std::abs(portableAtan2(y, x) - std::atan2(y, x)) <= 1e-15);
  }
  CHECK(portableAtan2(0, 0) == 0);
  CHECK(portableAtan2(0, -1) == Approx(kPi));
  CHECK(std::isnan(portableAtan2(std::nan(""), 1)));
}

TEST_CASE("the quaternion of a rotation matrix represents the same rotation") {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int i = 0; i < 200; ++i) {
    const Mat3 m = orthonormalFrame({any(random), any(random), any(random)}, {any(random), any(random), any(random)});
    const Quaternion q = Quaternion::of(m);
    const Eigen::Quaterniond same(q.w, q.v.x(), q.v.y(), q.v.z());
    CHECK((same.toRotationMatrix() - m).norm() < 1e-14);
  }
}

TEST_CASE("the solution of Dantzig's algorithm satisfies the conditions of each row") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int round = 0; round < 100; ++round) {
    const auto n = static_cast<Eigen::Index>(1 + random() % 40);
    const auto inner = round % 3 ? n : std::max<Eigen::Index>(1, n / 2);  // sometimes nearly singular
    Eigen::MatrixXd half(n, inner);
    Eigen::VectorXd b(n);
    for (double& v : half.reshaped()) v = any(random);
    for (double& v : b) v = any(random);
    const Eigen::MatrixXd a = half * half.transpose() + 1e-6 * Eigen::MatrixXd::Identity(n, n);
    BoxedLcp lcp;
    lcp.resize(static_cast<std::size_t>(n));
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto k = static_cast<std::size_t>(i);
      for (Eigen::Index j = 0; j < n; ++j) lcp.a[static_cast<std::size_t>(i * n + j)] = a(i, j);
      lcp.b[k] = b[i];
      lcp.low[k] = i % 3 == 0 ? 0 : i % 3 == 1 ? -0.5 : -0.1;
      lcp.high[k] = i % 3 == 0 ? HUGE_VAL : i % 3 == 1 ? 0.5 : 0.1;
    }
    std::vector<RowState> states;
    REQUIRE(lcp.solve(states));
    // Solves the rows in state `holds`, with the others at their bounds, and checks the conditions.
    Eigen::VectorXd x(n);
    std::vector<Eigen::Index> holding;
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto k = static_cast<std::size_t>(i);
      x[i] = states[k] == RowState::atLow ? lcp.low[k] : states[k] == RowState::atHigh ? lcp.high[k] : 0;
      if (states[k] == RowState::holds) holding.push_back(i);
    }
    const auto m = static_cast<Eigen::Index>(holding.size());
    if (m > 0) {
      Eigen::MatrixXd h(m, m);
      Eigen::VectorXd right(m);
      const Eigen::VectorXd rest = a * x + b;
      for (Eigen::Index i = 0; i < m; ++i) {
        right[i] = -rest[holding[static_cast<std::size_t>(i)]];
        for (Eigen::Index j = 0; j < m; ++j)
          h(i, j) = a(holding[static_cast<std::size_t>(i)], holding[static_cast<std::size_t>(j)]);
      }
      const Eigen::VectorXd found = h.ldlt().solve(right);
      for (Eigen::Index i = 0; i < m; ++i) x[holding[static_cast<std::size_t>(i)]] = found[i];
    }
    const Eigen::VectorXd w = a * x + b;
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto k = static_cast<std::size_t>(i);
      CHECK(x[i] >= lcp.low[k] - 1e-7);
      CHECK(x[i] <= lcp.high[k] + 1e-7);
      if (states[k] == RowState::atLow) CHECK(w[i] >= -1e-7);
      if (states[k] == RowState::atHigh) CHECK(w[i] <= 1e-7);
    }
  }
}
