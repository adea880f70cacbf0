#include "mesh_fit.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace spark::mjcf {

EquivalentBox equivalentBox(const engine::Mass& m) {
  // The largest moment belongs to the shortest edge.
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(m.inertia);
  const Vec3 moments = solver.eigenvalues().reverse();
  EquivalentBox box;
  box.pose.position = m.center;
  box.pose.rotation = solver.eigenvectors().rowwise().reverse();
  if (box.pose.rotation.determinant() < 0) box.pose.rotation.col(2) *= -1;
  for (int i = 0; i < 3; ++i) {
    const double sum = moments.sum() - 2 * moments[i];
    box.halfEdges[i] = std::sqrt(std::max(0.0, 6 * sum / m.mass)) / 2;
  }
  return box;
}

Vec3 fittedSize(const std::string& type, const Vec3& e) {
  const double radius = (e[0] + e[1]) / 2;
  if (type == "sphere") return Vec3::Constant(e.mean());
  if (type == "capsule") return {radius, std::max(0.0, e[2] - radius / 2), 0};
  if (type == "cylinder") return {radius, e[2], 0};
  return e;
}

}  // namespace spark::mjcf
