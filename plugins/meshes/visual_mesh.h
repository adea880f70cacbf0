#pragma once
/// \file
/// Meshes as they look: triangles with normals, places on textures, and materials.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "api/appearance.h"

namespace spark::meshes {

/// A corner of a triangle, as the shaders read it.
struct Vertex {
  float position[3];    ///< m, before the mesh's scale
  float normal[3];      ///< of the surface
  float place[2];       ///< on the texture, 0..1, from the left and from the bottom
  float faceNormal[3];  ///< of the triangle
};

/// The faces of a mesh that have one material.
struct MeshPart {
  std::string material;          ///< the mesh's own name of it
  std::vector<Vertex> vertices;  ///< three for each triangle
};

/// What a mesh file, or the file of materials beside it, says about a material.
struct MeshMaterial {
  std::string name;
  IMaterial::Look look;
  std::string texture;  ///< resource name; "": none
};

/// A mesh as it looks.
struct VisualMesh {
  std::vector<MeshPart> parts;  ///< in alphabetical order of their materials
  std::vector<MeshMaterial> materials;
};

/// Returns the content of a resource; nullopt if there is none.
using FindFile = std::function<std::optional<std::string>(const std::string& resource)>;

/// Reads a mesh file of any format that readMesh() knows; coordinates are the same. `find` looks up the files of
/// materials of OBJ as `materials/<file>`, or beside the mesh, and textures as `textures/<file>`, or beside the mesh.
/// Triangles without normals are flat. Throws Error.
VisualMesh readVisualMesh(const std::string& resource, const std::string& bytes, const FindFile& find);

}  // namespace spark::meshes
