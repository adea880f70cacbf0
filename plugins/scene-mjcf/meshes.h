#pragma once
/// \file
/// The meshes of an MJCF model.

#include <map>

#include "compiler.h"
#include "robot/geom_mass.h"
#include "robot/model.h"

namespace spark::mjcf {

/// A mesh: its surface, from which its mass follows, and its convex hull, which collides; a flat mesh has none.
struct Mesh {
  std::shared_ptr<const engine::Mesh> surface, hull;
  std::optional<MeshInertia> inertia;  ///< what the mesh says itself
  bool weighsAsHull = false;           ///< its mass is that of its hull
  const engine::Mesh& solid() const { return weighsAsHull && hull ? *hull : *surface; }
};

/// The meshes of the element `asset`. A mesh is loaded when the first geom needs it, and only once.
class Meshes {
 public:
  /// `read` must outlive the meshes.
  explicit Meshes(const ReadMesh& read) : read_(read) {}
  /// Adds an element `mesh`. `folder`: of the mesh files, "" or "a/". Throws Error.
  void add(Attributes& a, const std::string& folder, const Compiler& compiler);
  /// The mesh that the geom `a` names. Throws Error for unknown meshes and meshes that cannot be read, LimitError when
  /// all geoms have more than kMaxMeshNumbers together.
  const Mesh& get(Attributes& a, Unsupported& unsupported);
  /// Of the meshes that were returned.
  const Surfaces& surfaces() const { return surfaces_; }

 private:
  struct Asset {
    Element from;
    std::string folder, file;
    std::vector<double> vertices;  ///< written in the model itself, as the faces
    std::vector<std::uint32_t> faces;
    Vec3 scale{1, 1, 1}, origin = Vec3::Zero();
    Mat3 rotation = Mat3::Identity();
    std::string inertia;  ///< "": as the compiler says
    std::optional<Mesh> loaded;
    std::string failure;  ///< why it cannot be loaded; "": not tried, or it is
  };
  const Mesh& loaded(Asset& asset, Unsupported& unsupported);
  engine::Mesh surfaceOf(const Asset& asset) const;
  void load(Asset& asset, Unsupported& unsupported);

  const ReadMesh& read_;
  Surfaces surfaces_;
  std::map<std::string, Asset, std::less<>> assets_;  ///< by name
  std::size_t numbers_ = 0;                           ///< of all meshes returned so far
};

}  // namespace spark::mjcf
