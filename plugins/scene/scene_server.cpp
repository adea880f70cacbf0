#include "scene_server.h"

#include "api/files.h"
#include "api/phases.h"
#include "spark/error.h"

namespace spark {

void SceneServer::describe(Description<SceneServer>& d) {
  d.doc("Holds the active scene, imports scene files, keeps world matrices up to date.");
  d.implements<ISceneServer>();
  d.link(&SceneServer::scene_, At<Node>(&SceneServer::scenePath_));
  d.link(&SceneServer::importers_, Child<ISceneImporter>());
  d.property("activeScene", &SceneServer::scenePath, &SceneServer::setScenePath)
      .doc("Path of the active scene's root.");
  d.property("flattenTransforms", &SceneServer::flattenTransforms_)
      .doc(
          "After an import, transforms of its own that hold nothing but transforms, and empty ones, go; their children "
          "move up.");
  d.property("modifiedCount", &SceneServer::modifiedCount).doc("How often nodes or materials of the scene changed.");
  d.method("createScene", &SceneServer::createScene)
      .parameters({"path"})
      .doc("Makes a scene root and the active scene of it.");
  d.method("defineMesh", &SceneServer::defineMesh)
      .parameters({"mesh", "materials"})
      .doc("Says which materials a mesh has, for meshes whose file is not there.");
  d.on<&SceneServer::onPlace>(phase::kPlace);
}

Node& SceneServer::scene() {
  if (Node* scene = scene_.get()) return *scene;
  throw Error("there is no scene at '" + scenePath_ + "': make one, new(\"Scene\", \"" + scenePath_ + "\"), or set " +
              path() + ".activeScene");
}

void SceneServer::setScenePath(std::string path) {
  scenePath_ = std::move(path);
  scene_.lookAgain();
  kernel().markChanged(*this);  // whoever remembers what is in the active scene looks again, in this very cycle
}

void SceneServer::createScene(std::string path) {
  kernel().create("Scene", path);
  setScenePath(std::move(path));
}

ISceneImporter& SceneServer::importerFor(const std::string& file) {
  if (importers_.empty())
    throw Error(path() + " has no importer below it: add one, for instance new(\"RsgImporter\", \"" + path() +
                "/rsg\")");
  if (importers_.size() == 1) return *importers_.all().front();

  auto& files = kernel().root().require<IFileServer>();
  const std::uint64_t stamp = files.stamp(file);
  if (const auto known = known_.find(file);
      known != known_.end() && known->second.stamp == stamp && known->second.importer)
    return *known->second.importer;
  const std::string text = files.read(file);
  for (const Found<ISceneImporter>& importer : importers_)
    if (importer->recognises(text)) {
      known_.insert_or_assign(file, Known{stamp, importer});
      return *importer;
    }
  throw Error("none of the " + std::to_string(importers_.size()) + " importers below " + path() +
              " knows the format of '" + file + "'");
}

void SceneServer::importScene(std::string_view file, Node& root, const List& arguments) {
  const std::string name(file);
  const Ref<Node> rootAlive(&root);
  // Files import files: what the outermost import found there is not its to dissolve.
  struct Importing {
    Importing(std::uint64_t& f, std::uint64_t last) : first(f), outermost(f == 0) {
      if (outermost) first = last + 1;
    }
    ~Importing() {
      if (outermost) first = 0;
    }
    std::uint64_t& first;
    bool outermost;
  } importing(firstImported_, kernel().lastId());
  try {
    importerFor(name).import(name, root, arguments);
  } catch (...) {
    markModified();  // what it made before stays
    throw;
  }
  if (flattenTransforms_ && rootAlive) spark::flattenTransforms(root, firstImported_);
  markModified();
}

void SceneServer::place() {
  if (Node* scene = scene_.get()) placement_.place(*scene);
}

void Placement::collect(Node& node, int parent) {
  for (const auto& child : node.children()) {
    int above = parent;
    if (auto transform = child->as<Transform>()) {
      above = static_cast<int>(entries_.size());
      entries_.push_back({transform, parent, false, false, {}});
    } else if (auto follower = child->as<IFollowsTransform>(); follower && parent >= 0) {
      entries_[static_cast<std::size_t>(parent)].followers.push_back(follower);
    }
    if (Node* inner = child->asNode()) collect(*inner, above);
  }
}

void Placement::place(Node& scene) {
  if (tree_.changed(scene) || scene_ != &scene) {
    entries_.clear();
    collect(scene, -1);
    scene_ = &scene;
  }
  for (Entry& e : entries_) {
    const Entry* above = e.parent < 0 ? nullptr : &entries_[static_cast<std::size_t>(e.parent)];
    e.changed = e.transform->dirty() || (above && above->changed);
    e.moved = e.changed && e.transform->updateWorld(above && above->moved);
    if (e.moved)
      for (IFollowsTransform* follower : e.followers) follower->follow(e.transform->world());
  }
}

void flattenTransforms(Node& root, std::uint64_t firstId) {
  // Children that move up are appended to `root` and seen by the same loop.
  for (std::size_t i = 0; i < root.children().size();) {
    Leaf& child = *root.children()[i];
    if (Node* node = child.asNode()) {
      flattenTransforms(*node, firstId);
      if (child.id() >= firstId && child.as<Transform>() && node->children().empty()) {
        root.remove(child);
        continue;
      }
    }
    ++i;
  }
  auto transform = root.id() >= firstId ? root.as<Transform>() : nullptr;
  if (!transform || root.children().empty() || !root.parent() || !root.parent()->as<SceneNode>()) return;
  for (const auto& child : root.children())
    if (!child->as<Transform>()) return;
  while (!root.children().empty()) {
    auto& child = *root.children().front()->as<Transform>();
    child.setLocalFromBody(transform->local() * child.local());
    root.reparent(child, *root.parent());
  }
}

}  // namespace spark
