#pragma once
/// \file
/// Convex pieces of surfaces: MuJoCo fills the hollows of a mesh.

#include <memory>
#include <unordered_map>
#include <vector>

#include "api/model.h"

namespace spark::mujoco {

/// x y z of the corners of a convex solid [m].
using Piece = std::vector<double>;

/// The most pieces of a surface: MuJoCo compares each with each body.
inline constexpr std::size_t kMostPieces = 10'000;

/// Convex solids that together have the surface of a mesh. A part that is convex is one piece. Of the others each
/// convex polygon of triangles in a plane is a plate, which reaches at most 10 mm behind the surface, and not beyond
/// its other side. Triangles without area are left out. Empty: there would be more than kMostPieces.
std::vector<Piece> piecesOf(const engine::Mesh& mesh);

/// How the meshes of a world are written for MuJoCo.
class MeshPieces {
 public:
  struct Entry {
    std::shared_ptr<const engine::Mesh> mesh;  ///< keeps its address
    /// The mesh that is written: itself, or a smaller one of 0.1 mm, of which MuJoCo can make a hull.
    std::shared_ptr<const engine::Mesh> written;
    std::vector<Piece> pieces;  ///< where it does not move; empty: its hull
    bool isSolid = true;        ///< its hull has a volume
  };
  /// Makes what the meshes of the model lack, and drops the others.
  void update(const engine::Model& model);
  /// That of a geom with Shape::mesh.
  const Entry& of(const engine::Geom& geom) const { return *all_.at(geom.shape.mesh.get()); }
  /// The direction in which a piece of such a geom looks, if it is a plate; zero: it is a solid.
  Vec3 frontOf(const engine::Geom& geom, std::size_t piece) const;

 private:
  std::unordered_map<const engine::Mesh*, std::shared_ptr<const Entry>> all_;  // never iterated
};

}  // namespace spark::mujoco
