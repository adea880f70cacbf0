#include "visual_mesh.h"

#include <assimp/scene.h>
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>

#include "assimp_file.h"
#include "mesh_file.h"
#include "spark/error.h"
#include "visual_obj.h"

namespace spark::meshes {

namespace {

/// A corner of a triangle in a file.
struct Corner {
  Eigen::Vector3f position;
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  ///< zero: that of the triangle
  Eigen::Vector2f place = Eigen::Vector2f::Zero();
};

void addTriangle(const std::array<Corner, 3>& corners, MeshPart& part) {
  const auto& [a, b, c] = corners;
  const Eigen::Vector3f plane = (b.position - a.position).cross(c.position - a.position).normalized();
  for (const Corner& corner : corners) {
    const bool hasNormal = corner.normal.allFinite() && !corner.normal.isZero();
    const Eigen::Vector3f& p = corner.position;
    const Eigen::Vector3f n = hasNormal ? corner.normal : plane;
    const Eigen::Vector2f t = corner.place.allFinite() ? corner.place : Eigen::Vector2f::Zero();
    part.vertices.push_back(
        {{p.x(), p.y(), p.z()}, {n.x(), n.y(), n.z()}, {t.x(), t.y()}, {plane.x(), plane.y(), plane.z()}});
  }
}

Corner cornerOf(const aiMesh& mesh, unsigned vertex) {
  const auto vector = [](const aiVector3D& v) { return Eigen::Vector3f(v.x, v.y, v.z); };
  Corner out{vector(mesh.mVertices[vertex])};
  if (!out.position.allFinite()) throw Error("expected vertices of finite numbers");
  if (mesh.HasNormals()) out.normal = vector(mesh.mNormals[vertex]);
  if (mesh.HasTextureCoords(0)) out.place = vector(mesh.mTextureCoords[0][vertex]).head<2>();
  return out;
}

MeshMaterial materialOf(const aiMaterial& from, const std::string& name, const std::string& mesh,
                        const FindFile& find) {
  MeshMaterial out{name, {}, {}};
  const auto color = [&](const char* key, Color& to) {
    aiColor4D c;
    if (from.Get(key, 0, 0, c) == aiReturn_SUCCESS) to = {c.r, c.g, c.b, 1};
  };
  color("$clr.ambient", out.look.ambient);
  color("$clr.diffuse", out.look.diffuse);
  color("$clr.specular", out.look.specular);
  color("$clr.emissive", out.look.emission);
  float number = 0;
  if (from.Get(AI_MATKEY_OPACITY, number) == aiReturn_SUCCESS) out.look.diffuse.a = number;
  if (from.Get(AI_MATKEY_SHININESS, number) == aiReturn_SUCCESS)
    out.look.shininess = std::clamp<double>(number, 0, 128);
  aiString texture;
  // Textures inside of the mesh file, whose names begin with a star, are not shown.
  if (from.GetTexture(aiTextureType_DIFFUSE, 0, &texture) == aiReturn_SUCCESS && texture.C_Str()[0] != '*')
    out.texture = resourceOf(texture.C_Str(), "textures", mesh, find);
  return out;
}

/// Reads what assimp reads. A material that a format makes up, because it knows none, is none.
VisualMesh readScene(const std::string& resource, const std::string& bytes, const FindFile& find) {
  const AssimpFile file(formatOf(resource), bytes);
  const aiScene& scene = file.scene();
  std::map<std::string, MeshPart> parts;  // by material
  VisualMesh out;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    if (mesh.mPrimitiveTypes != aiPrimitiveType_TRIANGLE) continue;
    const aiMaterial& material = *scene.mMaterials[mesh.mMaterialIndex];
    std::string name = material.GetName().C_Str();
    if (name == AI_DEFAULT_MATERIAL_NAME) name.clear();
    if (!name.empty() && !parts.contains(name)) out.materials.push_back(materialOf(material, name, resource, find));
    MeshPart& part = parts[name];
    part.material = name;
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const unsigned* const i = mesh.mFaces[f].mIndices;
      addTriangle({cornerOf(mesh, i[0]), cornerOf(mesh, i[1]), cornerOf(mesh, i[2])}, part);
    }
  }
  for (auto& [name, part] : parts)
    if (!part.vertices.empty()) out.parts.push_back(std::move(part));
  return out;
}

/// MuJoCo's format, whose normals and places are left out.
VisualMesh readMsh(const std::string& resource, const std::string& bytes) {
  const engine::Mesh mesh = readMesh(resource, bytes);
  MeshPart part;
  const auto corner = [&](std::size_t i) {
    const auto* const v = &mesh.vertices[3 * mesh.triangles[i]];
    return Corner{Eigen::Vector3f(static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]))};
  };
  for (std::size_t i = 0; i + 2 < mesh.triangles.size(); i += 3)
    addTriangle({corner(i), corner(i + 1), corner(i + 2)}, part);
  VisualMesh out;
  if (!part.vertices.empty()) out.parts.push_back(std::move(part));
  return out;
}

}  // namespace

VisualMesh readVisualMesh(const std::string& resource, const std::string& bytes, const FindFile& find) {
  const std::string format = formatOf(resource);
  if (format == "obj") return readVisualObj(resource, bytes, find);
  VisualMesh out = format == "msh" ? readMsh(resource, bytes) : readScene(resource, bytes, find);
  if (out.parts.empty()) throw Error(fmt::format("mesh '{}': expected triangles, found none", resource));
  return out;
}

}  // namespace spark::meshes
