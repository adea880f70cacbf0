#include "mjcf_importer.h"

#include <fmt/ranges.h>

#include "api/files.h"
#include "builder.h"
#include "mesh_file.h"
#include "spark/plugin.h"

namespace spark {

void MjcfImporter::describe(Description<MjcfImporter>& d) {
  d.doc("Imports models in MJCF, MuJoCo's language. Argument: a prefix for the names of its nodes.");
  d.implements<ISceneImporter>();
  d.property("strict", &MjcfImporter::strict_)
      .doc("Elements and attributes that it leaves out are errors; else they are named in the log.");
  d.property("imports", &MjcfImporter::imports_).readOnly().doc("Models imported so far.");
}

bool MjcfImporter::recognises(std::string_view text) const {
  return text.substr(0, 4096).find("<mujoco") != std::string_view::npos &&
         text.find('<') == text.find_first_not_of(" \t\r\n");
}

void MjcfImporter::import(std::string_view file, Node& root, const List& arguments) {
  if (arguments.size() > 1)
    throw Error(
        fmt::format("cannot import '{}': expected one argument, a prefix for names, found {}", file, arguments.size()));
  auto& files = kernel().root().require<IFileServer>();
  mjcf::LeftOver leftOver;
  mjcf::Document document(std::string(file), [&](const std::string& name) { return files.read(name); });
  const mjcf::Model model = mjcf::readModel(
      document, [&](const std::string& name) { return mjcf::readMesh(name, files.read(name)); }, leftOver);
  mjcf::Builder builder(model, arguments.empty() ? "" : arguments.front().plain(), leftOver);
  const std::vector<std::string> before = leftOver.sentences();
  if (strict_ && !before.empty()) throw Error(fmt::format("{}", fmt::join(before, "; ")));
  builder.build(root);
  ++imports_;
  if (builder.withoutParts())
    kernel().log().info(
        "{}: its sensors and actuators become no perceptors and effectors: those are of the plugins gamecontrol, "
        "sensors and effectors",
        file);
  for (const std::string& sentence : leftOver.sentences()) kernel().log().warning("{}", sentence);
}

}  // namespace spark

SPARK_PLUGIN("scene-mjcf", "1.0", "Models in MJCF, MuJoCo's language.", spark::MjcfImporter)
