#include "webots_importer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "api/files.h"
#include "file_index.h"
#include "meshes/mesh_file.h"
#include "robot/builder.h"
#include "robot/names.h"
#include "spark/access.h"
#include "spark/plugin.h"
#include "template_process.h"
#include "webots_reader.h"

namespace spark {

namespace {

webots::Base baseOf(std::string_view file, const List& arguments) {
  if (arguments.size() < 2) return webots::Base::byFile;
  const std::string word = arguments[1].plain();
  if (arguments.size() > 2 || (word != "fixed" && word != "free"))
    throw Error(
        fmt::format("cannot import '{}': expected a prefix for names, and 'fixed' or 'free', found '{}'", file, word));
  return word == "fixed" ? webots::Base::fixed : webots::Base::free;
}

/// Lights of viewers.
void makeLights(const std::vector<webots::Light>& lights, const std::string& prefix, Node& root) {
  mjcf::Names names(prefix);
  for (const webots::Light& light : lights) {
    Node& place = *root.create("Transform", names.in(root, light.name, "light")).asNode();
    setProperty(place, "localPos", List{light.location.x(), light.location.y(), light.location.z()});
    Leaf& made = place.create("Light", "light");
    const auto color = [](const std::array<double, 3>& c) { return List{c[0], c[1], c[2], 1.0}; };
    setProperty(made, "diffuse", color(light.diffuse));
    setProperty(made, "ambient", color(light.ambient));
    setProperty(made, "radius", light.radius);
  }
}

}  // namespace

void WebotsImporter::describe(Description<WebotsImporter>& d) {
  d.doc(
      "Imports Webots worlds and PROTO files. Arguments: a prefix for the names of its nodes; fixed or free: how "
      "robots stand.");
  d.implements<ISceneImporter>();
  d.property("strict", &WebotsImporter::strict_)
      .doc("Unsupported nodes and fields are errors; otherwise they are logged.");
  d.property("protos", &WebotsImporter::folders_)
      .doc("Folders in which files of PROTOs and meshes are looked for as well.");
}

bool WebotsImporter::recognises(std::string_view text, std::string_view file) const {
  return webots::isWebots(text) || file.ends_with(".wbt") || file.ends_with(".proto");
}

void WebotsImporter::import(std::string_view file, Node& root, const List& arguments) {
  const webots::Base base = baseOf(file, arguments);
  const std::string prefix = arguments.empty() ? "" : arguments.front().plain();
  auto& files = kernel().root().require<IFileServer>();
  webots::FileIndex index(files, std::string(file));
  webots::TemplateProcess templates(webots::TemplateProcess::path());
  const webots::Sources sources{
      [&](const std::string& name) { return files.exists(name) ? std::optional(files.read(name)) : std::nullopt; },
      [&](const std::string& request) { return templates.ask(request); }, folders_,
      [&](const std::string& name) { return index.called(name); }};
  const auto readFile = [&](const std::string& name) {
    std::vector<std::string> leftOut;
    engine::Mesh mesh = meshes::readMesh(name, files.read(name), &leftOut);
    if (!leftOut.empty())
      kernel().log().warning("{}: the mesh '{}' has {}, which do not collide", file, name, fmt::join(leftOut, ", "));
    return mesh;
  };
  const webots::ReadMesh readMesh = [&](const std::string& of, const std::string& url) {
    const std::vector<std::string> candidates = webots::fileNames(of, url, folders_);
    for (const std::string& candidate : candidates)
      if (files.exists(candidate)) return readFile(candidate);
    if (const auto& others = index.called(url.substr(url.find_last_of("/\\") + 1)); !others.empty()) {
      kernel().log().info("{}: the mesh '{}' is not in its place: '{}' is read", of, url, others.front());
      return readFile(others.front());
    }
    throw Error(fmt::format("there is no such file; looked for {}", fmt::join(candidates, ", ")));
  };
  mjcf::Unsupported unsupported;
  const webots::Document document(std::string(file), sources, unsupported);
  webots::World world = webots::readWorld(document, base, readMesh, unsupported);

  if (const auto left = unsupported.sentences(); strict_ && !left.empty()) throw Error(left.front());

  bool withoutParts = false;
  const std::size_t before = root.children().size();
  try {
    makeLights(world.lights, prefix, root);
    for (mjcf::Model& model : world.models) {
      if (!prefix.empty()) model.options.clear();  // what is put into a world has its gravity
      mjcf::Builder builder(model, prefix, strict_, unsupported);
      builder.build(root);
      withoutParts |= builder.withoutParts();
    }
  } catch (...) {
    while (root.children().size() > before) root.remove(*root.children().back());
    throw;
  }
  if (withoutParts)
    kernel().log().info(
        "{}: its joints get no perceptors and effectors: those are of the plugins gamecontrol, sensors and effectors",
        file);
  if (world.basicTimeStep)
    kernel().log().info("{}: the basicTimeStep of {} ms is ignored: the simulation has its own", file,
                        *world.basicTimeStep);
  for (const std::string& line : document.said()) kernel().log().info("a template prints: {}", line);
  for (const std::string& sentence : unsupported.sentences()) kernel().log().warning("{}", sentence);
}

}  // namespace spark

SPARK_PLUGIN("scene-webots", "1.0", "Worlds and robots of Webots.", spark::WebotsImporter)
