#pragma once
/// \file
/// Mesh files that assimp reads.

#include <assimp/Importer.hpp>
#include <string>

struct aiScene;

namespace spark::meshes {

/// The ending of a file's name in lower case; "" if there is none.
std::string formatOf(const std::string& name);

/// A file with all its objects at their places, as triangles.
class AssimpFile {
 public:
  /// Throws Error if `format`, an ending such as "stl", is unknown, or the bytes are not in it.
  AssimpFile(const std::string& format, const std::string& bytes);
  /// Valid as long as this object.
  const aiScene& scene() const { return *scene_; }

 private:
  Assimp::Importer importer_;
  const aiScene* scene_ = nullptr;
};

}  // namespace spark::meshes
