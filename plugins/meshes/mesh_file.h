#pragma once
/// \file
/// Mesh files: OBJ, STL, Collada (DAE), glTF (GLB), MSH, which is MuJoCo's own format, and what else assimp reads.

#include <string>
#include <vector>

#include "api/shape.h"

namespace spark::meshes {

/// Vertices and triangles of a file [m]; an OBJ or MSH file without faces has no triangles. All nodes of a file with a
/// scene in it are one mesh; coordinates are those of the file, whatever it says about the direction of up. `name` says
/// its format by its ending. What of the file is left out, such as "3 lines", is appended to `leftOut`. Throws Error.
engine::Mesh readMesh(const std::string& name, const std::string& bytes, std::vector<std::string>* leftOut = nullptr);

}  // namespace spark::meshes
