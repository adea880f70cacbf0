#pragma once
/// \file
/// The limits within which an engine agrees with ODE.

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cstdio>

#include "shadow_engine.h"

namespace spark::oracle {

/// Prints the differences. Fails unless velocities agree to 1e-8 of the largest one, positions to 1e-8 m and forces to
/// 1e-6 of the largest one, the same bodies are asleep and marked as moved, and no body was deferred.
inline void expectAgreement(const std::string& world, const Agreement& a) {
  fmt::print("{:<44} {:>5} steps {:>7} bodies {:>6} forces   speed {:.1e}   spin {:.1e}   force {:.1e}\n", world,
             a.steps, a.compared, a.feedbacks, a.speed, a.spin, a.force);
  std::fflush(stdout);
  INFO(world << ", worst in step " << a.worstStep);
  CHECK(a.compared > 0);
  CHECK(a.deferred == 0);
  CHECK(a.disagreedOnSleep == 0);
  CHECK(a.disagreedOnMoved == 0);
  CHECK(a.speed < 1e-8);
  CHECK(a.spin < 1e-8);
  CHECK(a.position < 1e-8);
  CHECK(a.force < 1e-6);
}

}  // namespace spark::oracle
