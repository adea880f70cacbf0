#include "visual_obj.h"

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <istream>
#include <map>
#include <set>
#include <span>
#include <sstream>
#include <streambuf>

#include "spark/error.h"

namespace spark::meshes {

namespace {

std::string fileOf(std::string_view path) { return std::string(path.substr(path.find_last_of("/\\") + 1)); }

/// A stream over bytes that stay where they are.
struct Bytes : std::streambuf {
  explicit Bytes(const std::string& bytes) {
    char* const begin = const_cast<char*>(bytes.data());  // which a streambuf for reading does not change
    setg(begin, begin, begin + bytes.size());
  }
};

/// Number of lines that begin a material.
std::size_t countMaterials(std::string_view bytes) {
  constexpr std::string_view kWord = "newmtl";
  std::size_t n = 0;
  for (std::size_t at = 0; (at = bytes.find(kWord, at)) != bytes.npos; at += kWord.size()) ++n;
  return n;
}

/// Reads the files of materials that a mesh names, each once.
struct Materials : tinyobj::MaterialReader {
  static constexpr std::size_t kMost = 4096;  // materials of all files: the reader has some KB for each
  Materials(const std::string& mesh, const FindFile& find) : mesh(mesh), find(find) {}
  bool operator()(const std::string& name, std::vector<tinyobj::material_t>* out, std::map<std::string, int>* indices,
                  std::string* warning, std::string* error) override {
    // True only with materials: the reader takes the address of the first.
    if (!read.insert(fileOf(name)).second) return !out->empty();
    const std::string resource = resourceOf(name, "materials", mesh, find);
    if (resource.empty()) return false;
    const std::string bytes = *find(resource);
    count += countMaterials(bytes);
    if (count > kMost) throw Error(fmt::format("expected at most {} materials, found {} so far", kMost, count));
    Bytes buffer(bytes);
    std::istream stream(&buffer);
    tinyobj::LoadMtl(indices, out, &stream, warning, error);
    return !out->empty();
  }
  const std::string& mesh;
  const FindFile& find;
  std::set<std::string> read;
  std::size_t count = 0;
};

Color colorOf(const float (&c)[3]) { return {c[0], c[1], c[2], 1}; }

/// `textures`: resources by what materials have named so far, each of which is read to find it.
MeshMaterial materialOf(const tinyobj::material_t& m, const std::string& mesh, const FindFile& find,
                        std::map<std::string, std::string>& textures) {
  MeshMaterial out;
  out.name = m.name;
  out.look.ambient = colorOf(m.ambient);
  out.look.diffuse = colorOf(m.diffuse);
  out.look.diffuse.a = m.dissolve;
  out.look.specular = colorOf(m.specular);
  out.look.emission = colorOf(m.emission);
  out.look.shininess = std::clamp<double>(m.shininess, 0, 128);
  if (m.diffuse_texname.empty()) return out;
  const auto [known, isNew] = textures.try_emplace(fileOf(m.diffuse_texname));
  if (isNew) known->second = resourceOf(m.diffuse_texname, "textures", mesh, find);
  out.texture = known->second;
  return out;
}

/// Builds a mesh from the lines of an OBJ file.
class Builder {
 public:
  void addVertex(float x, float y, float z) { vertices_.emplace_back(x, y, z); }
  void addNormal(float x, float y, float z) { normals_.emplace_back(x, y, z); }
  void addPlace(float u, float v) { places_.emplace_back(u, v, 0); }
  void setMaterial(const char* name) { part_ = &partOf(name); }
  void setMaterials(std::span<const tinyobj::material_t> materials) {
    // All so far, at each line that names a file: they only become more.
    if (materials.size() != materials_.size()) materials_.assign(materials.begin(), materials.end());
  }
  /// A polygon; one with fewer than three corners shows nothing.
  void addFace(std::span<const tinyobj::index_t> corners) {
    if (!part_) part_ = &partOf("");
    // Checked before the first corner is used; also those of lines, which are faces of two corners.
    for (const tinyobj::index_t& c : corners) position(c);
    for (std::size_t i = 2; i < corners.size(); ++i) addTriangle({corners[0], corners[i - 1], corners[i]});
  }
  VisualMesh take(const std::string& resource, const FindFile& find) {
    std::map<std::string, std::string> textures;
    for (const tinyobj::material_t& m : materials_) out_.materials.push_back(materialOf(m, resource, find, textures));
    for (auto& [material, part] : parts_)
      if (!part.vertices.empty()) out_.parts.push_back(std::move(part));
    return std::move(out_);
  }

 private:
  /// The element that an index of the file means: counted from 1, or from the last one backwards.
  static const Eigen::Vector3f& at(const std::vector<Eigen::Vector3f>& all, int index, const char* what) {
    const auto n = static_cast<long>(all.size()), i = index < 0 ? n + index : index - 1L;
    if (i < 0 || i >= n) throw Error(fmt::format("expected a face of its {} {}, found number {}", n, what, index));
    return all[static_cast<std::size_t>(i)];
  }
  const Eigen::Vector3f& position(const tinyobj::index_t& c) const { return at(vertices_, c.vertex_index, "vertices"); }

  void addTriangle(const std::array<tinyobj::index_t, 3>& corners) {
    const Eigen::Vector3f a = position(corners[0]), b = position(corners[1]), c = position(corners[2]);
    // Of three points on a line: no direction, as normalized() leaves it.
    const Eigen::Vector3f plane = (b - a).cross(c - a).normalized();
    for (const tinyobj::index_t& corner : corners) {
      const Eigen::Vector3f &p = position(corner),
                            n = corner.normal_index ? at(normals_, corner.normal_index, "normals") : plane,
                            t = corner.texcoord_index ? at(places_, corner.texcoord_index, "texture coordinates")
                                                      : Eigen::Vector3f::Zero();
      part_->vertices.push_back(
          {{p.x(), p.y(), p.z()}, {n.x(), n.y(), n.z()}, {t.x(), t.y()}, {plane.x(), plane.y(), plane.z()}});
    }
  }
  MeshPart& partOf(const std::string& material) {
    MeshPart& part = parts_[material];
    part.material = material;
    return part;
  }

  std::vector<Eigen::Vector3f> vertices_, normals_, places_;
  std::vector<tinyobj::material_t> materials_;
  std::map<std::string, MeshPart> parts_;  ///< by material
  MeshPart* part_ = nullptr;               ///< of the faces that follow
  VisualMesh out_;
};

tinyobj::callback_t callbacks() {
  tinyobj::callback_t out;
  out.vertex_cb = [](void* data, float x, float y, float z, float) { static_cast<Builder*>(data)->addVertex(x, y, z); };
  out.normal_cb = [](void* data, float x, float y, float z) { static_cast<Builder*>(data)->addNormal(x, y, z); };
  out.texcoord_cb = [](void* data, float u, float v, float) { static_cast<Builder*>(data)->addPlace(u, v); };
  out.usemtl_cb = [](void* data, const char* name, int) { static_cast<Builder*>(data)->setMaterial(name); };
  out.mtllib_cb = [](void* data, const tinyobj::material_t* all, int count) {
    static_cast<Builder*>(data)->setMaterials({all, static_cast<std::size_t>(count)});
  };
  out.index_cb = [](void* data, tinyobj::index_t* corners, int count) {
    static_cast<Builder*>(data)->addFace({corners, static_cast<std::size_t>(count)});
  };
  return out;
}

}  // namespace

std::string resourceOf(std::string_view named, const char* folder, const std::string& mesh, const FindFile& find) {
  const std::string file = fileOf(named);
  std::string below = fmt::format("{}/{}", folder, file);
  if (find(below)) return below;
  std::string beside = mesh.substr(0, mesh.size() - fileOf(mesh).size()) + file;
  return find(beside) ? beside : "";
}

VisualMesh readVisualObj(const std::string& resource, const std::string& bytes, const FindFile& find) {
  Builder builder;
  Materials materials(resource, find);
  Bytes buffer(bytes);
  std::istream stream(&buffer);
  std::string warning, error;
  try {
    tinyobj::LoadObjWithCallback(stream, callbacks(), &builder, &materials, &warning, &error);
  } catch (const std::exception& e) {
    throw Error(fmt::format("mesh '{}' cannot be read: {}", resource, e.what()));
  }
  VisualMesh out = builder.take(resource, find);
  if (out.parts.empty()) throw Error(fmt::format("mesh '{}': expected triangles, found none", resource));
  return out;
}

}  // namespace spark::meshes
