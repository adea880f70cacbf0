#include "heap.h"

#include <Eigen/Geometry>
#include <numbers>
#include <vector>

#include "api/agents.h"
#include "api/physics.h"

namespace spark::bench {

namespace {
using AngleAxis = Eigen::AngleAxis<double>;
constexpr std::size_t kLayer = 2;
constexpr double kReach = 0.08, kFirst = 0.2,
                 kRise = 0.2;  // m: from the axis; height of the first layer; between layers

/// The pose of the i-th robot: lying on the back or the belly, rotated relative to the one before.
Pose poseOf(std::size_t i) {
  using std::numbers::pi;
  const double around = pi * static_cast<double>(i % kLayer) + pi / 2 * static_cast<double>(i / kLayer);
  Pose p;
  p.position = {kReach * std::cos(around), kReach * std::sin(around), kFirst + kRise * static_cast<double>(i / kLayer)};
  p.rotation =
      (AngleAxis(around, Vec3::UnitZ()) * AngleAxis(i % 2 ? pi / 2 : -pi / 2, Vec3::UnitX())).toRotationMatrix();
  return p;
}

void moveTo(const Pose& pose, const std::vector<IRigidBody*>& bodies) {
  const auto torso = bodies.front()->state();
  const Mat3 turn = pose.rotation * torso.rotation.transpose();
  for (IRigidBody* b : bodies) {
    const auto s = b->state();
    b->setPose({pose.position + turn * (s.position - torso.position), turn * s.rotation});
    b->enable();
  }
}
}  // namespace

void pileUp(Kernel& kernel) {
  const auto& agents = kernel.root().require<IGameControl>("/sys/server/gamecontrol").agents();
  for (std::size_t i = 0; i < agents.size(); ++i) {
    std::vector<IRigidBody*> bodies;
    agents[i]->collect(bodies);
    moveTo(poseOf(i), bodies);
  }
}

}  // namespace spark::bench
