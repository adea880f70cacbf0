#pragma once
/// \file
/// What the scene consists of, for cameras.
///
/// The visual nodes become pieces: a box, sphere, cylinder or capsule is one, a mesh one for each of its materials. A
/// mesh whose file does not exist is shown as solid colliders near it, in the mesh's first material: those at its
/// transform, or else at the transform above, or else at transforms beside it that show nothing. So the robots and
/// fields of scenes whose meshes only viewers have can be seen, too. Painted lines (IPaintedLine) are flat boxes.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "api/physics.h"
#include "api/scene.h"
#include "mesh_store.h"
#include "renderer.h"

namespace spark::camera {

/// A solid, or a part of a mesh.
struct Piece {
  const IVisual* visual = nullptr;                      ///< nullptr: it is always visible
  const Transform* transform = nullptr;                 ///< nullptr: it is in the world frame
  Eigen::Matrix4d local = Eigen::Matrix4d::Identity();  ///< from its own frame to that of the transform
  std::array<float, 4> size{0.5f, 0.5f, 0.5f, 0};       ///< see Shape
  Batch kind;                                           ///< without its range
  const IMaterial* material = nullptr;                  ///< nullptr: it looks like `own`
  IMaterial::Look own;
  std::uint16_t number = 0;  ///< in segmentations
};

/// The order of pieces: those that one batch can draw are neighbours.
inline auto orderOf(const Batch& b) { return std::tuple(b.transparent, b.shape, b.mesh, b.texture); }

/// The pieces of the active scene. They are listed again when the tree or the scene changed.
class PieceList {
 public:
  /// `owner`: a node of the tree that outlives it.
  explicit PieceList(Node& owner) : owner_(owner), store_(owner.kernel()) {}
  /// Lists the pieces, if something changed since the last call. What they point to lives until the tree changes.
  void update();
  /// The pieces, opaque ones first.
  const std::vector<Piece>& pieces() const { return pieces_; }
  /// The lights, in tree order.
  const std::vector<IVisual*>& lights() const { return lights_; }
  /// Paths of visual nodes and painted lines, by number; the first is that of number 0, "".
  const std::vector<std::string>& paths() const { return paths_; }

 private:
  std::uint16_t nextNumber(const Leaf& leaf);
  void list(IVisual& visual);
  void listMesh(const Piece& like, const Mesh& mesh);
  void listColliders(Piece like);
  void listCollider(Piece piece, ICollider& collider);
  void listLine(IPaintedLine& line);
  void add(Piece piece, const std::string& material, const Mesh* mesh = nullptr);
  /// Takes over the material of that name: of the mesh's file, or else of the server, or else its default. Returns the
  /// name of its texture.
  std::string dress(Piece& piece, const std::string& material, const Mesh* mesh) const;

  Node& owner_;
  MeshStore store_;
  TreeWatch tree_;
  std::uint64_t modified_ = 0;  ///< ISceneServer::modifiedCount() at the last update
  std::vector<Piece> pieces_;
  std::vector<IVisual*> lights_;
  std::vector<std::string> paths_{""};
  std::set<const ICollider*> used_;  ///< colliders that are shown
};

}  // namespace spark::camera
