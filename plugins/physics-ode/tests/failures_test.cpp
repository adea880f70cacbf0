// ODE ends the process at an error or a failed assertion: here both are exceptions, and the world goes on.

#include <ode/ode.h>

#include "../../physics/stepper.h"
#include "engine_fixture.h"

using namespace spark;
using namespace spark::test;

TEST_CASE("errors and assertions of ODE are exceptions with its text, warnings are not") {
  EngineHost h;
  CHECK_THROWS_WITH(dDebug(7, "a %s does not hold", "rule"), "ODE failed: a rule does not hold (ODE message 7)");
  CHECK_THROWS_WITH(dError(8, "no room"), "ODE failed: no room (ODE message 8)");
  CHECK_NOTHROW(dMessage(9, "a remark"));
}

TEST_CASE("an island on which ODE fails is put back, at rest; the others move on") {
  EngineHost h;
  h.setGravity(10);
  const physics::BodyHandle upper = h.body({0, 0, 5}), lower = h.body({0, 0, 4}), other = h.body({9, 0, 5});
  const physics::JointHandle j = h.world.createJoint(engine::JointType::universal);
  h.world.attach(j, upper, lower);
  h.world.setAnchor(j, {0, 0, 4.5});
  h.world.setAxis(j, 0, Vec3::UnitX(), 1);
  h.world.setAxis(j, 1, Vec3::UnitY(), 2);
  h.step();
  const Vec3 before = h.position(upper);
  // Parallel axes have no perpendicular direction.
  Mat3 yToX;
  yToX << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  h.world.setRotation(lower, yToX);
  for (int i = 0; i < 3; ++i) h.step();
  CHECK(h.position(upper) == before);
  CHECK(h.world.state(upper).linearVelocity.isZero(0));
  CHECK(getProperty(h.engine.leaf(), "messages").toInteger() >= 1);
  CHECK(h.position(other).z() < before.z());
}
