#include "geom_mass.h"

#include "api/mass.h"

namespace spark::mjcf {

using engine::Shape;
using engine::ShapeDescription;

namespace {

/// Of density 1 (Eberly, "Polyhedral Mass Properties", 2002, as sums over tetrahedra from the origin).
engine::Mass meshVolume(const engine::Mesh& s) {
  double volume = 0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();  // integral of x x^T
  for (std::size_t t = 0; t + 2 < s.triangles.size(); t += 3) {
    Mat3 corners;
    for (int i = 0; i < 3; ++i) corners.col(i) = s.vertex(s.triangles[t + static_cast<std::size_t>(i)]);
    const double det = corners.determinant();
    const Vec3 sum = corners.rowwise().sum();
    volume += det / 6;
    first += det / 24 * sum;
    second += det / 120 * (corners * corners.transpose() + sum * sum.transpose());
  }
  if (volume < 0) volume = -volume, first = -first, second = -second;
  if (!(volume > 0)) return {0, Vec3::Zero(), Mat3::Zero()};
  const Vec3 center = first / volume;
  second -= volume * center * center.transpose();
  return {volume, center, Mat3(second.trace() * Mat3::Identity() - second)};
}

}  // namespace

engine::Mass meshMass(const engine::Mesh& mesh, const Weight& weight, const Element& geom) {
  engine::Mass m = meshVolume(mesh);
  if (!(m.mass > 0)) throw geom.error("the mesh has no volume");
  const double factor = weight.of(m.mass) / m.mass;
  m.mass *= factor;
  m.inertia *= factor;
  return m;
}

engine::Mass shapeMass(const ShapeDescription& s, const Weight& weight, const Element& geom) {
  switch (s.shape) {
    case Shape::box:
      return physics::boxMass(weight.of(physics::boxVolume(s.lengths)), s.lengths);
    case Shape::sphere:
      return physics::sphereMass(weight.of(physics::sphereVolume(s.radius)), s.radius);
    case Shape::capsule:
      return physics::capsuleMass(weight.of(physics::capsuleVolume(s.radius, s.length)), s.radius, s.length);
    case Shape::cylinder:
      return physics::cylinderMass(weight.of(physics::cylinderVolume(s.radius, s.length)), s.radius, s.length);
    default:
      return meshMass(*s.mesh, weight, geom);
  }
}

engine::Mass ellipsoidMass(const Vec3& halfAxes, const Weight& weight) {
  const Vec3 squares = halfAxes.cwiseProduct(halfAxes);
  const double mass = weight.of(4.0 / 3.0 * kPi * halfAxes.prod());
  const Vec3 moments = mass / 5 * (Vec3::Constant(squares.sum()) - squares);
  return {mass, Vec3::Zero(), Mat3(moments.asDiagonal())};
}

engine::Mass moved(const engine::Mass& m, const Pose& at) {
  return {m.mass, at.position + at.rotation * m.center, at.rotation * m.inertia * at.rotation.transpose()};
}

}  // namespace spark::mjcf
