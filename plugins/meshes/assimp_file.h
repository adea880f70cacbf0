#pragma once
/// \file
/// Mesh files that assimp reads.

#include <cstdint>
#include <string>
#include <vector>

#include "visual_mesh.h"

namespace spark::meshes {

/// The ending of a file's name in lower case; "" if there is none.
std::string formatOf(const std::string& name);

/// The triangles of a file that have one material.
struct AssimpMesh {
  struct Corner {
    float position[3];  ///< of finite numbers, in the file's scene
    float normal[3];    ///< zero: none
    float place[2];     ///< on the texture
  };
  std::vector<Corner> corners;
  std::vector<std::uint32_t> triangles;  ///< indices of `corners`, three for each triangle
  std::uint32_t material = 0;            ///< index of AssimpFile::materials
};

/// A file with all its objects at their places, as triangles. A material without a name is one that the file does not
/// have. Textures are named as the file does; those inside of the file are left out.
struct AssimpFile {
  std::vector<AssimpMesh> meshes;
  std::vector<MeshMaterial> materials;
  std::vector<std::string> leftOut;  ///< what of the file is not here, such as "3 lines"
};

/// Reads a file in a process of its own, since assimp does not survive every damaged one. Throws Error if `format`, an
/// ending such as "stl", is unknown, or the bytes are not in it.
AssimpFile readAssimpFile(const std::string& format, const std::string& bytes);

}  // namespace spark::meshes
