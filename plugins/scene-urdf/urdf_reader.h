#pragma once
/// \file
/// Reads URDF, the robot description language of ROS, into the model that scene-mjcf builds nodes of.

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "robot/model.h"

namespace spark::urdf {

/// How the root link stands in the world.
enum class Base {
  byFile,  ///< free, unless it is called "world" or nothing that is fixed to it has a mass
  fixed,
  free
};

/// A mesh by the name that the file gives it. Throws Error.
using ReadMesh = std::function<engine::Mesh(const std::string& file)>;

/// A file that is XML with the element `robot`.
class Document {
 public:
  /// Throws Error with file:line:column for anything else.
  Document(std::string name, std::string text);
  mjcf::Element root() const { return {file_.xml.document_element(), &file_}; }

 private:
  mjcf::File file_;
};

/// Reads a robot. What it does not take is named in `unsupported`. Throws Error with file:line:column. `document` must
/// outlive the model.
mjcf::Model readModel(const Document& document, Base base, const ReadMesh& readMesh, mjcf::Unsupported& unsupported);

/// Names that a mesh `name` of a robot in the file `of` may have in the file system, the likeliest first. `name`:
/// relative, or `package://NAME/...`, `model://NAME/...`, `file://...`.
std::vector<std::string> meshNames(std::string_view of, std::string_view name);

}  // namespace spark::urdf
