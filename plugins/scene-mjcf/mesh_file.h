#pragma once
/// \file
/// Mesh files: MSH, MuJoCo's own format, and STL, OBJ and what else assimp reads.

#include "api/model.h"

namespace spark::mjcf {

/// Vertices and triangles of a file [m]; a file without faces has no triangles. `name` says its format by its ending.
/// Throws Error.
engine::ShapeDescription readMesh(const std::string& name, const std::string& bytes);

}  // namespace spark::mjcf
