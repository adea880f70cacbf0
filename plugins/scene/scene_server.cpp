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
  d.property("transactionalImport", &SceneServer::transactionalImport_)
      .choices({"byLanguage", "true", "false"})
      .doc(
          "What an import that fails leaves behind: true: nothing; false: the nodes that its importer keeps; "
          "byLanguage: nothing, but those of a scene file of the installed base, (RSG 0 1), stay.");
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

/// A file that is being imported. A file may import others.
struct SceneServer::Importing {
  explicit Importing(SceneServer& s) : server(s), outer(s.importing_), mark(s.undo_.mark(s.kernel())) {
    if (!outer) server.firstImported_ = mark.lastId + 1, server.kept_.clear();
    server.importing_ = this;
  }
  ~Importing() {
    server.importing_ = outer;
    if (outer) return;
    server.firstImported_ = 0;
    server.undo_.clear();
  }
  Importing(const Importing&) = delete;
  Importing& operator=(const Importing&) = delete;

  SceneServer& server;
  Importing* outer;  ///< the import of the file that imports this one; nullptr: none does
  ImportUndo::Mark mark;
  bool undoes = false;  ///< it is undone if it fails
};

SceneServer::Known SceneServer::importerFor(const std::string& file) {
  if (importers_.empty())
    throw Error(
        fmt::format("{0} has no importer below it: add one, for instance new(\"RsgImporter\", \"{0}/rsg\")", path()));

  // The text decides, once for each version of the file.
  auto& files = kernel().root().require<IFileServer>();
  const std::uint64_t stamp = files.stamp(file);
  if (const auto known = known_.find(file);
      known != known_.end() && known->second.stamp == stamp && known->second.importer)
    return known->second;
  const std::string text = files.read(file);
  const Found<ISceneImporter> importer = recognise(file, text);
  Known known{stamp, importer, importer->transactional(text), importer->keepsTransforms(text)};
  known_.insert_or_assign(file, known);
  return known;
}

Found<ISceneImporter> SceneServer::recognise(const std::string& file, const std::string& text) const {
  if (importers_.size() == 1) return importers_.all().front();
  // What the text says goes before what its name says.
  for (const std::string_view name : {std::string_view(), std::string_view(file)})
    for (const Found<ISceneImporter>& importer : importers_)
      if (importer->recognises(text, name)) return importer;
  std::string names;
  for (const Found<ISceneImporter>& importer : importers_) names += (names.empty() ? "" : ", ") + importer.leaf->name();
  throw Error(
      fmt::format("none of the importers below {} ({}) knows the format of '{}': neither its beginning nor its name is "
                  "of one of their languages",
                  path(), names, file));
}

/// The language of the outermost file decides for all that it imports.
bool SceneServer::undoes(const Known& known) const {
  if (importing_->outer) return importing_->outer->undoes;
  return transactionalImport_ == "byLanguage" ? known.transactional : transactionalImport_ == "true";
}

void SceneServer::willChange(Leaf& node) {
  if (importing_ && importing_->undoes && node.id() <= importing_->mark.lastId) undo_.remember(node, importing_->mark);
}

void SceneServer::willRemove(Leaf& node) {
  if (importing_ && importing_->undoes && node.id() < firstImported_)
    throw Error(
        fmt::format("cannot remove {}: it was there before the import, which could not be undone then ({}"
                    ".transactionalImport)",
                    node.path(), path()));
}

void SceneServer::importScene(std::string_view file, Node& root, const List& arguments) {
  const std::string name(file);
  const Ref<Node> rootAlive(&root);
  Importing importing(*this);
  try {
    runImport(name, root, arguments, importing);
  } catch (...) {
    if (importing.undoes)
      undo_.undo(kernel(), importing.mark);
    else
      list(name, rootAlive, arguments, importing);  // nodes that were created before the error are kept
    markModified();
    throw;
  }
  list(name, rootAlive, arguments, importing);
  markModified();
}

void SceneServer::list(const std::string& file, const Ref<Node>& root, const List& arguments,
                       const Importing& importing) {
  const std::uint64_t before = importing.mark.lastId;
  if (!importing.outer && root && kernel().lastId() > before)
    imports_.push_back({file, root, arguments, before + 1, kernel().lastId()});
  forgetOldImports();
}

void SceneServer::runImport(const std::string& file, Node& root, const List& arguments, Importing& importing) {
  const Ref<Node> rootAlive(&root);
  const Known known = importerFor(file);
  importing.undoes = undoes(known);
  known.importer->import(file, root, arguments);
  if (known.keepsTransforms)
    kept_.emplace_back(importing.mark.lastId + 1, kernel().lastId());
  else if (flattenTransforms_ && rootAlive)
    spark::flattenTransforms(root, [&](const Leaf& node) {
      return node.id() >= firstImported_ && std::none_of(kept_.begin(), kept_.end(), [&](const auto& ids) {
               return ids.first <= node.id() && node.id() <= ids.second;
             });
    });
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
