#include "api/mass.h"

#include <catch2/catch.hpp>

using namespace spark;
using namespace spark::physics;

namespace {

/// Mass and inertia of a solid as a sum over small cubes.
template <class Inside>
engine::Mass sum(double density, const Vec3& half, Inside inside) {
  constexpr int n = 60;
  engine::Mass m{0, Vec3::Zero(), Mat3::Zero()};
  const Vec3 cell = 2 * half / n;
  const double dm = density * cell.prod();
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) {
        const Vec3 p = -half + Vec3((i + 0.5) * cell.x(), (j + 0.5) * cell.y(), (k + 0.5) * cell.z());
        if (!inside(p)) continue;
        m.mass += dm;
        m.inertia += dm * (p.squaredNorm() * Mat3::Identity() - p * p.transpose());
      }
  return m;
}

void checkNear(const engine::Mass& a, const engine::Mass& b, double part) {
  CHECK(a.mass == Approx(b.mass).epsilon(part));
  for (int i = 0; i < 3; ++i) CHECK(a.inertia(i, i) == Approx(b.inertia(i, i)).epsilon(part));
  CHECK(std::abs(a.inertia(0, 1)) < 1e-9);
}

}  // namespace

TEST_CASE("mass: solids have the mass and inertia that integration over their volume gives") {
  const double density = 700;
  const Vec3 edges(0.2, 0.4, 0.6);
  checkNear(boxMass(density * boxVolume(edges), edges), sum(density, edges / 2, [](const Vec3&) { return true; }),
            0.002);
  checkNear(sphereMass(density * sphereVolume(0.3), 0.3),
            sum(density, Vec3::Constant(0.3), [](const Vec3& p) { return p.norm() < 0.3; }), 0.01);
  checkNear(cylinderMass(density * cylinderVolume(0.2, 0.5), 0.2, 0.5),
            sum(density, {0.2, 0.2, 0.25}, [](const Vec3& p) { return std::hypot(p.x(), p.y()) < 0.2; }), 0.01);
  checkNear(capsuleMass(density * capsuleVolume(0.2, 0.5), 0.2, 0.5),
            sum(density, {0.2, 0.2, 0.45},
                [](const Vec3& p) {
                  return std::hypot(std::hypot(p.x(), p.y()), std::max(0.0, std::abs(p.z()) - 0.25)) < 0.2;
                }),
            0.01);
}

TEST_CASE("mass: a ball has an inertia of 2/5 m r^2") {
  const engine::Mass m = sphereMass(0.026, 0.042);
  CHECK(m.mass == 0.026);
  CHECK(m.inertia(1, 1) == Approx(0.4 * 0.026 * 0.042 * 0.042));
}

TEST_CASE("mass: two halves of a box have the mass and inertia of the box") {
  const engine::Mass half = boxMass(3, {0.5, 0.3, 0.2});
  engine::Mass whole{0, Vec3::Zero(), Mat3::Zero()};
  whole = addMass(whole, half, {Vec3(-0.25, 0, 0), Mat3::Identity()});
  whole = addMass(whole, half, {Vec3(0.25, 0, 0), Mat3::Identity()});
  CHECK(whole.center.norm() < 1e-12);
  const engine::Mass box = boxMass(6, {1, 0.3, 0.2});
  CHECK(whole.mass == box.mass);
  CHECK(whole.inertia.isApprox(box.inertia, 1e-12));
}

TEST_CASE("mass: centring removes the contribution of the center's offset") {
  const engine::Mass part = boxMass(2, {0.1, 0.2, 0.3});
  Mat3 turned;
  turned << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  const engine::Mass away = addMass({0, Vec3::Zero(), Mat3::Zero()}, part, {Vec3(1, 2, 3), turned});
  CHECK(away.center.isApprox(Vec3(1, 2, 3)));
  const engine::Mass back = centred(away);
  CHECK(back.center.isZero(0));
  CHECK(back.inertia(0, 0) == Approx(part.inertia(1, 1)));
  CHECK(back.inertia(1, 1) == Approx(part.inertia(0, 0)));
  CHECK(back.inertia(2, 2) == Approx(part.inertia(2, 2)));
}
