#pragma once
/// \file
/// The scene server: the active scene, imports, world matrices.

#include <functional>
#include <map>

#include "api/scene.h"
#include "import_undo.h"
#include "mesh_library.h"

namespace spark {

/// Root of a scene (`/usr/scene`).
class Scene : public SceneNode {
  SPARK_CLASS(Scene, SceneNode)
 public:
  static void describe(Description<Scene>& d) { d.doc("Root of a scene: the world frame of all nodes below it."); }
};

/// A list of all transforms of a scene, parents first, with the nodes that follow them. It is built again when the
/// shape of the tree changed.
class Placement {
 public:
  /// Updates the world matrices below `scene`. A transform that did not change costs one check.
  void place(Node& scene);

 private:
  struct Entry {
    Transform* transform;
    int parent;            ///< index of the nearest transform above; -1: none
    bool changed = false;  ///< in this update: the world matrix was computed again
    bool moved = false;    ///< in this update: moved by hand, or below one that was
    std::vector<IFollowsTransform*> followers;
  };
  void collect(Node& node, int parent);
  std::vector<Entry> entries_;
  Node* scene_ = nullptr;
  TreeWatch tree_;
};

/// Holds the active scene, imports scene files through the importers below it, and keeps world matrices up to date.
class SceneServer : public Node, public ISceneServer {
  SPARK_CLASS(SceneServer, Node)
 public:
  static void describe(Description<SceneServer>& d);

  Leaf& leaf() override { return *this; }
  Node* activeScene() override { return scene_.get(); }
  Node& scene() override;
  void importScene(std::string_view file, Node& root, const List& arguments) override;
  void willChange(Leaf& node) override;
  void willRemove(Leaf& node) override;
  void markModified() override { ++modified_; }
  std::uint64_t modifiedCount() const override { return modified_; }
  void place() override;
  void placeScene(Node& scene) override;
  const std::vector<Import>& imports() const override { return imports_; }

  /// The materials of meshes.
  MeshLibrary& meshes() { return meshes_; }

 private:
  /// The importer of a file, and what it says of the file's text.
  struct Known {
    std::uint64_t stamp;  ///< of the file when its format was recognised
    Ref<ISceneImporter> importer;
    bool transactional, keepsTransforms;
  };
  /// A file that is being imported.
  struct Importing;
  /// The first importer that recognises the format of `file`. Throws Error when there is none.
  Known importerFor(const std::string& file);
  Found<ISceneImporter> recognise(const std::string& file, const std::string& text) const;
  void runImport(const std::string& file, Node& root, const List& arguments, Importing& importing);
  bool undoes(const Known& known) const;
  /// Adds what the outermost import created to imports().
  void list(const std::string& file, const Ref<Node>& root, const List& arguments, const Importing& importing);
  void forgetOldImports();
  void createScene(std::string path);
  void defineMesh(std::string mesh, std::vector<std::string> materials) {
    meshes_.define(std::move(mesh), std::move(materials));
  }
  void onPlace(const Event&) { place(); }
  const std::string& scenePath() const { return scenePath_; }
  void setScenePath(std::string path);

  std::string scenePath_ = kDefaultScene;
  bool flattenTransforms_ = true;
  std::string transactionalImport_ = "byLanguage";
  std::uint64_t modified_ = 0;
  std::uint64_t firstImported_ = 0;  ///< first id of the nodes of the outermost import; 0: there is none
  Importing* importing_ = nullptr;   ///< the innermost import
  ImportUndo undo_;
  /// First and last ids of the nodes in the current import whose importers keep their transforms.
  std::vector<std::pair<std::uint64_t, std::uint64_t>> kept_;
  std::vector<Import> imports_;
  std::size_t forgetAt_ = 64;  ///< number of imports at which forgetOldImports() looks
  Link<Node> scene_;
  Links<ISceneImporter> importers_;
  /// A scene beside the active one.
  struct Other {
    Ref<Node> scene;
    Placement placement;
  };
  Placement placement_;
  std::vector<Other> others_;
  MeshLibrary meshes_;
  std::map<std::string, Known, std::less<>> known_;  ///< by file
};

/// Removes the transforms at and below `root` that are empty or contain only transforms; their children move up. World
/// poses are unchanged (scene-language section 1.11). Only those that `removable` agrees to: others existed before the
/// import, and other code may refer to them.
void flattenTransforms(Node& root, const std::function<bool(const Leaf&)>& removable);

}  // namespace spark
