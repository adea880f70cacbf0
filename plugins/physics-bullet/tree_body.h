#pragma once
/// \file
/// A tree of bodies as Bullet's multi-body: coordinates of joints, by Featherstone's articulated-body algorithm.

#include <BulletDynamics/Featherstone/btMultiBody.h>

#include <memory>
#include <vector>

#include "api/engine.h"
#include "convert.h"
#include "trees.h"

namespace spark::bullet {

/// Memory that multi-bodies use while they compute.
struct Scratch {
  btAlignedObjectArray<btScalar> scalars;
  btAlignedObjectArray<btVector3> vectors, origins, omegas, velocities;
  btAlignedObjectArray<btMatrix3x3> matrices;
  btAlignedObjectArray<btQuaternion> rotations;
};

/// A degree of freedom with a coordinate.
struct Dof {
  Index joint = kNone;
  int axis = 0;          ///< of the joint; -1: the suspension of a wheel
  int link = 0;          ///< Bullet's
  bool slides = false;   ///< translation, not rotation
  Vec3 direction;        ///< of the axis, in the child, with the sign of the joint's coordinate
  bool atParent = true;  ///< it is the one next to the parent of those of its joint that turn
  double position = 0;   ///< as stops count [rad or m]
  double rate = 0;       ///< rad/s or m/s
};

class TreeBody {
 public:
  TreeBody(const engine::Model& model, Tree tree);

  /// Takes poses and velocities of its bodies from the state.
  void take(const engine::Model& model, const engine::State& state);
  /// Adds gravity and the bodies' forces, and accelerates.
  void accelerate(const engine::Model& model, const engine::State& state, double dt, Scratch& scratch);
  /// Moves by the present velocities, and writes poses and velocities to the state.
  void move(engine::State& state, double dt, Scratch& scratch);
  /// Clears the forces on its bodies, which all parts of a step have.
  void clearForces(engine::State& state) const;

  btMultiBody& multiBody() { return *body_; }
  const std::vector<Link>& links() const { return tree_.links; }
  /// Bullet's link of one of its links; -1: the base.
  int linkOf(Index link) const { return places_[link].link; }
  const std::vector<Dof>& dofs() const { return dofs_; }
  /// Where a degree of freedom is in Bullet's vector of velocities.
  int offsetOf(const Dof& dof) const { return 6 + body_->getLink(dof.link).m_dofOffset; }

 private:
  /// How Bullet has one of the links.
  struct Place {
    int link = -1;                                             ///< Bullet's
    int ball = -1;                                             ///< Bullet's link of its ball joint; -1: none
    Eigen::Quaterniond axes = Eigen::Quaterniond::Identity();  ///< principal axes of inertia, in the body
    Vec3 moments;                                              ///< about them [kg m^2]
    bool turned = false;                                       ///< they are others than the body's
  };
  void build(const engine::Model& model);
  void addLink(const engine::Model& model, Index index, int& next);
  void takeRoot(const engine::DynamicState& s, const Place& place);
  void takeLink(const engine::Model& model, const engine::State& state, Index index);
  void takeDof(Dof& dof, const engine::Model& model, const engine::State& state, const Link& link);
  void give(engine::State& state, Index index, Scratch& scratch) const;

  Tree tree_;
  std::vector<Place> places_;                ///< by link
  std::vector<Dof> dofs_;                    ///< by link, from the parent to the child
  std::vector<std::pair<int, int>> dofsOf_;  ///< by link: from, to
  std::unique_ptr<btMultiBody> body_;
};

}  // namespace spark::bullet
