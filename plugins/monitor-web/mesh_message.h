#pragma once
/// \file
/// The bytes of a mesh for viewers. README.md specifies them.

#include <string>

#include "meshes/visual_mesh.h"
#include "stream/messages.h"

namespace spark::web {

/// Most corners of triangles in a mesh: 48 MB.
inline constexpr std::size_t kMostCorners = 1'500'000;

/// The mesh as bytes. `link`: for its textures. Throws Error if it is too large, or has coordinates that are not
/// finite.
std::string meshMessage(const meshes::VisualMesh& mesh, const AssetLink& link);

}  // namespace spark::web
