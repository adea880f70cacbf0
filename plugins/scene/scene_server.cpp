#include "scene_server.h"

#include <algorithm>

#include "api/files.h"
#include "api/phases.h"
#include "spark/error.h"

namespace spark {

void SceneServer::describe(Description<SceneServer>& d) {
  d.doc("Holds the active scene, imports scene files, updates world matrices.");
  d.implements<ISceneServer>();
  d.link(&SceneServer::scene_, At<Node>(&SceneServer::scenePath_));
  d.link(&SceneServer::importers_, Child<ISceneImporter>());
  d.property("activeScene", &SceneServer::scenePath, &SceneServer::setScenePath)
      .doc("Path of the active scene's root.");
  d.property("flattenTransforms", &SceneServer::flattenTransforms_)
      .doc(
          "After an import, removes imported transforms that are empty or contain only transforms; their children move "
          "up.");
  d.property("modifiedCount", &SceneServer::modifiedCount)
      .ofProcess()
      .doc("Number of changes of the scene's nodes and materials so far.");
  d.method("createScene", &SceneServer::createScene)
      .parameters({"path"})
      .doc("Creates a scene root and makes it the active scene.");
  d.method("defineMesh", &SceneServer::defineMesh)
      .parameters({"mesh", "materials"})
      .doc("Declares the materials of a mesh without a file.");
  d.on<&SceneServer::onPlace>(phase::kPlace);
}

Node& SceneServer::scene() {
  if (Node* scene = scene_.get()) return *scene;
  throw Error(fmt::format("there is no scene at '{0}': make one, new(\"Scene\", \"{0}\"), or set {1}.activeScene",
                          scenePath_, path()));
}

void SceneServer::setScenePath(std::string path) {
  scenePath_ = std::move(path);
  scene_.lookAgain();
  kernel().markChanged(*this);  // caches of the active scene are updated in this cycle
}

void SceneServer::createScene(std::string path) {
  kernel().create("Scene", path);
  setScenePath(std::move(path));
}

ISceneImporter& SceneServer::importerFor(const std::string& file) {
  if (importers_.empty())
    throw Error(
        fmt::format("{0} has no importer below it: add one, for instance new(\"RsgImporter\", \"{0}/rsg\")", path()));
  if (importers_.size() == 1) return *importers_.all().front();

  // With several importers the beginning of the file decides, once for each version of the file.
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
  std::string names;
  for (const Found<ISceneImporter>& importer : importers_) names += (names.empty() ? "" : ", ") + importer.leaf->name();
  throw Error(fmt::format(
      "none of the importers below {} ({}) knows the format of '{}': its beginning says none of their languages",
      path(), names, file));
}

void SceneServer::importScene(std::string_view file, Node& root, const List& arguments) {
  const std::string name(file);
  const Ref<Node> rootAlive(&root);
  // A file may import others. Only nodes that were created since the start of the outermost import may be flattened.
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
  if (importing.outermost) kept_.clear();
  const std::uint64_t before = kernel().lastId();
  const auto list = [&] {
    if (importing.outermost && rootAlive && kernel().lastId() > before)
      imports_.push_back({name, rootAlive, arguments, before + 1, kernel().lastId()});
    forgetOldImports();
  };
  bool keeps = false;
  try {
    ISceneImporter& importer = importerFor(name);
    keeps = importer.keepsTransforms();
    importer.import(name, root, arguments);
  } catch (...) {
    list();  // nodes that were created before the error are kept
    markModified();
    throw;
  }
  if (keeps)
    kept_.emplace_back(before + 1, kernel().lastId());
  else if (flattenTransforms_ && rootAlive)
    spark::flattenTransforms(root, [&](const Leaf& node) {
      return node.id() >= firstImported_ && std::none_of(kept_.begin(), kept_.end(), [&](const auto& ids) {
               return ids.first <= node.id() && node.id() <= ids.second;
             });
    });
  list();
  markModified();
}

/// Robots come and go: imports of which nothing is left are forgotten, at each doubling of the list.
void SceneServer::forgetOldImports() {
  if (imports_.size() < forgetAt_) return;
  std::vector<Leaf*> all;
  kernel().root().collect(all);
  std::vector<std::uint64_t> ids;
  ids.reserve(all.size());
  for (const Leaf* leaf : all) ids.push_back(leaf->id());
  std::sort(ids.begin(), ids.end());
  std::erase_if(imports_, [&](const Import& i) {
    const auto next = std::lower_bound(ids.begin(), ids.end(), i.first);
    return !i.root || next == ids.end() || *next > i.last;
  });
  forgetAt_ = std::max<std::size_t>(64, 2 * imports_.size());
}

void SceneServer::place() {
  if (Node* scene = scene_.get()) placement_.place(*scene);
}

void SceneServer::placeScene(Node& scene) {
  if (&scene == scene_.get()) return place();
  std::erase_if(others_, [](const Other& o) { return !o.scene; });
  auto found = std::find_if(others_.begin(), others_.end(), [&](const Other& o) { return o.scene.get() == &scene; });
  if (found == others_.end()) found = others_.insert(found, {Ref<Node>(&scene), {}});
  found->placement.place(scene);
}

void Placement::collect(Node& node, int parent) {
  for (const auto& child : node.children()) {
    int above = parent;
    if (auto transform = child->as<Transform>()) {
      above = static_cast<int>(entries_.size());
      entries_.push_back({transform, parent, false, false, {}});
    } else if (auto follower = child->as<IFollowsTransform>(); follower && parent >= 0) {
      entries_[parent].followers.push_back(follower);
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
  // Parents come first: what happened to the transform above is known.
  for (Entry& e : entries_) {
    const Entry* above = e.parent < 0 ? nullptr : &entries_[e.parent];
    e.changed = e.transform->dirty() || (above && above->changed);
    e.moved = e.changed && e.transform->updateWorld(above && above->moved);
    if (e.moved)
      for (IFollowsTransform* follower : e.followers) follower->follow(e.transform->world());
  }
}

void flattenTransforms(Node& root, const std::function<bool(const Leaf&)>& removable) {
  // Children first. Grandchildren that move up are appended to the children of `root`, so the loop reaches them.
  for (std::size_t i = 0; i < root.children().size();) {
    Leaf& child = *root.children()[i];
    if (Node* node = child.asNode()) {
      flattenTransforms(*node, removable);
      if (child.as<Transform>() && node->children().empty() && removable(child)) {
        root.remove(child);
        continue;
      }
    }
    ++i;
  }

  // Then `root` itself, if it is a transform of the import that contains only transforms.
  auto transform = root.as<Transform>();
  if (!transform || !removable(root) || root.children().empty() || !root.parent() || !root.parent()->as<SceneNode>())
    return;
  for (const auto& child : root.children())
    if (!child->as<Transform>()) return;
  while (!root.children().empty()) {
    auto& child = *root.children().front()->as<Transform>();
    child.setLocalFromBody(transform->local() * child.local());
    root.reparent(child, *root.parent());
  }
}

}  // namespace spark
