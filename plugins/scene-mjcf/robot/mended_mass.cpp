#include "mended_mass.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "api/mass.h"

namespace spark::mjcf {

namespace {
constexpr double kLightMass = 0.01, kLightRadius = 0.01;  // kg, m
constexpr double kWater = 1000;                           // kg/m^3
// Moments below these are what rounding leaves, or too small for engines.
constexpr double kLeastRatio = 1e-9;    // of the largest moment
constexpr double kLeastRadius = 1e-5;   // m, of gyration
constexpr double kLeastMoment = 1e-14;  // kg m^2
}  // namespace

engine::Mass sphereOfWater(double mass) { return physics::sphereMass(mass, std::cbrt(0.75 * mass / (kWater * M_PI))); }

void balanceInertia(engine::Mass& mass, const Element& from, const std::string& what, Unsupported& unsupported) {
  const Vec3 moments = Eigen::SelfAdjointEigenSolver<Mat3>(mass.inertia, Eigen::EigenvaluesOnly).eigenvalues();
  if (moments.x() + moments.y() >= moments.z() * (1 - 1e-9)) return;
  unsupported.add(from, what + " with moments of inertia that no body can have gets their mean about each axis");
  mass.inertia = moments.mean() * Mat3::Identity();
}

void mendInertia(engine::Mass& mass, const Element& from, const std::string& what, Unsupported& unsupported) {
  const Vec3 moments = Eigen::SelfAdjointEigenSolver<Mat3>(mass.inertia, Eigen::EigenvaluesOnly).eigenvalues();
  const double least = std::max({kLeastMoment, kLeastRatio * moments.z(), kLeastRadius * kLeastRadius * mass.mass});
  if (!(moments.x() > least)) {
    unsupported.add(from, what + " with moments of inertia that are not above 0 gets those of a sphere of water");
    mass.inertia = sphereOfWater(mass.mass).inertia;
  } else {
    balanceInertia(mass, from, what, unsupported);
  }
}

void weighLightBodies(Model& model, const std::string& what, double least, Unsupported& unsupported) {
  std::vector<double> masses(model.bodies.size(), 0.0);  // of what is fixed to a body that moves
  std::vector<std::size_t> carrier(model.bodies.size(), 0);
  for (std::size_t i = 1; i < model.bodies.size(); ++i) {
    const Body& b = model.bodies[i];
    carrier[i] = b.joints.empty() ? carrier[static_cast<std::size_t>(b.parent)] : i;
    masses[carrier[i]] += b.mass.mass;
  }
  for (std::size_t i = 1; i < model.bodies.size(); ++i) {
    Body& b = model.bodies[i];
    if (carrier[i] != i || masses[i] > least) continue;
    unsupported.add(b.from, fmt::format("{} that moves and has {} mass gets {} g", what,
                                        masses[i] > 0 ? "next to no" : "no", 1000 * kLightMass));
    b.mass = physics::sphereMass(kLightMass, kLightRadius);
  }
}

}  // namespace spark::mjcf
