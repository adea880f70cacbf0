#pragma once
/// \file
/// A kernel with physics and the importers of all languages, whose files are in memory.

#include "../../plugins/physics/tests/physics_house.h"
#include "api/scene.h"
#include "temporary_folder.h"

namespace spark::test {

/// The number of nodes below a node.
inline std::size_t countBelow(const Node& node) {
  std::size_t n = 0;
  for (const auto& child : node.children()) n += 1 + (child->asNode() ? countBelow(*child->asNode()) : 0);
  return n;
}

/// A box falls onto a plane, beside which files are imported.
struct ImportHost : PhysicsHost {
  TemporaryFolder folder;
  Node& place;

  ImportHost() : place(make(*this)) {}
  static Node& make(ImportHost& h) {
    for (const char* plugin :
         {"files", "scene-rsg", "scene-mjcf", "scene-urdf", "scene-webots", "gamecontrol", "sensors", "effectors"})
      h.kernel.plugins().use(plugin);
    h.kernel.create("FileServer", "/sys/server/file");
    setProperty(h.kernel.create("DirectoryFileSystem", "/sys/server/file/folder"), "path", h.folder.path().string());
    h.kernel.create("MaterialServer", "/sys/server/material");
    for (const auto& [name, type] : {std::pair{"rsg", "RsgImporter"},
                                     {"mjcf", "MjcfImporter"},
                                     {"urdf", "UrdfImporter"},
                                     {"webots", "WebotsImporter"}})
      h.kernel.create(type, std::string("/sys/server/scene/") + name);
    call(h.kernel.create("PlaneCollider", "/usr/scene/space/ground"), "setParams", List{0, 0, 1, 0});
    h.box("crate", {3, 0, 0.4}, {0.5, 0.5, 0.5});
    return h.transform(h.scene, "place", {0, 0, 0.5});
  }
  void import(const std::string& file, const List& arguments = {}) {
    kernel.root().require<ISceneServer>().importScene(file, place, arguments);
  }
  /// The message of the error of an import; "" if it succeeds.
  std::string failure(const std::string& file) {
    try {
      import(file);
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  }
  void setTransactional(const char* value) {
    setProperty(*kernel.root().find(ISceneServer::kPath), "transactionalImport", value);
  }
  std::uint64_t hash() { return stateHash(kernel.root()); }
};

}  // namespace spark::test
