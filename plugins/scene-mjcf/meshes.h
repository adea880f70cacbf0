#pragma once
/// \file
/// The meshes of an MJCF model.

#include <map>

#include "model.h"

namespace spark::mjcf {

/// The meshes of the element `asset`. A file is loaded when the first geom needs it, and only once.
class Meshes {
 public:
  /// `read` must outlive the meshes.
  explicit Meshes(const ReadMesh& read) : read_(read) {}
  /// Adds an element `mesh`. `folder`: of the mesh files, "" or "a/". Throws Error.
  void add(Attributes& a, const std::string& folder);
  /// The shape of the mesh that the geom `a` names. Throws Error for unknown meshes, files that cannot be read, and
  /// when all geoms have more than kMaxMeshNumbers together.
  engine::ShapeDescription shape(Attributes& a);

 private:
  struct Asset {
    Element from;
    std::string folder, file;
    Vec3 scale{1, 1, 1};
    std::optional<engine::ShapeDescription> loaded;
  };
  void load(Asset& asset);

  const ReadMesh& read_;
  std::map<std::string, Asset, std::less<>> assets_;  ///< by name
  std::size_t numbers_ = 0;                           ///< of all shapes returned so far
};

}  // namespace spark::mjcf
