#pragma once
/// \file
/// A model as MJCF text, MuJoCo's own language of models.

#include <string>
#include <vector>

#include "api/joint_trees.h"
#include "api/state.h"
#include "mesh_pieces.h"
#include "mujoco_mesh.h"
#include "mujoco_nodes.h"

namespace spark::mujoco {

using engine::Index;
using engine::kNone;

/// A body in its tree, parents first.
struct Link : engine::TreeLink {
  /// A connector whose joint belongs to another body in MuJoCo: the link of that body; kNone: the link has a body.
  Index carrier = kNone;
  Pose carrierInLink;  ///< pose of the carrier in this link, where the coordinates between them are 0
};

/// The trees that joints make of the bodies of a model (see engine::JointTrees). The zero pose of a free body, and that
/// of a ball, is the present one.
struct Trees {
  std::vector<Link> links;
  explicit Trees(const engine::Model& model, const engine::State& state);

 private:
  void mergeConnectors(const engine::Model& model);
};

class Constraints;

/// Sizes of MuJoCo's buffers, which 2.2.2 has to be told.
struct Sizes {
  int contacts = 100, rows = 500;
};

// Names of MuJoCo's elements: b and the body's index, g and the geom's, j and the joint's with the coordinate's.
std::string bodyName(Index body);
/// Of a part of a body, from 1.
std::string partName(Index body, std::size_t part);
std::string geomName(Index geom);
/// Of a piece of a static mesh, from 0.
std::string pieceName(Index geom, std::size_t piece);
std::string jointName(Index joint, int coordinate);
/// Of a free body.
std::string freeJointName(Index body);

/// The number of coordinates that a joint has in MuJoCo: hinge and slider 1, universal 2, hinge2 3 (suspension,
/// steering, rolling), fixed 0; a ball has one joint of its own kind.
int coordinatesOf(engine::JointType type);

/// True when a medium drags at the bodies, and MuJoCo is not told: MujocoWorld does it, at a fraction of the cost. An
/// implicit integrator, and drag at ellipsoids, need MuJoCo's own.
bool hasOwnDrag(const engine::Model& model);

/// Difference between the least and the greatest height of a field, above 0 [m].
double spanOf(const engine::HeightField& field);

/// The options of a model.
OptionNumbers optionsOf(const engine::Model& model);

/// True when controllers are actuators of MuJoCo, named as their coordinates: an implicit integrator treats their
/// damping implicitly.
bool hasActuators(const engine::Model& model);

/// A world as text.
struct Written {
  std::string mjcf;
  std::vector<std::uint64_t> raised;  ///< identities of bodies whose masses or moments are too small for MuJoCo
};
/// `step`: length of a step [s].
Written toMjcf(const engine::Model& model, const Trees& trees, double step, const Sizes& sizes,
               const Constraints& constraints, const MeshPieces& pieces);

}  // namespace spark::mujoco
