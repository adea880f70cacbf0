#include "mass_reader.h"

#include <fmt/format.h>

#include <cmath>

#include "api/mass.h"
#include "robot/mended_mass.h"

namespace spark::webots {

namespace {

constexpr double kWater = 1000;  ///< kg/m^3

/// One vector, or none.
std::optional<Vec3> centreOf(Fields& f) {
  const std::vector<double>* const v = f.numbers("centerOfMass");
  if (!v) return std::nullopt;
  if (v->size() != 3) {
    f.wrong("centerOfMass",
            fmt::format("expected one vector for 'centerOfMass', found {} numbers; it is ignored", v->size()));
    return std::nullopt;
  }
  return Vec3((*v)[0], (*v)[1], (*v)[2]);
}

/// Two vectors, moments and products of inertia, or none.
std::optional<Mat3> inertiaOf(Fields& f) {
  const std::vector<double>* const v = f.numbers("inertiaMatrix");
  if (!v) return std::nullopt;
  if (v->size() != 6) {
    f.wrong("inertiaMatrix",
            fmt::format("expected two vectors for 'inertiaMatrix', found {} numbers; it is ignored", v->size()));
    return std::nullopt;
  }
  const std::vector<double>& i = *v;
  Mat3 out;
  out << i[0], i[3], i[4], i[3], i[1], i[5], i[4], i[5], i[2];
  return out;
}

}  // namespace

std::optional<double> densityOf(const Node* physics, mjcf::Unsupported& unsupported) {
  if (!physics) return std::nullopt;
  Fields f(*physics, unsupported);
  const bool isGiven = f.number("mass", -1) >= 0 && f.has("centerOfMass") && f.has("inertiaMatrix");
  const double density = f.number("density", kWater);
  if (isGiven) return std::nullopt;
  return density > 0 ? density : kWater;
}

engine::Mass massOf(const Node* physics, const mjcf::Body& body, mjcf::Unsupported& unsupported) {
  engine::Mass sum{0, Vec3::Zero(), Mat3::Zero()};
  if (!physics) return sum;
  Fields f(*physics, unsupported);
  f.ignore({"density"});
  for (const mjcf::Geom& g : body.geoms)
    if (g.mass) sum = physics::together(sum, *g.mass);
  double given = f.number("mass", -1);
  if (given != -1 && !(given >= 0)) {
    f.wrong("mass", fmt::format("expected a mass of 0 or more, or -1, found {}; it is ignored", given));
    given = -1;
  }
  const auto centre = centreOf(f);
  auto inertia = inertiaOf(f);
  if (f.has("damping")) unsupported.add(physics->element(), "the damping of a Physics is not supported");
  f.finish();
  if (inertia && given < 0) {
    f.wrong("inertiaMatrix", "expected a 'mass' beside 'inertiaMatrix', which is ignored");
    inertia.reset();
  }
  if (given >= 0) {
    if (sum.mass > 0)
      sum.inertia *= given / sum.mass;
    else if (!inertia && given > 0)
      unsupported.add(physics->element(), "a Physics with a mass and no volume has the inertia of a sphere of water");
    if (!(sum.mass > 0) && given > 0)
      sum.inertia = physics::sphereMass(given, std::cbrt(0.75 * given / (kWater * M_PI))).inertia;
    sum.mass = given;
  }
  if (centre) sum.center = *centre;
  if (inertia) sum.inertia = *inertia;
  if (!std::isfinite(sum.mass) || !sum.center.allFinite() || !sum.inertia.allFinite()) {
    unsupported.add(physics->element(), "expected a mass and an inertia of finite numbers; they are ignored");
    return {0, Vec3::Zero(), Mat3::Zero()};
  }
  if (sum.mass > 0) mjcf::mendInertia(sum, physics->element(), "a Physics", unsupported);
  return sum;
}

}  // namespace spark::webots
