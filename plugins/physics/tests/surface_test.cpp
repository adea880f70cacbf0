#include <catch2/catch.hpp>

#include "../contact_loop.h"

using namespace spark;
using engine::Surface;

namespace {

Surface surface(bool bounce, double value, double velocity, double erp, double cfm, double slip) {
  Surface s = defaultSurface();
  s.bounceOn = bounce;
  if (bounce) s.bounce = value, s.bounceVelocity = velocity;
  s.softErpOn = erp > 0, s.softErp = erp;
  s.softCfmOn = cfm > 0, s.softCfm = cfm;
  s.slipOn = slip > 0;
  if (slip > 0) s.slip1 = s.slip2 = slip;
  return s;
}

// The surfaces of the default league, as its scene files set them.
const Surface kGround = surface(false, 0, 0, 0.2, 0, 5e-3);
const Surface kBall = surface(true, 0.8, 0.8, 0.5, 0.05, 0.6);
const Surface kFoot = surface(false, 0, 0, 0.6, 1e-4, 5e-3);
const Surface kGoal = defaultSurface();

void check(const Surface& a, const Surface& b, bool bounce, double value, double velocity, double erp, double cfm,
           double slip) {
  for (const Surface& s : {physics::combine(a, b), physics::combine(b, a)}) {
    CHECK(s.mu == HUGE_VAL);
    CHECK(s.bounceOn == bounce);
    if (bounce) {
      CHECK(s.bounce == Approx(value));
      CHECK(s.bounceVelocity == Approx(velocity));
    }
    CHECK(s.softErpOn == (erp > 0));
    CHECK(s.softErp == Approx(erp));
    CHECK(s.softCfmOn == (cfm > 0));
    CHECK(s.softCfm == Approx(cfm));
    CHECK(s.slipOn == (slip > 0));
    CHECK(s.slip1 == Approx(slip));
    CHECK(s.slip2 == Approx(slip));
  }
}

}  // namespace

TEST_CASE("surface: the default bounces and has infinite friction") {
  CHECK(kGoal.bounceOn);
  CHECK(kGoal.bounce == 0.8);
  CHECK(kGoal.bounceVelocity == 2.0);
  CHECK(kGoal.mu == HUGE_VAL);
  CHECK_FALSE(kGoal.slipOn);
  CHECK_FALSE(kGoal.softErpOn);
  CHECK_FALSE(kGoal.softCfmOn);
}

TEST_CASE("surface: pairs of the default league combine to the values for which robots were tuned") {
  check(kFoot, kGround, false, 0, 0, 0.4, 1e-4, 5e-3);
  check(kBall, kGround, true, 0.8, 0.8, 0.35, 0.05, 0.3025);
  check(kBall, kFoot, true, 0.8, 0.8, 0.55, 0.02505, 0.3025);
  check(kBall, kGoal, true, 0.8, 1.4, 0.5, 0.05, 0.6);
  check(kFoot, kGoal, true, 0.8, 2.0, 0.6, 1e-4, 5e-3);
  check(kGoal, kGoal, true, 0.8, 2.0, 0, 0, 0);
}

TEST_CASE("surface: friction is the mean, and infinite friction stays infinite") {
  Surface a, b;
  a.mu = 0.4, b.mu = 1.0;
  CHECK(physics::combine(a, b).mu == Approx(0.7));
  b.mu = HUGE_VAL;
  CHECK(physics::combine(a, b).mu == HUGE_VAL);
}
