#include "trees.h"

namespace spark::bullet {

using engine::Joint;
using engine::JointType;
using engine::Model;

namespace {

Mat3 rotationWhenSet(const std::array<double, 4>& q) {
  // All zeros: a fixed joint that was never set.
  return q == std::array<double, 4>{} ? Mat3(Mat3::Identity()) : rotationOf(q);
}

/// The rotation of body b in body a where the coordinates of a wheel are 0.
Mat3 zeroOfWheel(const Joint& j) {
  // The axes as columns, in a and in b.
  Mat3 inA, inB;
  const Vec3 axis2InA = j.cosAxes * j.axisA[0] + j.sinAxes * j.planeA[0];
  const Vec3 axis1InB = j.cosAxes * j.axisB[1] + j.sinAxes * j.planeB[0];
  inA << j.axisA[0], axis2InA, j.axisA[0].cross(axis2InA);
  inB << axis1InB, j.axisB[1], axis1InB.cross(j.axisB[1]);
  return inA * inB.inverse();
}

/// The pose of body b in body a where the joint's coordinates are 0.
Pose zeroOfB(const Joint& j) {
  Mat3 r = Mat3::Identity();
  switch (j.type) {
    case JointType::hinge:
    case JointType::fixed:
      r = rotationWhenSet(j.initialRotationA);
      break;
    case JointType::slider:
      r = rotationWhenSet(j.initialRotationA);
      // anchorB is a's centre in b.
      return {-(r * j.anchorB), r};
    case JointType::universal: {
      // The frame of (axis 1, axis 2) and that of (axis 2, axis 1) differ by an exchange of x and y.
      Mat3 exchange;
      exchange << 0, 1, 0, 1, 0, 0, 0, 0, -1;
      r = rotationOf(j.initialRotationA) * exchange * rotationOf(j.initialRotationB).transpose();
      break;
    }
    case JointType::hinge2:
      r = zeroOfWheel(j);
      break;
    default:
      break;
  }
  return {j.anchorA - r * j.anchorB, r};
}

Pose inverse(const Pose& p) { return {-(p.rotation.transpose() * p.position), p.rotation.transpose()}; }

bool canBeInTree(const Joint& j) { return j.a != kNone && j.type != JointType::angularMotor; }

}  // namespace

Trees::Trees(const Model& model) {
  std::vector<bool> placed(model.bodies.size(), false), used(model.joints.size(), false);
  std::vector<std::vector<Index>> jointsOf(model.bodies.size());
  for (Index i = 0; i < model.joints.size(); ++i) {
    const Joint& j = model.joints[i];
    if (!canBeInTree(j)) continue;
    jointsOf[j.a].push_back(i);
    if (j.b != kNone) jointsOf[j.b].push_back(i);
  }
  const auto add = [&](Tree& tree, Index body, Index parent, Index joint) {
    Link link{body, parent, joint, true, {}};
    if (joint != kNone) {
      used[joint] = true;
      link.childIsA = model.joints[joint].a == body;
      const Pose b = zeroOfB(model.joints[joint]);
      link.zero = link.childIsA ? inverse(b) : b;
    }
    placed[body] = true;
    tree.links.push_back(link);
  };
  // Bodies that a joint connects to the world are roots if they can be.
  for (const bool toWorld : {true, false})
    for (Index body = 0; body < model.bodies.size(); ++body) {
      if (placed[body]) continue;
      Index root = kNone;
      for (const Index j : jointsOf[body])
        if (root == kNone && model.joints[j].b == kNone) root = j;
      if (toWorld && root == kNone) continue;
      Tree& tree = trees.emplace_back();
      add(tree, body, kNone, root);
      for (std::size_t at = 0; at < tree.links.size(); ++at) {
        const Index above = tree.links[at].body;
        for (const Index i : jointsOf[above]) {
          const Index other = model.joints[i].a == above ? model.joints[i].b : model.joints[i].a;
          if (!used[i] && other != kNone && !placed[other]) add(tree, other, static_cast<Index>(at), i);
        }
      }
    }
  for (Index i = 0; i < model.joints.size(); ++i)
    if (model.joints[i].a != kNone && !used[i]) leftOver.push_back(i);
}

}  // namespace spark::bullet
