#pragma once
/// \file
/// Which materials a mesh has. Meshes themselves are never loaded: no part of the simulation looks at them, only
/// viewers do.

#include <map>
#include <string>
#include <vector>

namespace spark {

class Kernel;

/// Material lists by mesh name; those of OBJ files are read from the files' `usemtl` lines.
class MeshLibrary {
 public:
  /// Names of the mesh's materials in alphabetical order, empty when nothing is known. Valid until the next call.
  const std::vector<std::string>& materials(Kernel& kernel, const std::string& mesh);
  /// Declares them, for a mesh whose file is not there. A file that is there wins.
  void define(std::string mesh, std::vector<std::string> materials);

 private:
  struct Entry {
    std::uint64_t stamp;  ///< of the file
    std::vector<std::string> materials;
  };
  std::map<std::string, std::vector<std::string>, std::less<>> declared_;
  std::map<std::string, Entry, std::less<>> read_;
};

/// The names after `usemtl` in an OBJ file: each once, in alphabetical order; names that no face follows are left out.
std::vector<std::string> objMaterials(std::string_view text);

}  // namespace spark
