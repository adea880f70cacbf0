#include "mesh_library.h"

#include <set>

#include "api/files.h"
#include "spark/error.h"
#include "spark/kernel.h"

namespace spark {

std::vector<std::string> objMaterials(std::string_view text) {
  std::set<std::string> names;
  std::string_view current;
  while (!text.empty()) {
    // The next line, without leading blanks.
    const std::size_t n = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, n);
    text.remove_prefix(std::min(n + 1, text.size()));
    line.remove_prefix(std::min(line.find_first_not_of(" \t\r"), line.size()));

    if (line.starts_with("usemtl ")) {
      line.remove_prefix(7);
      line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
      current = line.substr(0, line.find_first_of(" \t\r"));
    } else if (line.starts_with("f ") && !current.empty()) {
      names.emplace(current);
    }
  }
  return {names.begin(), names.end()};
}

void MeshLibrary::define(std::string mesh, std::vector<std::string> materials) {
  declared_[std::move(mesh)] = std::move(materials);
}

const std::vector<std::string>& MeshLibrary::materials(Kernel& kernel, const std::string& mesh) {
  // Mesh names may come from a client: only meshes with a file are cached.
  static const std::vector<std::string> kNone;
  const auto declared = declared_.find(mesh);
  const auto& otherwise = declared == declared_.end() ? kNone : declared->second;
  auto* files = mesh.ends_with(".obj") ? kernel.root().find<IFileServer>() : nullptr;
  if (!files) return otherwise;
  try {
    const std::uint64_t stamp = files->stamp(mesh);
    if (stamp == 0) return otherwise;
    const auto known = read_.find(mesh);
    if (known != read_.end() && known->second.stamp == stamp) return known->second.materials;
    return read_.insert_or_assign(mesh, Entry{stamp, objMaterials(files->read(mesh))}).first->second.materials;
  } catch (const Error& e) {
    kernel.log().warning("mesh '{}' cannot be read: {}", mesh, e.what());
    return otherwise;
  }
}

}  // namespace spark
