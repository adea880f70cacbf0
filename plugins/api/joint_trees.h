#pragma once
/// \file
/// The trees that joints make of the bodies of a model, for engines in coordinates of joints.

#include <Eigen/Geometry>
#include <vector>

#include "api/model.h"
#include "spark/abi/api/joint_trees.h"

namespace spark::engine {

namespace detail {
inline Mat3 rotationWhenSet(const std::array<double, 4>& q) {
  // All zeros: a fixed joint that was never set.
  return q == std::array<double, 4>{} ? Mat3(Mat3::Identity()) : rotationOf(q);
}

/// The rotation of body b in body a where the coordinates of a wheel are 0.
inline Mat3 zeroOfWheel(const Joint& j) {
  // The axes as columns, in a and in b.
  Mat3 inA, inB;
  const Vec3 axis2InA = j.cosAxes * j.inA.axis[0] + j.sinAxes * j.inA.axis[1];
  const Vec3 axis1InB = j.cosAxes * j.inB.axis[1] + j.sinAxes * j.inB.axis[0];
  inA << j.inA.axis[0], axis2InA, j.inA.axis[0].cross(axis2InA);
  inB << axis1InB, j.inB.axis[1], axis1InB.cross(j.inB.axis[1]);
  return inA * inB.inverse();
}

/// The rotation of body b in body a where the angles of an Euler motor are 0: two axes are where they were when set.
inline Mat3 zeroOfEuler(const Joint& j) {
  Mat3 inA, inB;
  if (j.inA.axis[0].cross(j.inA.axis[2]).norm() < 1e-9) return Mat3::Identity();  // not set yet
  inA << j.inA.axis[0], j.inA.axis[2], j.inA.axis[0].cross(j.inA.axis[2]);
  inB << j.inB.axis[0], j.inB.axis[2], j.inB.axis[0].cross(j.inB.axis[2]);
  return inA * inB.inverse();
}

}  // namespace detail

/// The pose of body b in body a where the joint's coordinates are 0; of a ball where both have the same rotation.
inline Pose zeroPose(const Joint& j) {
  Mat3 r = Mat3::Identity();
  switch (j.type) {
    case JointType::hinge:
    case JointType::fixed:
      r = detail::rotationWhenSet(j.inA.rotation);
      break;
    case JointType::slider:
      r = detail::rotationWhenSet(j.inA.rotation);
      // inB.anchor is a's centre in b.
      return {-(r * j.inB.anchor), r};
    case JointType::universal: {
      // The frame of (axis 1, axis 2) and that of (axis 2, axis 1) differ by an exchange of x and y.
      Mat3 exchange;
      exchange << 0, 1, 0, 1, 0, 0, 0, 0, -1;
      r = rotationOf(j.inA.rotation) * exchange * rotationOf(j.inB.rotation).transpose();
      break;
    }
    case JointType::hinge2:
      r = detail::zeroOfWheel(j);
      break;
    case JointType::angularMotor:
      if (j.motor.euler) r = detail::zeroOfEuler(j);
      break;
    default:
      break;
  }
  return {j.inA.anchor - r * j.inB.anchor, r};
}

/// A body in its tree.
struct TreeLink {
  Index body = 0;
  Index parent = kNone;  ///< index in JointTrees::links; kNone: a root
  Index joint = kNone;   ///< the joint to the parent, or of a root to the world; kNone: a root that is free
  bool childIsA = true;  ///< the body is body a of that joint
  Pose zero;             ///< of the body in its parent, or in the world, where the joint's coordinates are 0
};

/// All trees, one after the other, parents first; in the order of their roots' bodies, those with a joint to the world
/// before the others.
class JointTrees {
 public:
  std::vector<TreeLink> links;
  std::vector<Index> leftOver;  ///< joints in no tree: those that close a loop, and angular motors

  explicit JointTrees(const Model& model) : jointsOf_(model.bodies.size()), placed_(model.bodies.size(), false) {
    used_.assign(model.joints.size(), false);
    for (Index i = 0; i < model.joints.size(); ++i) {
      const Joint& j = model.joints[i];
      if (j.a == kNone || j.type == JointType::angularMotor) continue;
      jointsOf_[j.a].push_back(i);
      if (j.b != kNone) jointsOf_[j.b].push_back(i);
    }
    // Bodies that a joint connects to the world are roots if they can be.
    for (const bool toWorld : {true, false})
      for (Index body = 0; body < model.bodies.size(); ++body) {
        const Index root = placed_[body] ? kNone : jointToWorld(model, body);
        if (!placed_[body] && (root != kNone || !toWorld)) growFrom(model, body, root);
      }
    for (Index i = 0; i < model.joints.size(); ++i)
      if (model.joints[i].a != kNone && !used_[i]) leftOver.push_back(i);
  }

 private:
  Index jointToWorld(const Model& model, Index body) const {
    for (const Index j : jointsOf_[body])
      if (model.joints[j].b == kNone) return j;
    return kNone;
  }
  void growFrom(const Model& model, Index root, Index jointOfRoot) {
    const std::size_t first = links.size();
    add(model, root, kNone, jointOfRoot);
    for (std::size_t at = first; at < links.size(); ++at) {
      const Index above = links[at].body;
      for (const Index i : jointsOf_[above]) {
        const Index other = model.joints[i].a == above ? model.joints[i].b : model.joints[i].a;
        if (!used_[i] && other != kNone && !placed_[other]) add(model, other, static_cast<Index>(at), i);
      }
    }
  }
  void add(const Model& model, Index body, Index parent, Index joint) {
    TreeLink link{body, parent, joint, true, {}};
    if (joint != kNone) {
      used_[joint] = true;
      link.childIsA = model.joints[joint].a == body;
      const Pose b = zeroPose(model.joints[joint]);
      link.zero = link.childIsA ? inverse(b) : b;
    }
    placed_[body] = true;
    links.push_back(link);
  }

  std::vector<std::vector<Index>> jointsOf_;
  std::vector<bool> placed_, used_;
};

}  // namespace spark::engine
