#include "visual_mesh.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
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

/// Reads what assimp reads. A material that a format makes up, because it knows none, is none.
VisualMesh readScene(const std::string& resource, const std::string& bytes, const FindFile& find) {
  const AssimpFile file = readAssimpFile(formatOf(resource), bytes);
  std::map<std::string, MeshPart> parts;  // by material
  VisualMesh out;
  for (const AssimpMesh& mesh : file.meshes) {
    const MeshMaterial& material = file.materials[mesh.material];
    if (!material.name.empty() && !parts.contains(material.name)) {
      out.materials.push_back(material);
      if (!material.texture.empty())
        out.materials.back().texture = resourceOf(material.texture, "textures", resource, find);
    }
    MeshPart& part = parts[material.name];
    part.material = material.name;
    const auto corner = [&mesh](std::uint32_t i) {
      const AssimpMesh::Corner& c = mesh.corners[i];
      return Corner{Eigen::Vector3f(c.position), Eigen::Vector3f(c.normal), Eigen::Vector2f(c.place)};
    };
    for (std::size_t i = 0; i < mesh.triangles.size(); i += 3)
      addTriangle({corner(mesh.triangles[i]), corner(mesh.triangles[i + 1]), corner(mesh.triangles[i + 2])}, part);
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
