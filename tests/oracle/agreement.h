#pragma once
/// \file
/// What counts as agreement.

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cstdio>

#include "shadow_solver.h"

namespace spark::oracle {

/// Says what was found, and fails when the two do not agree: velocities to 1e-8 of the greatest, forces to 1e-6, and
/// who sleeps. Nothing may be deferred to ODE.
inline void expectAgreement(const std::string& world, const Agreement& a) {
  fmt::print("{:<44} {:>5} steps {:>7} bodies {:>6} forces   speed {:.1e}   spin {:.1e}   force {:.1e}\n", world,
             a.steps, a.compared, a.feedbacks, a.speed, a.spin, a.force);
  std::fflush(stdout);
  INFO(world << ", worst in step " << a.worstStep);
  CHECK(a.compared > 0);
  CHECK(a.deferred == 0);
  CHECK(a.disagreedOnSleep == 0);
  CHECK(a.speed < 1e-8);
  CHECK(a.spin < 1e-8);
  CHECK(a.place < 1e-8);
  CHECK(a.force < 1e-6);
}

}  // namespace spark::oracle
