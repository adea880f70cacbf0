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
  entries_[std::move(mesh)].declared = std::move(materials);
}

const std::vector<std::string>& MeshLibrary::materials(Kernel& kernel, const std::string& mesh) {
  Entry& entry = entries_[mesh];
  auto* files = mesh.ends_with(".obj") ? kernel.root().find<IFileServer>("/sys/server/file") : nullptr;
  if (files) {
    try {
      const std::uint64_t stamp = files->stamp(mesh);
      if (!entry.asked || stamp != entry.stamp) entry.found = stamp ? objMaterials(files->read(mesh)) : std::vector<std::string>();
      entry.stamp = stamp;
    } catch (const Error& e) {
      if (!entry.asked) kernel.log().warning("mesh '{}' cannot be read: {}", mesh, e.what());
    }
    entry.asked = true;
  }
  return entry.stamp ? entry.found : entry.declared;
}

}  // namespace spark
