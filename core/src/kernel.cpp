#include "spark/kernel.h"

#include <algorithm>
#include <mutex>

#include "spark/error.h"
#include "spark/random.h"

namespace spark {

namespace {
/// Describes the two classes that everything derives from; they have no describe() of their own.
ClassDescription plainClass(const char* name, const char* base, const char* doc, std::unique_ptr<Leaf> (*make)()) {
  ClassDescription d;
  d.name = name;
  d.base = base;
  d.doc = doc;
  d.make = make;
  Property p;
  p.name = "name";
  p.type = "string";
  p.doc = "The name below its parent.";
  p.get = [](const Leaf& l) { return Value(l.name()); };
  p.set = [](Leaf& l, Args& a) { l.setName(Convert<std::string>::from(a)); };
  Method path;
  path.name = "getFullPath";
  path.doc = "The path from the root.";
  path.returns = "string";
  path.call = [](Leaf& l, Args&) { return Value(l.path()); };
  Method isLeaf;
  isLeaf.name = "isLeaf";
  isLeaf.doc = "True when it cannot have children.";
  isLeaf.returns = "bool";
  isLeaf.call = [](Leaf& l, Args&) { return Value(l.asNode() == nullptr); };
  Method unlink;
  unlink.name = "unlinkLeaf";
  unlink.doc = "Removes it, with all below it, from its parent.";
  unlink.call = [](Leaf& l, Args&) {
    if (l.parent()) l.parent()->remove(l);
    return Value();
  };
  if (*base == 0) {
    d.properties.push_back(p);
    d.methods = {path, isLeaf, unlink};
  } else {
    Method children;
    children.name = "unlinkChildren";
    children.doc = "Removes all children, first to last.";
    children.call = [](Leaf& l, Args&) {
      l.asNode()->removeChildren();
      return Value();
    };
    d.methods = {children};
  }
  return d;
}
}  // namespace

Kernel::Kernel() : events_(std::make_unique<Events>(*this)) {
  addClass(plainClass("Leaf", "", "A named element of the tree.",
                      []() -> std::unique_ptr<Leaf> { return std::make_unique<Leaf>(); }),
           nullptr);
  addClass(plainClass("Node", "Leaf", "An element that owns children.",
                      []() -> std::unique_ptr<Leaf> { return std::make_unique<Node>(); }),
           nullptr);
  ClassDescription classClass = describeClass<ClassObject>();
  classClass.make = nullptr;
  addClass(std::move(classClass), nullptr);
  ClassDescription pluginClass = describeClass<Plugin>();
  addClass(std::move(pluginClass), nullptr);

  auto root = classOf("Node").create();
  root_.reset(static_cast<Node*>(root.release()));
  root_->setName("");
  root_->linked_ = true;
  classesNode_ = root_->create("Node", "classes").asNode();
  pluginsNode_ = root_->create("Node", "plugins").asNode();
  root_->create<Node>("Node", "sys").create("Node", "server");
  root_->create("Node", "usr");
  for (auto& [name, c] : classIndex_) classesNode_->attach(std::unique_ptr<Leaf>(c));
  loader_ = std::make_unique<Loader>(*this);
  lua_ = std::make_unique<Lua>(*this);
}

// Order of the end: scripts (they hold references), the tree but for classes and plugins, then class objects, then the
// plugins' files.
Kernel::~Kernel() {
  lua_.reset();
  for (const char* top : {"usr", "sys"})
    while (Leaf* l = root_->child(top)) root_->detach(*l);
  for (std::size_t i = root_->children_.size(); i-- > 0; i = std::min(i, root_->children_.size()))
    if (Leaf* l = root_->children_[i].get(); l != classesNode_ && l != pluginsNode_) root_->detach(*l);
  loader_.reset();
  // Class objects count their products; the nodes that remain go before their classes.
  classesNode_->forgetNames();
  std::vector<std::unique_ptr<Leaf>> classes = std::move(classesNode_->children_);
  classesNode_->children_.clear();
  root_->detach(*classesNode_);
  root_->detach(*pluginsNode_);
  root_.reset();
  classIndex_.clear();
}

ClassObject& Kernel::addClass(ClassDescription description, Plugin* plugin) {
  if (ClassObject* other = findClass(description.name))
    throw Error("class '" + description.name + "' is registered already, by " +
                (other->plugin() ? "plugin '" + other->plugin()->name() + "'" : "the kernel") +
                ". Two plugins cannot provide one name: use only one of them.");
  auto made = std::make_unique<ClassObject>(std::move(description), plugin);
  ClassObject& c = *made;
  c.kernel_ = this;
  ClassObject* meta = findClass("Class");
  c.class_ = meta ? meta : &c;
  if (c.name() == "Class")
    for (auto& [n, other] : classIndex_) other->class_ = &c;
  c.id_ = nextId_++;
  classIndex_.emplace(c.name(), &c);
  if (classesNode_) {
    // Kept in order of name.
    auto& list = classesNode_->children_;
    classesNode_->attach(std::move(made));
    for (std::size_t i = list.size() - 1; i > 0 && list[i]->name() < list[i - 1]->name(); --i)
      std::swap(list[i], list[i - 1]);
  } else {
    made.release();  // the constructor hands the first classes to the tree
  }
  return c;
}

ClassObject* Kernel::findClass(std::string_view name) const {
  const auto it = classIndex_.find(name);
  if (it != classIndex_.end()) return it->second;
  const std::size_t slash = name.rfind('/');
  return slash == std::string_view::npos ? nullptr : findClass(name.substr(slash + 1));
}

ClassObject& Kernel::classOf(std::string_view name) {
  if (ClassObject* c = findClass(name)) return *c;
  if (loader_)
    if (Plugin* p = loader_->providerOf(name))
      throw Error("there is no class '" + std::string(name) + "' yet: plugin '" + p->name() +
                  "' provides it. Add plugin \"" + p->name() + "\" to the config.");
  std::vector<std::string> names;
  for (const auto& [n, c] : classIndex_) names.push_back(n);
  if (pluginsNode_)
    for (const auto& p : pluginsNode_->children())
      for (const std::string& n : static_cast<Plugin&>(*p).classes()) names.push_back(n);
  throw Error("there is no class '" + std::string(name) + "'." + didYouMean(name, names));
}

std::vector<ClassObject*> Kernel::classes() const {
  std::vector<ClassObject*> out;
  for (const auto& [n, c] : classIndex_) out.push_back(c);
  return out;
}

void Kernel::throwLacks(const Leaf& leaf, const InterfaceId& id) {
  throw Error("expected a " + std::string(id.name) + ", found " + leaf.path() + " of class " +
              leaf.classObject()->name() + ", which lacks interface " + id.name + " version " +
              std::to_string(id.version));
}

Leaf& Kernel::create(std::string_view className, std::string_view path) {
  if (path.empty() || path.front() != '/')
    throw Error("expected an absolute path for a new " + std::string(className) + ", found '" + std::string(path) +
                "'");
  ClassObject& c = classOf(className);
  Node* at = root_.get();
  const std::size_t last = path.rfind('/');
  std::string_view above = path.substr(0, last);
  while (!above.empty()) {
    above.remove_prefix(1);
    const std::size_t n = std::min(above.find('/'), above.size());
    const std::string_view part = above.substr(0, n);
    above.remove_prefix(n);
    if (part.empty()) continue;
    Leaf* next = at->child(part);
    if (!next) next = &at->create("Node", part);
    if (!next->asNode())
      throw Error("cannot make " + std::string(path) + ": " + next->path() + " cannot have children");
    at = next->asNode();
  }
  const std::string_view name = path.substr(last + 1);
  if (name.empty()) throw Error("expected a name at the end of '" + std::string(path) + "'");
  if (at->child(name))
    throw Error("cannot make " + std::string(path) + ": it exists already, as " +
                at->child(name)->classObject()->name());
  auto leaf = c.create();
  leaf->setName(std::string(name));
  return at->add(std::move(leaf));
}

void Kernel::changed(Node* node) {
  ++structureVersion_;
  for (; node; node = node->parent_) node->changedAt_ = structureVersion_;
}

void Kernel::markChanged(Leaf& leaf) {
  if (leaf.isLinked()) changed(leaf.parent());
}

void Kernel::updateOrder() {
  if (orderedAt_ == structureVersion_) return;
  orderedAt_ = structureVersion_;
  order_.clear();
  std::uint32_t post = 0;
  enumerate(*root_, post);
}

void Kernel::enumerate(Leaf& leaf, std::uint32_t& post) {
  leaf.preOrder_ = static_cast<std::uint32_t>(order_.size());
  order_.push_back(&leaf);
  if (Node* node = leaf.asNode())
    for (const auto& c : node->children()) enumerate(*c, post);
  leaf.lastBelow_ = static_cast<std::uint32_t>(order_.size() - 1);
  leaf.postOrder_ = post++;
}

std::uint64_t Kernel::streamSeed(const Leaf& owner, std::string_view purpose) {
  static_assert(sizeof(std::size_t) == 8);
  const std::string key =
      owner.path() + "\n" + (owner.classObject() ? owner.classObject()->name() : "") + "\n" + std::string(purpose);
  const std::uint64_t h = hashBytes(key);
  const std::lock_guard lock(streamMutex_);
  const std::uint32_t ordinal = streamOrdinals_[h]++;
  return hashBytes(key, seed_ ^ (static_cast<std::uint64_t>(ordinal) << 32));
}

void Plugin::describe(Description<Plugin>& d) {
  d.doc("A plugin: a shared library that provides classes.");
  d.property("version", &Plugin::version).doc("Its own version.");
  d.property("doc", &Plugin::doc).doc("What it is for.");
  d.property("file", &Plugin::file).doc("The file it was loaded from.");
  d.property("classes", &Plugin::classes).doc("Names of the classes it provides.");
  d.property("registered", &Plugin::registered).doc("True when a config line registered its classes.");
}

}  // namespace spark
