// Mesh files: the first byte chooses the format. Indices are those of vertices, all numbers finite.
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "../../plugins/meshes/mesh_file.h"
#include "../../plugins/meshes/visual_mesh.h"
#include "spark/error.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static constexpr const char* kNames[] = {"a.msh", "a.stl", "a.obj", "a.dae", "a.glb"};
  if (size == 0) return 0;
  const char* const name = kNames[data[0] % 5];
  const std::string bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  try {
    for (const auto& part : spark::meshes::readVisualMesh(name, bytes, [](const auto&) { return std::nullopt; }).parts)
      if (part.vertices.empty() || part.vertices.size() % 3 != 0) std::abort();
  } catch (const spark::Error&) {
  }
  try {
    const auto shape = spark::meshes::readMesh(name, bytes);
    if (shape.vertices.empty() || shape.vertices.size() % 3 != 0 || shape.triangles.size() % 3 != 0) std::abort();
    for (const auto v : shape.triangles)
      if (v >= shape.vertices.size() / 3) std::abort();
    for (const double v : shape.vertices)
      if (!std::isfinite(v)) std::abort();
  } catch (const spark::Error&) {
  }
  return 0;
}
