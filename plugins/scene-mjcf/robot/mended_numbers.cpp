#include "mended_numbers.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "mended_mass.h"

namespace spark::mjcf {

namespace {

bool isIn(double v, const Range& range) { return v >= range.least && v <= range.most; }
bool isIn(const Vec3& v, const Range& range) {
  return std::all_of(v.begin(), v.end(), [&](double x) { return isIn(x, range); });
}

bool isInertia(const Mat3& inertia) {
  if (!inertia.allFinite() || Eigen::LLT<Mat3>(inertia).info() != Eigen::Success) return false;
  const double most = inertia.cwiseAbs().maxCoeff(), least = 1 / inertia.inverse().cwiseAbs().maxCoeff();
  return least >= kMoments.least && most <= kMoments.most;
}

/// True for what a part of a body may have.
bool isBounded(const engine::Mass& m) {
  return isIn(m.mass, {0, kMasses.most}) && isIn(m.center, kPlaces) && m.inertia.allFinite() &&
         m.inertia.cwiseAbs().maxCoeff() <= kMoments.most;
}

/// Mends the numbers of one element.
class Mender {
 public:
  Mender(const Element& from, Unsupported& unsupported) : from_(from), unsupported_(unsupported) {}
  /// Takes the nearest number in the range; that of NaN is the nearest one to 0.
  void nearest(const char* what, double& v, const Range& range) {
    if (isIn(v, range)) return;
    const double found = v;
    v = std::clamp(std::isnan(v) ? 0.0 : v, range.least, range.most);
    say(fmt::format("{} of {:g} is taken as {:g}", what, found, v), range);
  }
  /// The same of one that may be infinite.
  void bound(const char* what, double& v, const Range& range) {
    if (!std::isinf(v)) nearest(what, v, range);
  }
  /// Ignores a place with a coordinate that is out of range.
  void place(const char* what, Vec3& v) {
    if (isIn(v, kPlaces)) return;
    say(fmt::format("{} at {:g} {:g} {:g} m is ignored", what, v.x(), v.y(), v.z()), kPlaces);
    v.setZero();
  }

 private:
  void say(const std::string& what, const Range& range) {
    unsupported_.add(from_, fmt::format("{}, {}: expected {:g} to {:g}", from_.named(), what, range.least, range.most));
  }
  const Element& from_;
  Unsupported& unsupported_;
};

void mendJoint(Joint& j, Unsupported& unsupported) {
  Mender m(j.from, unsupported);
  m.place("an anchor", j.position);
  if (j.limited)
    for (double& v : j.range) m.bound("a limit", v, kCoordinates);
  m.nearest("a reference", j.reference, kCoordinates);
  m.nearest("an armature", j.armature, kCoefficients);
  m.nearest("a damping", j.damping, j.kind == JointKind::free ? kBodyDamping : kCoefficients);
  m.nearest("a dry friction", j.dryFriction, kCoefficients);
  m.nearest("a stiffness", j.stiffness, kCoefficients);
  m.nearest("a spring's place", j.springPosition, kCoordinates);
  m.bound("a bound of force", j.maxForce, kCoefficients);
}

void mendActuator(Actuator& a, Unsupported& unsupported) {
  Mender m(a.from, unsupported);
  m.nearest("a gear", a.gear, kGains);
  for (double& v : a.gain) m.nearest("a gain", v, kGains);
  for (double& v : a.bias) m.nearest("a bias", v, kGains);
  for (double& v : a.controlRange) m.bound("a bound of the control", v, kGains);
  for (double& v : a.forceRange) m.bound("a bound of force", v, kGains);
  for (double& v : a.engine.gear) m.nearest("a gear", v, kGains);
  for (double& v : a.engine.gain) m.nearest("a gain", v, kGains);
  for (double& v : a.engine.bias) m.nearest("a bias", v, kGains);
}

}  // namespace

bool isUsable(const engine::Mass& mass) {
  return isIn(mass.mass, kMasses) && isIn(mass.center, kPlaces) && isInertia(mass.inertia);
}

void mendMass(engine::Mass& mass, const Element& from, Unsupported& unsupported) {
  Mender m(from, unsupported);
  m.place("a centre of mass", mass.center);
  m.nearest("a mass", mass.mass, kMasses);
  if (isInertia(mass.inertia)) return;
  unsupported.add(from, from.named() +
                            " has moments of inertia that no body can have: it gets those of a sphere of "
                            "water");
  mass.inertia = sphereOfWater(mass.mass).inertia;
}

void mendMass(Geom& g, Unsupported& unsupported) {
  if (!g.mass || g.mass->mass == 0 || isBounded(*g.mass)) return;
  engine::Mass& m = *g.mass;
  const auto say = [&](const std::string& what) { unsupported.add(g.from, g.from.named() + what); };
  const std::string most = fmt::format("expected at most {:g} kg and {:g} kg m^2", kMasses.most, kMoments.most);
  if (!std::isfinite(m.mass) || !m.inertia.allFinite()) {
    say(fmt::format(" adds no mass to its body: {}, found {:g} kg and no finite inertia", most, m.mass));
    g.mass.reset();
  } else if (!isIn(m.center, kPlaces)) {
    say(fmt::format(" adds no mass to its body: expected a place at most {:g} m away, found {:g} {:g} {:g} m",
                    kPlaces.most, m.center.x(), m.center.y(), m.center.z()));
    g.mass.reset();
  } else {
    const double found = m.mass, moment = m.inertia.cwiseAbs().maxCoeff();
    const double factor = std::min(kMasses.most / found, kMoments.most / moment);
    m.mass *= factor;
    m.inertia *= factor;
    say(fmt::format(", a mass of {:g} kg is taken as {:g} kg: {}, found {:g} kg m^2", found, m.mass, most, moment));
  }
}

void mendNumbers(Model& model, Unsupported& unsupported) {
  for (std::size_t i = 1; i < model.bodies.size(); ++i) {
    Body& b = model.bodies[i];
    Mender(b.from, unsupported).place("its place", b.pose.position);
    // What is fixed to a body may have an inertia of 0, and little mass. Where nothing is, does not matter.
    if (b.mass.mass == 0 && !isIn(b.mass.center, kPlaces)) b.mass.center.setZero();
    if (!isBounded(b.mass)) mendMass(b.mass, b.from, unsupported);
    for (Joint& j : b.joints) mendJoint(j, unsupported);
  }
  for (Actuator& a : model.actuators) mendActuator(a, unsupported);
}

}  // namespace spark::mjcf
