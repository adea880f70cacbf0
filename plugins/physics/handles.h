#pragma once
/// \file
/// Shared ownership of worlds and spaces: the tree may remove their nodes before the bodies and colliders in them.

#include <memory>

#include "api/physics.h"
#include "world_model.h"

namespace spark::physics {

/// A collision space. Shared by all that is in it, and destroyed with the last of them.
class SharedSpace {
 public:
  /// Creates the space. `parent` nullptr: a top-level space.
  SharedSpace(std::shared_ptr<WorldModel> world, std::shared_ptr<SharedSpace> parent)
      : world_(std::move(world)),
        parent_(std::move(parent)),
        handle_(world_->createSpace(parent_ ? parent_->handle() : SpaceHandle::none)) {}
  ~SharedSpace() { world_->destroySpace(handle_); }
  SharedSpace(const SharedSpace&) = delete;
  SharedSpace& operator=(const SharedSpace&) = delete;
  SpaceHandle handle() const { return handle_; }
  const std::shared_ptr<WorldModel>& world() const { return world_; }

 private:
  std::shared_ptr<WorldModel> world_;
  std::shared_ptr<SharedSpace> parent_;
  SpaceHandle handle_;
};

/// The current world pose of the nearest transform above a node; identity without one.
inline Pose frameOf(const SceneNode& node) { return node.transform() ? toPose(node.transform()->worldNow()) : Pose{}; }

/// A pose as a position and the nine numbers of its rotation, row by row. Throws Error unless they are finite and nine.
inline Pose poseOfNumbers(const Leaf& node, const Vec3& position, const std::vector<double>& rotation) {
  if (rotation.size() != 9)
    throw Error(fmt::format("{}: expected 9 numbers of a rotation, found {}", node.path(), rotation.size()));
  const Mat3 matrix = Eigen::Map<const Mat3>(rotation.data()).transpose();
  if (!position.allFinite() || !(matrix.cwiseAbs().maxCoeff() <= 2))
    throw RefusedValue(fmt::format("{}: expected the finite numbers of a pose", node.path()));
  return {position, matrix};
}
/// The same numbers of a pose.
inline List numbersOfPose(const Pose& pose) {
  List out{pose.position.x(), pose.position.y(), pose.position.z()};
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) out.emplace_back(pose.rotation(row, column));
  return out;
}
/// A pose from 6 numbers (position [m], rotation [deg]) or 16 (a column-major matrix); identity from none. Throws Error
/// for another number of numbers, or when one is not finite.
Pose poseFrom(const std::vector<double>& numbers);

}  // namespace spark::physics
