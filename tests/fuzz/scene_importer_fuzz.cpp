// The importer of scene files, run on arbitrary files and arguments with all classes of the `scene` plugin.
//
// Input: one byte of switches, then chunks that end with a zero byte: the file a.rsg, the file b.rsg (which a.rsg may
// import), and arguments. For any input, the import succeeds or throws an Error, within its limits, and the scene can
// be removed. An import of a file of version 0.2 that fails leaves as many nodes as before.

#include <cstdlib>
#include <map>

#include "../../plugins/scene-rsg/rsg_importer.h"
#include "../../plugins/scene/materials.h"
#include "../../plugins/scene/scene_server.h"
#include "../../plugins/scene/variables.h"
#include "../../plugins/scene/visuals.h"
#include "spark/error.h"
#include "spark/kernel.h"

namespace {

using namespace spark;

constexpr std::int64_t kMaxNodes = 200;

/// Two files whose contents are set for each input.
class TwoFiles : public Leaf, public IFileServer {
  SPARK_CLASS(TwoFiles, Leaf)
 public:
  static void describe(Description<TwoFiles>& d) {
    d.doc("Two files.");
    d.implements<IFileServer>();
  }
  std::string read(std::string_view name) override {
    const auto found = files.find(name);
    if (found == files.end()) throw Error("no such file");
    return found->second;
  }
  bool exists(std::string_view name) override { return files.contains(name); }
  std::uint64_t stamp(std::string_view name) override { return exists(name) ? round : 0; }
  std::map<std::string, std::string, std::less<>> files;
  std::uint64_t round = 0;
};

struct Host {
  Kernel kernel;
  TwoFiles* files = nullptr;
  Leaf* importer = nullptr;
  ISceneServer* server = nullptr;

  Host() {
    kernel.log().setLevel(Level::off);
    registerAll<SceneNode, Transform, Scene, SceneServer, Light, Camera, Axis, RenderNode, StaticMesh, SingleMatNode,
                Box, Sphere, Capsule, Cylinder, MaterialSolid, MaterialServer, Variables, RsgImporter, TwoFiles>();
    files = &kernel.create<TwoFiles>("TwoFiles", "/sys/server/file");
    server = &kernel.create<ISceneServer>("SceneServer", "/sys/server/scene");
    importer = &kernel.create("RsgImporter", "/sys/server/scene/rsg");
    kernel.create("MaterialServer", "/sys/server/material");
    kernel.create("Scene", "/usr/scene");
    callMethod(kernel.create("Variables", "/sys/variables/Soccer"), "set", List{"FieldLength", 30.0});
    setProperty(kernel.create("Variables", "/sys/variables/Type"), "value",
                List{List{List{"key", "true"}}, List{1, 2.5}});
    setProperty(*importer, "maxNodes", kMaxNodes);
    setProperty(*importer, "maxImports", 60);
    setProperty(*importer, "maxDepth", 8);
  }
  template <class... T>
  void registerAll() {
    (kernel.registerClass<T>(), ...);
  }
};

std::size_t count(const Node& node) {
  std::size_t n = 0;
  for (const auto& child : node.children()) n += 1 + (child->asNode() ? count(*child->asNode()) : 0);
  return n;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static Host host;
  if (size == 0) return 0;
  const unsigned switches = data[0];
  std::vector<std::string> chunks(1);
  for (std::size_t i = 1; i < size; ++i) {
    if (data[i] == 0)
      chunks.emplace_back();
    else
      chunks.back() += static_cast<char>(data[i]);
  }
  host.files->files.clear();
  ++host.files->round;
  const bool ours = (switches & 64) != 0;
  host.files->files["a.rsg"] = (ours ? "(RSG 0 2)" : switches & 1 ? "(RSG 0 1)" : "") + chunks[0];
  if (chunks.size() > 1) host.files->files["b.rsg"] = (switches & 2 ? "(RSG 0 1)" : "") + chunks[1];
  List arguments;
  for (std::size_t i = 2; i < chunks.size(); ++i) arguments.emplace_back(chunks[i]);
  setProperty(*host.importer, "strict", (switches & 4) != 0);
  setProperty(*host.importer, "defineByName", (switches & 8) == 0);
  setProperty(*host.importer, "integerDivision", (switches & 16) != 0);
  setProperty(*host.importer, "looseArguments", (switches & 32) == 0);

  Node& scene = host.server->scene();
  for (int twice = 0; twice < 2; ++twice) {
    const std::size_t before = count(scene);
    try {
      host.server->importScene("a.rsg", scene, arguments);
    } catch (const Error&) {
      if (ours && count(scene) != before) std::abort();
    }
    if (count(scene) > static_cast<std::size_t>(kMaxNodes) * 2) std::abort();
    host.server->place();
  }
  scene.removeChildren();
  scene.setName("scene");  // a file's top-level calls act on its root, so they may have renamed it
  return 0;
}
