#include "meshes.h"

#include <fmt/format.h>

#include <filesystem>

namespace spark::mjcf {

void Meshes::add(Attributes& a, const std::string& folder) {
  Asset m;
  m.from = a.element();
  m.folder = folder;
  m.file = a.text("file");
  a.take("scale", m.scale);
  std::string name = a.text("name");
  if (name.empty()) {
    const std::size_t slash = m.file.rfind('/'), start = slash == std::string::npos ? 0 : slash + 1;
    name = m.file.substr(start, m.file.rfind('.') - start);
  }
  a.ignore({"smoothnormal", "texcoord", "normal", "maxhullvert", "content_type"});
  a.finish();
  assets_[name] = std::move(m);
}

engine::ShapeDescription Meshes::shape(Attributes& a) {
  const std::string name = a.text("mesh");
  const auto found = assets_.find(name);
  if (found == assets_.end()) throw a.element().error(fmt::format("there is no <mesh> '{}'", name));
  Asset& m = found->second;
  if (!m.loaded) load(m);
  numbers_ += m.loaded->vertices.size() + m.loaded->triangles.size();
  if (numbers_ > kMaxMeshNumbers)
    throw a.element().error(fmt::format("the meshes of all geoms have more than {} numbers", kMaxMeshNumbers));
  return *m.loaded;
}

void Meshes::load(Asset& m) {
  if (m.file.empty()) throw m.from.error("expected an attribute 'file'");
  try {
    m.loaded = read_(std::filesystem::path(m.folder + m.file).lexically_normal().string());
  } catch (const Error& e) {
    throw Error(fmt::format("{}: cannot read the mesh '{}'", m.from.where(), m.file), e);
  }
  m.loaded->shape = engine::Shape::mesh;
  for (std::size_t i = 0; i < m.loaded->vertices.size(); ++i) m.loaded->vertices[i] *= m.scale[static_cast<int>(i % 3)];
}

}  // namespace spark::mjcf
