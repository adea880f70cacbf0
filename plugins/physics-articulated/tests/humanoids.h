#pragma once
/// \file
/// Humanoids of 23 bodies and 22 motorised hinges, some 4.5 kg and 0.55 m, and what they may be doing.

#include "twins.h"

namespace spark::test {

struct Humanoids {
  Twins& twins;
  std::vector<std::size_t> joints;

  explicit Humanoids(Twins& t) : twins(t) {}

  /// One with its feet at `feet`.
  void add(const Vec3& feet) {
    at_ = feet;
    twins.newSpace();
    const std::size_t torso = part(-1, {0, 0, 0.37}, {0.09, 0.14, 0.16}, 1.2, {}, {});
    const std::size_t neck = part(torso, {0, 0, 0.47}, {0.03, 0.03, 0.06}, 0.05, {0, 0, 0.45}, {0, 0, 1});
    part(neck, {0, 0, 0.53}, {0.12, 0.12, 0.11}, 0.35, {0, 0, 0.48}, {0, 1, 0});
    for (const double side : {-1.0, 1.0}) {
      std::size_t arm =
          part(torso, {0, 0.098 * side, 0.42}, {0.05, 0.05, 0.05}, 0.07, {0, 0.09 * side, 0.42}, {0, 1, 0});
      arm = part(arm, {0.02, 0.108 * side, 0.42}, {0.08, 0.05, 0.06}, 0.15, {0, 0.1 * side, 0.42}, {0, 0, 1});
      arm = part(arm, {0.09, 0.108 * side, 0.425}, {0.04, 0.04, 0.04}, 0.04, {0.09, 0.108 * side, 0.42}, {1, 0, 0});
      part(arm, {0.14, 0.108 * side, 0.42}, {0.1, 0.05, 0.05}, 0.1, {0.09, 0.108 * side, 0.42}, {0, 0, 1});
      std::size_t leg = part(torso, {0, 0.055 * side, 0.285}, {0.05, 0.05, 0.05}, 0.09, {0, 0.055 * side, 0.285},
                             {-0.7, 0.7 * side, 0});
      leg = part(leg, {0, 0.055 * side, 0.28}, {0.05, 0.05, 0.05}, 0.12, {0, 0.055 * side, 0.28}, {1, 0, 0});
      leg = part(leg, {0.01, 0.055 * side, 0.22}, {0.07, 0.07, 0.12}, 0.3, {0, 0.055 * side, 0.28}, {0, 1, 0});
      leg = part(leg, {0.005, 0.055 * side, 0.11}, {0.07, 0.07, 0.1}, 0.25, {0, 0.055 * side, 0.165}, {0, 1, 0});
      leg = part(leg, {0, 0.055 * side, 0.05}, {0.05, 0.05, 0.05}, 0.12, {0, 0.055 * side, 0.05}, {0, 1, 0});
      part(leg, {0.03, 0.055 * side, 0.02}, {0.16, 0.08, 0.04}, 0.2, {0, 0.055 * side, 0.05}, {1, 0, 0});
    }
  }

  /// Motors of all joints: speed of joint number j of its robot [rad/s], and strength [Nm].
  template <class F>
  void drive(Scene& scene, F&& speed, double strength) {
    for (std::size_t i = 0; i < joints.size(); ++i) {
      scene.engine.setParameter(scene.joints[joints[i]], engine::JointParameter::velocity, 0, speed(i));
      scene.engine.setParameter(scene.joints[joints[i]], engine::JointParameter::maxForce, 0, strength);
    }
  }

 private:
  std::size_t part(int parent, const Vec3& at, const Vec3& lengths, double mass, const Vec3& anchor, const Vec3& axis) {
    const Vec3 squares = lengths.cwiseProduct(lengths);
    const Mat3 inertia =
        (mass / 12 * Vec3(squares.y() + squares.z(), squares.x() + squares.z(), squares.x() + squares.y()))
            .asDiagonal();
    const std::size_t body = twins.body(at_ + at, mass, inertia);
    // Hands and what is inside touches nothing.
    if (lengths.minCoeff() > 0.05 || lengths.x() >= 0.1 || parent < 0) twins.box(lengths, body);
    if (parent < 0) return body;
    const std::size_t joint = twins.joint(engine::JointType::hinge, parent, static_cast<int>(body), false);
    twins.eachJoint(joint, [&](engine::IEngine& e, engine::Joint j) {
      e.setAnchor(j, at_ + anchor);
      e.setAxis(j, 0, axis);
    });
    twins.set(joint, engine::JointParameter::lowStop, 0, -1.2);
    twins.set(joint, engine::JointParameter::highStop, 0, 1.2);
    twins.set(joint, engine::JointParameter::maxForce, 0, 25);
    joints.push_back(joint);
    return body;
  }
  std::size_t part(std::size_t parent, const Vec3& at, const Vec3& lengths, double mass, const Vec3& anchor,
                   const Vec3& axis) {
    return part(static_cast<int>(parent), at, lengths, mass, anchor, axis);
  }
  Vec3 at_ = Vec3::Zero();
};

}  // namespace spark::test
