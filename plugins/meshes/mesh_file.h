#pragma once
/// \file
/// Mesh files: OBJ, STL, Collada (DAE), glTF (GLB), MSH, which is MuJoCo's own format, and what else assimp reads.

#include <string>

#include "api/shape.h"

namespace spark::meshes {

/// Vertices and triangles of a file [m]; an OBJ or MSH file without faces has no triangles. All nodes of a file with a
/// scene in it are one mesh; coordinates are those of the file, whatever it says about the direction of up. `name` says
/// its format by its ending. Throws Error.
engine::Mesh readMesh(const std::string& name, const std::string& bytes);

}  // namespace spark::meshes
