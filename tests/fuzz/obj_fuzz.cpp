// OBJ files and their materials, as cameras and viewers show them. What the reader accepts has whole triangles and no
// material that stands for two parts.
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <set>

#include "../../plugins/meshes/visual_obj.h"
#include "spark/error.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  // The same bytes are the mesh, every file of materials and every texture.
  const auto find = [&bytes](const std::string& name) {
    return name.ends_with(".absent") ? std::nullopt : std::optional(bytes);
  };
  try {
    const spark::meshes::VisualMesh mesh = spark::meshes::readVisualObj("models/a.obj", bytes, find);
    std::set<std::string> materials;
    for (const spark::meshes::MeshPart& p : mesh.parts)
      if (p.vertices.empty() || p.vertices.size() % 3 != 0 || !materials.insert(p.material).second) std::abort();
    if (mesh.parts.empty()) std::abort();
  } catch (const spark::Error&) {
  }
  return 0;
}
