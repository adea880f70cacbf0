#include "convert.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "api/scene.h"
#include "compare_trees.h"
#include "host.h"
#include "program.h"
#include "spark/error.h"
#include "spark/output_file.h"

namespace sparkhost {

using namespace spark;
namespace fs = std::filesystem;

namespace {

constexpr const char *kModel = "/usr/scene/model", *kWorld = "/usr/scene/world", *kWriter = "/sys/host/writer";

/// The values of a node and of all below it, by property and path.
void collectValues(const Leaf& leaf, std::vector<std::pair<std::string, Value>>& out) {
  for (const Property* p : leaf.classObject()->properties())
    if (!p->readOnly && !p->ofProcess) out.emplace_back(leaf.path() + '.' + p->name, p->get(leaf));
  if (const Node* node = leaf.asNode())
    for (const auto& child : node->children()) collectValues(*child, out);
}

/// A simulation into which a file is imported, without a run.
class Scene {
 public:
  explicit Scene(const Options& options) : host_(options) { host_.build(); }
  Kernel& kernel() { return host_.kernel(); }
  Node& model() { return kernel().root().require<Node>(kModel); }

  /// Imports a file, a path or a resource, below the model.
  void import(const std::string& name) {
    kernel().create("BaseNode", kModel);
    std::string resource = name;
    if (fs::is_regular_file(name)) {
      // Files that it names are found beside it, and around it as a resource where there are such.
      const fs::path file = fs::absolute(name).lexically_normal();
      Leaf& folder = kernel().create("DirectoryFileSystem", "/sys/server/file/converted");
      setProperty(folder, "path", file.parent_path().string());
      resource = file.filename().string();
    }
    const auto errors = kernel().log().errors();
    kernel().root().require<ISceneServer>().importScene(resource, model(), {});
    if (kernel().log().errors() != errors)
      throw Error(fmt::format("'{}' was imported in part only: see the errors in the log above", name));
    if (Leaf* const physics = kernel().root().find("/sys/server/physics")) callMethod(*physics, "settle", {});
  }
  std::vector<std::pair<std::string, Value>> worldValues() {
    std::vector<std::pair<std::string, Value>> out;
    if (const Leaf* const world = kernel().root().find(kWorld)) collectValues(*world, out);
    return out;
  }

 private:
  Host host_;
};

/// Names the properties of the world that the import set: they are the world's, and no file can have them.
void warnOfWorld(const std::vector<std::pair<std::string, Value>>& before, Scene& scene) {
  for (const auto& value : scene.worldValues()) {
    if (std::find(before.begin(), before.end(), value) != before.end()) continue;
    scene.kernel().log().warning("the file sets {} = {}, which is the world's: set it in the config", value.first,
                                 value.second.text());
  }
}

}  // namespace

void convert(const Options& options, const std::string& in, const std::string& out) {
  refuseSameFile(out, in, "the file that is converted");
  FileDraft draft(out, "the scene");
  Scene original(options);
  const auto world = original.worldValues();
  original.import(in);
  warnOfWorld(world, original);
  Leaf& writer = original.kernel().create("SceneWriter", kWriter);
  draft.write(callMethod(writer, "text", std::vector<Value>{kModel}).plain());

  // The converted file is complete, or is not there.
  Scene converted(options);
  converted.import(draft.name());
  if (const std::string found = differenceOf(original.model(), converted.model()); !found.empty())
    throw Error(fmt::format("the scene language cannot express '{}': {}", in, found));
  draft.finish();
}

}  // namespace sparkhost
