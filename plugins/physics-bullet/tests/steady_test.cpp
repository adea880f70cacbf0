#include "../../../tests/allocations.h"
#include "../../../tests/engines/engine_world.h"

using namespace spark;
using namespace spark::test;

TEST_CASE("a step of Bullet's allocates no memory of Spark's once the world has settled") {
  const EngineKind bullet{"BulletEngine", "physics-bullet"};
  EngineWorld w(bullet);
  w.ground();
  std::vector<BodyHandle> bodies;
  for (int i = 0; i < 5; ++i) bodies.push_back(w.block({0.01 * i, 0, 0.2 + 0.4 * i}, {0.4, 0.4, 0.4}));
  for (int i = 0; i < 4; ++i) {
    const BodyHandle hanging = w.sphere({3 + 0.5 * i, 0, 3}, 0.1);
    const JointHandle j = w.joint(JointType::hinge, hanging, i == 0 ? BodyHandle::none : bodies.back(),
                                  {2.75 + 0.5 * i, 0, 3}, Vec3::UnitY());
    w.motor(j, 0, 0.5, 1);
    w.world.setFeedback(j, true);
    bodies.push_back(hanging);
  }
  w.run(0.5);
  int allocations = 0;
  for (int i = 0; i < 20; ++i) {
    w.detect();
    allocations += Allocations::in([&] { w.stepper.step(*w.engine, w.contacts, w.dt); });
  }
  CHECK(allocations == 0);
}
