#include "mjcf_importer.h"

#include <fmt/format.h>

#include "api/files.h"
#include "height_file.h"
#include "meshes/mesh_file.h"
#include "robot/builder.h"
#include "spark/plugin.h"

namespace spark {

void MjcfImporter::describe(Description<MjcfImporter>& d) {
  d.doc("Imports models in MJCF, MuJoCo's language. Argument: a prefix for the names of its nodes.");
  d.implements<ISceneImporter>();
  d.property("strict", &MjcfImporter::strict_)
      .doc("What is not supported, mended or left out is an error; otherwise it is logged.");
  d.property("imports", &MjcfImporter::imports_).readOnly().doc("Models imported so far.");
}

bool MjcfImporter::recognises(std::string_view text, std::string_view file) const {
  return mjcf::firstTag(text) == "mujoco" || file.ends_with(".mjcf") || file.ends_with(".xml");
}

void MjcfImporter::import(std::string_view file, Node& root, const List& arguments) {
  if (arguments.size() > 1)
    throw Error(
        fmt::format("cannot import '{}': expected one argument, a prefix for names, found {}", file, arguments.size()));
  auto& files = kernel().root().require<IFileServer>();
  mjcf::Unsupported unsupported;
  mjcf::Document document(std::string(file), [&](const std::string& name) { return files.read(name); });
  const auto readMesh = [&](const std::string& name) {
    std::vector<std::string> leftOut;
    engine::Mesh mesh = meshes::readMesh(name, files.read(name), &leftOut);
    for (const std::string& what : leftOut)
      unsupported.add(document.root(), fmt::format("the mesh '{}' has {}, which do not collide", name, what));
    return mesh;
  };
  const auto readHeights = [&](const std::string& name) { return mjcf::readHeightFile(name, files.read(name)); };
  const mjcf::Model model = mjcf::readModel(document, readMesh, unsupported, readHeights);
  mjcf::Builder builder(model, arguments.empty() ? "" : arguments.front().plain(), strict_, unsupported);
  builder.build(root);
  ++imports_;
  if (builder.withoutParts())
    kernel().log().info(
        "{}: its sensors and actuators become no perceptors and effectors: those are of the plugins gamecontrol, "
        "sensors and effectors",
        file);
  for (const std::string& sentence : unsupported.sentences()) kernel().log().warning("{}", sentence);
}

}  // namespace spark

SPARK_PLUGIN("scene-mjcf", "1.0", "Models in MJCF, MuJoCo's language.", spark::MjcfImporter)
