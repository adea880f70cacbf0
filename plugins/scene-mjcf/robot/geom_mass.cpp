#include "geom_mass.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "api/mass.h"

namespace spark::mjcf {

using engine::Shape;
using engine::ShapeDescription;

namespace {

Mat3 cornersOf(const engine::Mesh& m, std::size_t triangle) {
  Mat3 out;
  for (int i = 0; i < 3; ++i) out.col(i) = m.vertex(m.triangles[3 * triangle + static_cast<std::size_t>(i)]);
  return out;
}

/// The mean of the triangles, each with the weight of its area.
Vec3 middleOf(const engine::Mesh& m) {
  double area = 0;
  Vec3 sum = Vec3::Zero();
  for (std::size_t t = 0; t < m.triangles.size() / 3; ++t) {
    const Mat3 c = cornersOf(m, t);
    const double own = (c.col(1) - c.col(0)).cross(c.col(2) - c.col(0)).norm() / 2;
    area += own;
    sum += own / 3 * c.rowwise().sum();
  }
  return area > 0 ? Vec3(sum / area) : sum;
}

/// Integrals over a mesh of density 1.
struct Sums {
  double volume = 0;
  Vec3 first = Vec3::Zero();   ///< of x - origin
  Mat3 second = Mat3::Zero();  ///< of (x - origin) (x - origin)^T
};

/// As sums over tetrahedra from `origin` to the triangles (Eberly, "Polyhedral Mass Properties", 2002). `positive`:
/// each counts as it is, not less where the triangle looks at the origin.
Sums solidSums(const engine::Mesh& m, const Vec3& origin, bool positive) {
  Sums s;
  for (std::size_t t = 0; t < m.triangles.size() / 3; ++t) {
    const Mat3 c = cornersOf(m, t).colwise() - origin;
    const double det = positive ? std::abs(c.determinant()) : c.determinant();
    const Vec3 sum = c.rowwise().sum();
    s.volume += det / 6;
    s.first += det / 24 * sum;
    s.second += det / 120 * (c * c.transpose() + sum * sum.transpose());
  }
  return s;
}

/// Of the triangles alone; the volume is their area.
Sums shellSums(const engine::Mesh& m) {
  Sums s;
  for (std::size_t t = 0; t < m.triangles.size() / 3; ++t) {
    const Mat3 c = cornersOf(m, t);
    const double area = (c.col(1) - c.col(0)).cross(c.col(2) - c.col(0)).norm() / 2;
    const Vec3 sum = c.rowwise().sum();
    s.volume += area;
    s.first += area / 3 * sum;
    s.second += area / 12 * (c * c.transpose() + sum * sum.transpose());
  }
  return s;
}

/// `origin`: that of the sums.
engine::Mass massOf(Sums s, const Vec3& origin) {
  if (s.volume < 0) s = {-s.volume, -s.first, -s.second};
  if (!(s.volume > 0)) return {0, Vec3::Zero(), Mat3::Zero()};
  const Vec3 center = s.first / s.volume;
  s.second -= s.volume * center * center.transpose();
  return {s.volume, origin + center, Mat3(s.second.trace() * Mat3::Identity() - s.second)};
}

/// The volume of the box with the inertia of `m`.
double boxVolume(const engine::Mass& m) {
  double squares = 1;
  const Vec3 moments = Eigen::SelfAdjointEigenSolver<Mat3>(m.inertia, Eigen::EigenvaluesOnly).eigenvalues();
  for (const double moment : moments) squares *= std::max(0.0, 6 * (moments.sum() - 2 * moment) / m.mass);
  return std::sqrt(squares);
}

/// Of density 1.
engine::Mass meshVolume(const engine::Mesh& mesh, MeshInertia inertia) {
  if (inertia == MeshInertia::exact) return massOf(solidSums(mesh, Vec3::Zero(), false), Vec3::Zero());
  if (inertia == MeshInertia::shell) return massOf(shellSums(mesh), Vec3::Zero());
  // The centre is that of the solid as seen from the middle of its surface; all else is as seen from that centre.
  const Vec3 middle = middleOf(mesh);
  const Sums fromMiddle = solidSums(mesh, middle, true);
  if (!(fromMiddle.volume > 0)) return {0, Vec3::Zero(), Mat3::Zero()};
  const Vec3 center = middle + fromMiddle.first / fromMiddle.volume;
  const Sums s = solidSums(mesh, center, true);
  engine::Mass out{s.volume, center, Mat3(s.second.trace() * Mat3::Identity() - s.second)};
  if (inertia == MeshInertia::legacy || !(s.volume > 0)) return out;
  const double volume = boxVolume(out);
  out.inertia *= volume / out.mass;
  out.mass = volume;
  return out;
}

}  // namespace

bool hasVolume(const engine::Mesh& mesh, MeshInertia inertia) { return meshVolume(mesh, inertia).mass > 0; }

engine::Mass meshMass(const engine::Mesh& mesh, const Weight& weight, const Element& geom, MeshInertia inertia) {
  engine::Mass m = meshVolume(mesh, inertia);
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
    case Shape::mesh:
      if (engine::Mass unit = meshVolume(*s.mesh, MeshInertia::exact); !(unit.mass > 0)) return unit;  // flat
      [[fallthrough]];
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
