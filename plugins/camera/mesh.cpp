#include "mesh.h"

#include <assimp/MemoryIOWrapper.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>

#include "spark/error.h"

namespace spark::camera {

namespace {

std::string fileOf(std::string_view path) { return std::string(path.substr(path.find_last_of("/\\") + 1)); }

/// The resource of a file that a mesh names: in `folder`, or beside the mesh; "" if there is none.
std::string resourceOf(std::string_view named, const char* folder, const std::string& mesh, const FindFile& find) {
  const std::string file = fileOf(named);
  std::string below = fmt::format("{}/{}", folder, file);
  if (find(below)) return below;
  std::string beside = mesh.substr(0, mesh.size() - fileOf(mesh).size()) + file;
  return find(beside) ? beside : "";
}

/// Lets assimp read the mesh and its materials as resources, and no other file of this machine.
class Resources : public Assimp::IOSystem {
 public:
  Resources(const std::string& mesh, const std::string& bytes, const FindFile& find)
      : mesh_(mesh), bytes_(bytes), find_(find) {}
  bool Exists(const char* name) const override { return name == mesh_ || !resource(name).empty(); }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* name, const char*) override {
    if (name == mesh_) return stream(bytes_);
    const std::string found = resource(name);
    return found.empty() ? nullptr : stream(*find_(found));
  }
  void Close(Assimp::IOStream* stream) override { delete stream; }

 private:
  std::string resource(const char* name) const { return resourceOf(name, "materials", mesh_, find_); }
  static Assimp::IOStream* stream(const std::string& bytes) {
    auto* copy = new std::uint8_t[bytes.size()];
    std::copy(bytes.begin(), bytes.end(), copy);
    return new Assimp::MemoryIOStream(copy, bytes.size(), true);  // which owns the copy
  }
  const std::string& mesh_;
  const std::string& bytes_;
  const FindFile& find_;
};

Color colorOf(const aiMaterial& m, const char* key, unsigned type, unsigned index, Color otherwise) {
  aiColor3D c;
  if (m.Get(key, type, index, c) == AI_SUCCESS) return {c.r, c.g, c.b, 1};
  return otherwise;
}

MeshMaterial materialOf(const aiMaterial& m, const std::string& mesh, const FindFile& find) {
  MeshMaterial out;
  out.name = m.GetName().C_Str();
  out.look.ambient = colorOf(m, AI_MATKEY_COLOR_AMBIENT, out.look.ambient);
  out.look.diffuse = colorOf(m, AI_MATKEY_COLOR_DIFFUSE, out.look.diffuse);
  out.look.specular = colorOf(m, AI_MATKEY_COLOR_SPECULAR, out.look.specular);
  out.look.emission = colorOf(m, AI_MATKEY_COLOR_EMISSIVE, out.look.emission);
  ai_real number = 0;
  if (m.Get(AI_MATKEY_SHININESS, number) == AI_SUCCESS) out.look.shininess = std::clamp<double>(number, 0, 128);
  if (m.Get(AI_MATKEY_OPACITY, number) == AI_SUCCESS) out.look.diffuse.a = static_cast<float>(number);
  aiString file;
  if (m.GetTexture(aiTextureType_DIFFUSE, 0, &file) == AI_SUCCESS)
    out.texture = resourceOf(file.C_Str(), "textures", mesh, find);
  return out;
}

void appendFace(const aiMesh& mesh, const aiFace& face, std::vector<Vertex>& out) {
  const aiVector3D *a = &mesh.mVertices[face.mIndices[0]], *b = &mesh.mVertices[face.mIndices[1]],
                   *c = &mesh.mVertices[face.mIndices[2]];
  const aiVector3D plane = ((*b - *a) ^ (*c - *a)).NormalizeSafe();
  for (unsigned i = 0; i < 3; ++i) {
    const unsigned v = face.mIndices[i];
    const aiVector3D p = mesh.mVertices[v], n = mesh.HasNormals() ? mesh.mNormals[v] : plane,
                     t = mesh.HasTextureCoords(0) ? mesh.mTextureCoords[0][v] : aiVector3D();
    out.push_back({{p.x, p.y, p.z}, {n.x, n.y, n.z}, {t.x, t.y}, {plane.x, plane.y, plane.z}});
  }
}

MeshPart& partOf(Mesh& mesh, const std::string& material) {
  for (MeshPart& p : mesh.parts)
    if (p.material == material) return p;
  return mesh.parts.emplace_back(MeshPart{material, {}});
}

}  // namespace

Mesh readObj(const std::string& resource, const std::string& bytes, const FindFile& find) {
  Assimp::Importer importer;
  importer.SetIOHandler(new Resources(resource, bytes, find));  // which it owns
  const aiScene* const scene =
      importer.ReadFile(resource, aiProcess_Triangulate | aiProcess_PreTransformVertices | aiProcess_SortByPType);
  if (!scene) throw Error(fmt::format("mesh '{}' cannot be read: {}", resource, importer.GetErrorString()));
  Mesh out;
  for (unsigned m = 0; m < scene->mNumMaterials; ++m)
    out.materials.push_back(materialOf(*scene->mMaterials[m], resource, find));
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    const aiMesh& mesh = *scene->mMeshes[m];
    if (mesh.mPrimitiveTypes != aiPrimitiveType_TRIANGLE) continue;
    MeshPart& part = partOf(out, out.materials.at(mesh.mMaterialIndex).name);
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) appendFace(mesh, mesh.mFaces[f], part.vertices);
  }
  if (out.parts.empty()) throw Error(fmt::format("mesh '{}': expected triangles, found none", resource));
  std::sort(out.parts.begin(), out.parts.end(),
            [](const MeshPart& a, const MeshPart& b) { return a.material < b.material; });
  return out;
}

}  // namespace spark::camera
