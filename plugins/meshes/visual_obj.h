#pragma once
/// \file
/// OBJ files with their materials.

#include <string_view>

#include "visual_mesh.h"

namespace spark::meshes {

/// The resource of a file that a mesh names: in `folder`, or beside the mesh; "" if there is none.
std::string resourceOf(std::string_view named, const char* folder, const std::string& mesh, const FindFile& find);

/// Reads an OBJ file and its MTL files, as readVisualMesh() does.
VisualMesh readVisualObj(const std::string& resource, const std::string& bytes, const FindFile& find);

}  // namespace spark::meshes
