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

/// What was read for a mesh.
struct FoundMesh {
  FoundMesh(engine::Mesh m, std::string name = "") : mesh(std::move(m)), insteadOf(std::move(name)) {}
  engine::Mesh mesh;
  std::vector<std::string> leftOut{};  ///< what of the file is not in the mesh, such as "3 lines"
  std::string insteadOf;               ///< the file that was taken in place of one that is not there; "": it is there
};
/// A mesh by the name that the file gives it. Throws Error.
using ReadMesh = std::function<FoundMesh(const std::string& file)>;

/// A file that is XML with the element `robot`.
class Document {
 public:
  /// Throws Error with file:line:column for anything else.
  Document(std::string name, std::string text);
  mjcf::Element root() const { return {file_.xml.document_element(), &file_}; }

 private:
  mjcf::File file_;
};

/// Reads a robot. What it does not take, mends or leaves out is named in `unsupported`. Throws Error with
/// file:line:column for what is no robot. `document` must outlive the model.
mjcf::Model readModel(const Document& document, Base base, const ReadMesh& readMesh, mjcf::Unsupported& unsupported);

/// Names that a mesh `name` of a robot in the file `of` may have in the file system, the likeliest first. `name`:
/// relative, or `package://NAME/...`, `model://NAME/...`, `file://...`, also with `$(find NAME)`.
std::vector<std::string> meshNames(std::string_view of, std::string_view name);

/// The folders and the file of such a name: "meshes", "arm.stl". Empty where it names no file.
std::vector<std::string> partsOf(std::string_view name);

}  // namespace spark::urdf
