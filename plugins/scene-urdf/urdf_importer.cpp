#include "urdf_importer.h"

#include <fmt/format.h>

#include "api/files.h"
#include "mesh_finder.h"
#include "robot/builder.h"
#include "spark/plugin.h"
#include "urdf_reader.h"

namespace spark {

void UrdfImporter::describe(Description<UrdfImporter>& d) {
  d.doc(
      "Imports robots in URDF. Arguments: a prefix for the names of its nodes; fixed or free: how the root link "
      "stands.");
  d.implements<ISceneImporter>();
  d.property("strict", &UrdfImporter::strict_)
      .doc("What is not supported, mended or left out is an error; otherwise it is logged.");
  d.property("selfCollide", &UrdfImporter::selfCollide_)
      .doc("Links of a robot collide with each other, unless a joint connects them.");
}

bool UrdfImporter::recognises(std::string_view text, std::string_view file) const {
  return mjcf::firstTag(text) == "robot" || file.ends_with(".urdf");
}

void UrdfImporter::import(std::string_view file, Node& root, const List& arguments) {
  urdf::Base base = urdf::Base::byFile;
  if (arguments.size() > 1) {
    const std::string word = arguments[1].plain();
    if (arguments.size() > 2 || (word != "fixed" && word != "free"))
      throw Error(fmt::format("cannot import '{}': expected a prefix for names, and 'fixed' or 'free', found '{}'",
                              file, word));
    base = word == "fixed" ? urdf::Base::fixed : urdf::Base::free;
  }
  auto& files = kernel().root().require<IFileServer>();
  urdf::MeshFinder meshes(files, std::string(file));
  const urdf::ReadMesh readMesh = [&](const std::string& name) { return meshes.read(name); };
  mjcf::Unsupported unsupported;
  const urdf::Document document(std::string(file), files.read(file));
  mjcf::Model model = urdf::readModel(document, base, readMesh, unsupported);
  if (selfCollide_) {
    model.selfCollides = true;
    model.exclusions.clear();
  }
  mjcf::Builder builder(model, arguments.empty() ? "" : arguments.front().plain(), strict_, unsupported);
  builder.build(root);
  if (builder.withoutParts())
    kernel().log().info(
        "{}: its joints get no perceptors and effectors: those are of the plugins gamecontrol, sensors and effectors",
        file);
  for (const std::string& sentence : unsupported.sentences()) kernel().log().warning("{}", sentence);
}

}  // namespace spark

SPARK_PLUGIN("scene-urdf", "1.0", "Robots in URDF, the language of ROS.", spark::UrdfImporter)
