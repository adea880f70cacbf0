#pragma once
/// \file
/// Meshes from OBJ files.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "api/appearance.h"

namespace spark::camera {

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

/// What a file of materials says about one.
struct MeshMaterial {
  std::string name;
  IMaterial::Look look;
  std::string texture;  ///< resource name; "": none
};

/// A mesh.
struct Mesh {
  std::vector<MeshPart> parts;  ///< in alphabetical order of their materials
  std::vector<MeshMaterial> materials;
};

/// Returns the content of a resource; nullopt if there is none.
using FindFile = std::function<std::optional<std::string>(const std::string& resource)>;

/// Reads an OBJ file and its MTL files, which `find` looks up as `materials/<file>`, or beside the mesh; textures are
/// `textures/<file>`, or beside the mesh. Throws Error.
Mesh readObj(const std::string& resource, const std::string& bytes, const FindFile& find);

}  // namespace spark::camera
