#include "oracle_house.h"

using namespace spark;
using namespace spark::oracle;
using test::box;
using test::round;

namespace {

engine::Surface rough(double mu, bool pyramid) {
  engine::Surface s = soft();
  s.mu = mu;
  s.pyramid = pyramid;
  return s;
}

engine::Surface bouncy() {
  engine::Surface s = soft();
  s.bounceOn = true;
  s.bounce = 0.7;
  s.bounceVelocity = 0.1;
  return s;
}

const std::pair<const char*, engine::Surface> kSurfaces[] = {{"hard", {}},
                                                             {"soft", soft()},
                                                             {"bouncy", bouncy()},
                                                             {"little friction", rough(0.6, false)},
                                                             {"pyramid", rough(0.5, true)},
                                                             {"none", rough(0, false)}};

}  // namespace

TEST_CASE("single bodies fall, bounce, slide and come to rest as with ODE") {
  for (const auto& [name, surface] : kSurfaces) {
    OracleHost h;
    h.ground();
    for (int i = 0; i < 4; ++i) {
      const BodyHandle b = h.body({3.0 * i, 0, 0.8});
      const engine::ShapeDescription shapes[] = {box(0.5, 0.4, 0.3), round(Shape::sphere, 0.25),
                                                 round(Shape::capsule, 0.15, 0.3), round(Shape::cylinder, 0.2, 0.3)};
      h.geom(shapes[i], b);
      h.world.setMass(b, {1.5, Vec3::Zero(), Mat3(Vec3(0.03, 0.05, 0.04).asDiagonal())});
      h.world.setRotation(b, Mat3(Eigen::AngleAxisd(0.4, Vec3(1, 2, 3).normalized())));
      h.world.setLinearVelocity(b, {1, 0.5, 0});
    }
    h.run(200, surface);
    expectAgreement(std::string("single bodies, ") + name, h.shadow.agreement());
  }
}

TEST_CASE("many separate boxes fall as with ODE") {
  OracleHost h;
  h.ground();
  for (int i = 0; i < 100; ++i) h.block({i % 10 * 1.0, i / 10 * 1.0, 0.2 + 0.01 * (i % 40)}, {0.3, 0.3, 0.3}, 1);
  h.run(60, soft());
  expectAgreement("100 boxes", h.shadow.agreement());
}

TEST_CASE("a heap of boxes falls and goes to sleep as with ODE") {
  for (const auto& [name, surface] : kSurfaces) {
    OracleHost h;
    h.ground();
    for (int i = 0; i < 12; ++i) {
      const BodyHandle b = h.block({0.13 * (i % 3), 0.17 * (i % 2), 0.4 + 0.4 * i}, {0.5, 0.4, 0.3}, 1 + 0.1 * i);
      h.world.setRotation(b, Mat3(Eigen::AngleAxisd(0.3 * i, Vec3(1, 2, 3).normalized())));
    }
    h.run(150, surface);
    expectAgreement(std::string("heap, ") + name, h.shadow.agreement());
  }
}

TEST_CASE("a ball wakes a row of sleeping boxes as with ODE") {
  OracleHost h;
  h.ground();
  std::vector<BodyHandle> row;
  for (int i = 0; i < 5; ++i) row.push_back(h.block({0.31 * i, 0, 0.1495}, {0.3, 0.3, 0.3}, 1));
  const BodyHandle ball = h.ball({-2, 0, 0.15}, 0.15, 0.5);
  h.run(40, soft());
  REQUIRE_FALSE(h.world.enabled(row[0]));
  h.world.setEnabled(ball, true);
  h.world.setLinearVelocity(ball, {6, 0, 0});
  bool woke = false;
  for (int i = 0; i < 200; ++i) {
    h.run(1, soft());
    woke = woke || h.world.enabled(row[0]);
  }
  CHECK(woke);
  expectAgreement("ball against sleeping boxes", h.shadow.agreement());
}

TEST_CASE("bodies that spin freely without gravity move as with ODE") {
  OracleHost h;
  h.setGravity(0);
  for (int i = 0; i < 5; ++i) {
    const BodyHandle b = h.block({2.0 * i, 0, 0}, {0.9, 0.4, 0.1 + 0.1 * i}, 2, true);
    h.world.setAngularVelocity(b, {3.0 * i, 20 - 5.0 * i, 11});
    h.world.setLinearVelocity(b, {1, 2, 3});
  }
  h.run(200);
  expectAgreement("spinning", h.shadow.agreement());
}

TEST_CASE("external forces and torques act as with ODE, also on a body without gravity") {
  OracleHost h;
  h.ground();
  const BodyHandle a = h.block({0, 0, 0.5}, {0.3, 0.4, 0.5}, 2), b = h.block({3, 0, 1}, {0.5, 0.4, 0.3}, 1);
  h.world.setGravityMode(b, false);
  for (int i = 0; i < 100; ++i) {
    h.world.addForce(a, {3.0 * std::sin(0.1 * i), 1, 25});
    h.world.addTorque(b, {0.3, 0.1, -0.2 * std::cos(0.2 * i)});
    h.run(1, soft());
  }
  expectAgreement("pushed", h.shadow.agreement());
}
