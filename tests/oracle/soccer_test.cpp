#include "agreement.h"
#include "pitch.h"

using namespace spark;
using namespace spark::oracle;

TEST_CASE("humanoids stand as with ODE") {
  Pitch p({{-2, 0}, {-3, 1}});
  const ShadowEngine& shadow = p.watch();
  for (const std::size_t robot : {0, 1}) p.push(robot, {0.05, 0, 0});
  p.run(80);
  expectAgreement("humanoids, standing", shadow.agreement());
}

TEST_CASE("humanoids that move all their motors and fall do so as with ODE") {
  Pitch p({{-2, 0}, {-3, 1}, {-4, -1}});
  const ShadowEngine& shadow = p.watch();
  p.move();
  p.run(200);
  expectAgreement("humanoids, moving", shadow.agreement());
}

TEST_CASE("humanoids with all motors at full speed in changing directions move as with ODE") {
  Pitch p({{-2, 0}, {-3, 1}});
  const ShadowEngine& shadow = p.watch();
  p.move(Pitch::wild);
  p.run(150);
  expectAgreement("humanoids, wild", shadow.agreement());
}

TEST_CASE("humanoids whose motors are too weak for the commanded speeds collapse as with ODE") {
  Pitch p({{-2, 0}, {-3, 1}});
  const ShadowEngine& shadow = p.watch();
  p.weaken(0.6);
  p.move(Pitch::wild);
  p.run(150);
  expectAgreement("humanoids, weak", shadow.agreement());
}

TEST_CASE("humanoids that run into each other and into the ball fall into a heap as with ODE") {
  Pitch p({{-0.4, 0.1}, {-0.4, 0.1}, {-0.8, 0.1}, {-0.4, -0.5}});
  const ShadowEngine& shadow = p.watch();
  p.push(0, {1, 0, 0});
  p.push(1, {-1, 0, 0});
  p.push(2, {1.5, 0, 0});
  p.push(3, {0, -1, 0});
  p.playOn();
  p.ball().setVelocity({1, 0.3, 1});
  p.run(60);
  p.move();
  p.run(100);
  expectAgreement("humanoids, in a heap", shadow.agreement());
}

TEST_CASE("a kicked ball bounces, rolls and hits a robot as with ODE") {
  Pitch p({{-2, 0.05}});
  const ShadowEngine& shadow = p.watch();
  std::vector<IRigidBody*> robot;
  p.robots()[0]->collect(robot);
  REQUIRE_FALSE(robot[0]->enabled());
  p.playOn();
  p.ball().setVelocity({-5, 0, 0.8});
  bool woke = false;
  for (int i = 0; i < 150; ++i) {
    p.run(1);
    woke = woke || robot[0]->enabled();
  }
  CHECK(woke);
  expectAgreement("ball and humanoid", shadow.agreement());
}
