#pragma once
/// \file
/// Humanoids with 23 bodies, 22 motorized hinges, a mass of about 4.5 kg and a height of 0.55 m.

#include "twins.h"

namespace spark::test {

/// The humanoids of a scene.
struct Humanoids {
  Twins& twins;
  std::vector<std::size_t> joints;  ///< of all humanoids, as indices in Scene::joints

  explicit Humanoids(Twins& t) : twins(t) {}

  /// Adds a humanoid with its feet at `feet` [m].
  void add(const Vec3& feet) {
    origin_ = feet;
    twins.newSpace();
    const std::size_t torso = addLink(-1, {0, 0, 0.37}, {0.09, 0.14, 0.16}, 1.2, {}, {});
    const std::size_t neck = addLink(torso, {0, 0, 0.47}, {0.03, 0.03, 0.06}, 0.05, {0, 0, 0.45}, {0, 0, 1});
    addLink(neck, {0, 0, 0.53}, {0.12, 0.12, 0.11}, 0.35, {0, 0, 0.48}, {0, 1, 0});
    for (const double side : {-1.0, 1.0}) {
      std::size_t arm =
          addLink(torso, {0, 0.098 * side, 0.42}, {0.05, 0.05, 0.05}, 0.07, {0, 0.09 * side, 0.42}, {0, 1, 0});
      arm = addLink(arm, {0.02, 0.108 * side, 0.42}, {0.08, 0.05, 0.06}, 0.15, {0, 0.1 * side, 0.42}, {0, 0, 1});
      arm = addLink(arm, {0.09, 0.108 * side, 0.425}, {0.04, 0.04, 0.04}, 0.04, {0.09, 0.108 * side, 0.42}, {1, 0, 0});
      addLink(arm, {0.14, 0.108 * side, 0.42}, {0.1, 0.05, 0.05}, 0.1, {0.09, 0.108 * side, 0.42}, {0, 0, 1});
      std::size_t leg = addLink(torso, {0, 0.055 * side, 0.285}, {0.05, 0.05, 0.05}, 0.09, {0, 0.055 * side, 0.285},
                                {-0.7, 0.7 * side, 0});
      leg = addLink(leg, {0, 0.055 * side, 0.28}, {0.05, 0.05, 0.05}, 0.12, {0, 0.055 * side, 0.28}, {1, 0, 0});
      leg = addLink(leg, {0.01, 0.055 * side, 0.22}, {0.07, 0.07, 0.12}, 0.3, {0, 0.055 * side, 0.28}, {0, 1, 0});
      leg = addLink(leg, {0.005, 0.055 * side, 0.11}, {0.07, 0.07, 0.1}, 0.25, {0, 0.055 * side, 0.165}, {0, 1, 0});
      leg = addLink(leg, {0, 0.055 * side, 0.05}, {0.05, 0.05, 0.05}, 0.12, {0, 0.055 * side, 0.05}, {0, 1, 0});
      addLink(leg, {0.03, 0.055 * side, 0.02}, {0.16, 0.08, 0.04}, 0.2, {0, 0.055 * side, 0.05}, {1, 0, 0});
    }
  }

  /// Sets the motors of all joints: the speed of joint i of `joints` to speed(i) [rad/s], and the maximum torque [Nm].
  template <class F>
  void drive(Scene& scene, F&& speed, double maxTorque) {
    for (std::size_t i = 0; i < joints.size(); ++i) {
      scene.world.setParameter(scene.joints[joints[i]], engine::JointParameter::velocity, 0, speed(i));
      scene.world.setParameter(scene.joints[joints[i]], engine::JointParameter::maxForce, 0, maxTorque);
    }
  }

 private:
  /// Adds a box with edge lengths `lengths` [m] at `position`, and the hinge that connects it to `parent`; -1: no
  /// hinge. Positions are relative to origin_.
  std::size_t addLink(int parent, const Vec3& position, const Vec3& lengths, double mass, const Vec3& anchor,
                      const Vec3& axis) {
    const Vec3 squares = lengths.cwiseProduct(lengths);
    const Mat3 inertia =
        (mass / 12 * Vec3(squares.y() + squares.z(), squares.x() + squares.z(), squares.x() + squares.y()))
            .asDiagonal();
    const std::size_t body = twins.body(origin_ + position, mass, inertia);
    // Small links have no geom, because they are inside larger ones.
    if (lengths.minCoeff() > 0.05 || lengths.x() >= 0.1 || parent < 0) twins.box(lengths, body);
    if (parent < 0) return body;
    const std::size_t joint = twins.joint(engine::JointType::hinge, parent, static_cast<int>(body), false);
    twins.forBothJoints(joint, [&](physics::WorldModel& w, physics::JointHandle j) {
      w.setAnchor(j, origin_ + anchor);
      w.setAxis(j, 0, axis);
    });
    twins.set(joint, engine::JointParameter::lowStop, 0, -1.2);
    twins.set(joint, engine::JointParameter::highStop, 0, 1.2);
    twins.set(joint, engine::JointParameter::maxForce, 0, 25);
    joints.push_back(joint);
    return body;
  }
  std::size_t addLink(std::size_t parent, const Vec3& position, const Vec3& lengths, double mass, const Vec3& anchor,
                      const Vec3& axis) {
    return addLink(static_cast<int>(parent), position, lengths, mass, anchor, axis);
  }
  Vec3 origin_ = Vec3::Zero();  ///< of the humanoid that is being added
};

}  // namespace spark::test
