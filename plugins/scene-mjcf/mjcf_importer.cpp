#include "mjcf_importer.h"

#include <algorithm>

#include "api/files.h"
#include "builder.h"
#include "mesh_file.h"
#include "spark/plugin.h"

namespace spark {

void MjcfImporter::describe(Description<MjcfImporter>& d) {
  d.doc("Imports models in MJCF, MuJoCo's language. Argument: a prefix for the names of its nodes.");
  d.implements<ISceneImporter>();
  d.property("strict", &MjcfImporter::strict_)
      .doc("Unsupported elements and attributes are errors; otherwise they are logged.");
  d.property("imports", &MjcfImporter::imports_).readOnly().doc("Models imported so far.");
}

bool MjcfImporter::recognises(std::string_view text) const {
  constexpr std::string_view kMark = "\xef\xbb\xbf";  // of UTF-8
  if (text.starts_with(kMark)) text.remove_prefix(kMark.size());
  // Declaration and comments come first.
  while (true) {
    text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
    const std::string_view end = text.starts_with("<!--") ? "-->"
                                 : text.starts_with("<?") ? "?>"
                                 : text.starts_with("<!") ? ">"
                                                          : "";
    if (end.empty()) return text.starts_with("<mujoco");
    const std::size_t at = text.find(end);
    if (at == std::string_view::npos) return false;
    text.remove_prefix(at + end.size());
  }
}

void MjcfImporter::import(std::string_view file, Node& root, const List& arguments) {
  if (arguments.size() > 1)
    throw Error(
        fmt::format("cannot import '{}': expected one argument, a prefix for names, found {}", file, arguments.size()));
  auto& files = kernel().root().require<IFileServer>();
  mjcf::Unsupported unsupported;
  mjcf::Document document(std::string(file), [&](const std::string& name) { return files.read(name); });
  const mjcf::Model model = mjcf::readModel(
      document, [&](const std::string& name) { return mjcf::readMesh(name, files.read(name)); }, unsupported);
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
