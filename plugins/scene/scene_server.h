#pragma once
/// \file
/// The scene server: the active scene, imports, transforms.

#include <map>

#include "api/scene.h"
#include "mesh_library.h"

namespace spark {

/// Root of a scene (`/usr/scene`).
class Scene : public SceneNode {
  SPARK_CLASS(Scene, SceneNode)
 public:
  static void describe(Description<Scene>& d) {
    d.doc("Root of a scene; what is below it is placed in the world frame.");
  }
};

/// All transforms of a scene, top-down, with what follows them; made anew when the tree's shape changed.
class Placement {
 public:
  /// Brings the world matrices below `scene` up to date. Costs one look at each transform that did not change.
  void place(Node& scene);

 private:
  struct Entry {
    Transform* transform;
    int parent;  ///< index of the next transform above, -1 for none
    bool changed = false, moved = false;
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
  void markModified() override { ++modified_; }
  std::uint64_t modifiedCount() const override { return modified_; }
  void place() override;

  /// Material lists of meshes.
  MeshLibrary& meshes() { return meshes_; }

 private:
  struct Known {
    std::uint64_t stamp;
    Ref<ISceneImporter> importer;
  };
  ISceneImporter& importerFor(const std::string& file);
  void createScene(std::string path);
  void defineMesh(std::string mesh, std::vector<std::string> materials) {
    meshes_.define(std::move(mesh), std::move(materials));
  }
  void onPlace(const Event&) { place(); }
  const std::string& scenePath() const { return scenePath_; }
  void setScenePath(std::string path);

  std::string scenePath_ = "/usr/scene";
  bool flattenTransforms_ = true;
  std::uint64_t modified_ = 0;
  std::uint64_t firstImported_ = 0;  ///< id from which on nodes are those of the import under way; 0: none is
  Link<Node> scene_;
  Links<ISceneImporter> importers_;
  Placement placement_;
  MeshLibrary meshes_;
  std::map<std::string, Known, std::less<>> known_;
};

/// Takes away, below and including `root`, transforms that place nothing but transforms (and empty ones): their
/// children move up. World poses stay. (scene-language section 1.11) Those with an id below `firstId` stay: others made
/// them, and may hold them.
void flattenTransforms(Node& root, std::uint64_t firstId = 0);

}  // namespace spark
