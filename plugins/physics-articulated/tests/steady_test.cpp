#include "allocations.h"
#include "humanoids.h"

using namespace spark;
using namespace spark::test;

TEST_CASE("a step allocates no memory once the world has settled") {
  Twins t(3);
  t.ground();
  Humanoids humanoids(t);
  for (int i = 0; i < 2; ++i) humanoids.add({0.15 * i, 0, 0});
  for (int i = 0; i < 5; ++i)
    t.box({0.2, 0.2, 0.2}, t.body({2 + 0.01 * i, 0, 0.1 + 0.2 * i}, 1, Mat3::Identity() * 0.01));
  int allocations = 0;
  for (int i = 0; i < 60; ++i) {
    t.detectContacts(t.solved);
    const int inStep = Allocations::in([&] { t.solved.step(t.dt); });
    if (i >= 40) allocations += inStep;
  }
  CHECK(t.counted("islands") > 0);
  CHECK(allocations == 0);
}
