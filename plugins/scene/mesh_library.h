#pragma once
/// \file
/// The materials of meshes. The meshes themselves are never loaded: only viewers need them.

#include <map>
#include <string>
#include <vector>

namespace spark {

class Kernel;

/// Material lists by mesh name. Lists of OBJ files are read from the `usemtl` lines of the files.
class MeshLibrary {
 public:
  /// Names of the mesh's materials in alphabetical order; empty when the mesh is unknown. Valid until the next call.
  const std::vector<std::string>& materials(Kernel& kernel, const std::string& mesh);
  /// Declares the materials of a mesh without a file. An existing file takes precedence.
  void define(std::string mesh, std::vector<std::string> materials);

 private:
  struct Entry {
    std::uint64_t stamp;  ///< of the file
    std::vector<std::string> materials;
  };
  std::map<std::string, std::vector<std::string>, std::less<>> declared_;
  std::map<std::string, Entry, std::less<>> read_;
};

/// The names after `usemtl` in the text of an OBJ file, each once, in alphabetical order. Names without a face are
/// skipped.
std::vector<std::string> objMaterials(std::string_view text);

}  // namespace spark
