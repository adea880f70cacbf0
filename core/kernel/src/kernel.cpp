#include "spark/kernel.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <mutex>

#include "class_registry.h"
#include "spark/error.h"
#include "spark/random.h"
#include "spark/state.h"
#include "tree.h"

namespace spark {

/// The members of a kernel. They are destroyed in reverse order.
struct Kernel::Parts {
  explicit Parts(Kernel& kernel) : events(kernel), tree(kernel), classes(kernel) {}
  Log log;
  Jobs jobs;
  Sources sources;
  Events events;
  detail::Tree tree;
  detail::ClassRegistry classes;
  std::unique_ptr<Loader> loader;
  std::uint64_t seed = 1;
  std::map<std::uint64_t, std::uint32_t> streamOrdinals;  ///< calls of streamSeed() by hash of the key
  std::mutex streamMutex;                                 ///< guards streamOrdinals
  std::atomic<bool> stop{false}, ending{false};
  std::atomic<std::int64_t> faults{0};
};

Kernel::Kernel() : parts_(std::make_unique<Parts>(*this)) {
  registerClass<Leaf>();
  registerClass<Node>();
  registerClass<ClassObject>();
  registerClass<Plugin>();
  parts_->tree.plant(classOf("Node").create());
  root().create<Node>("Node", "sys").create("Node", "server");
  root().create("Node", "usr");
  parts_->classes.hang();
  parts_->loader = std::make_unique<Loader>(*this);
}

// The tree without classes and plugins is destroyed first, then the classes of plugins, then the plugins' libraries.
Kernel::~Kernel() {
  parts_->ending = true;
  parts_->tree.fell();
  parts_->loader.reset();
  // Class objects count their objects, so the kernel's own ones must outlive the nodes that remain.
  const std::vector<std::unique_ptr<Leaf>> classes = parts_->classes.takeAll();
  parts_->tree.uproot();
}

Node& Kernel::root() { return *parts_->tree.root(); }
Events& Kernel::events() { return parts_->events; }
Log& Kernel::log() { return parts_->log; }
Loader& Kernel::plugins() { return *parts_->loader; }
Jobs& Kernel::jobs() { return parts_->jobs; }
detail::Tree& Kernel::tree() { return parts_->tree; }
detail::ClassRegistry& Kernel::registry() { return parts_->classes; }

ClassObject& Kernel::registerClass(ClassDescription description, Plugin* plugin) {
  return parts_->classes.add(std::move(description), plugin);
}

ClassObject* Kernel::findClass(std::string_view name) const { return parts_->classes.find(name); }

ClassObject& Kernel::classOf(std::string_view name) {
  if (ClassObject* c = findClass(name)) return *c;
  if (parts_->loader)
    if (Plugin* p = parts_->loader->providerOf(name))
      throw Error(fmt::format(
          "there is no class '{0}' yet: plugin '{1}' provides it. Add plugin \"{1}\" to the config.", name, p->name()));
  std::vector<std::string> names;
  for (const auto& [n, c] : parts_->classes.all()) names.push_back(n);
  for (const auto& p : parts_->tree.plugins->children())
    for (const std::string& n : static_cast<Plugin&>(*p).classes()) names.push_back(n);
  throw Error(fmt::format("there is no class '{}'.{}", name, didYouMean(name, names)));
}

std::vector<ClassObject*> Kernel::classes() const {
  std::vector<ClassObject*> out;
  for (const auto& [n, c] : parts_->classes.all()) out.push_back(c);
  return out;
}

Leaf& Kernel::create(std::string_view className, std::string_view path) {
  if (path.empty() || path.front() != '/')
    throw Error(fmt::format("expected an absolute path for a new {}, found '{}'", className, path));
  ClassObject& c = classOf(className);

  // Walk down to the parent and make what is missing.
  Node* at = parts_->tree.root();
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
    if (!next->asNode()) throw Error(fmt::format("cannot make {}: {} cannot have children", path, next->path()));
    at = next->asNode();
  }

  const std::string_view name = path.substr(last + 1);
  if (name.empty()) throw Error(fmt::format("expected a name at the end of '{}'", path));
  if (const Leaf* other = at->child(name))
    throw Error(fmt::format("cannot make {}: it exists already, as {}", path, other->classObject()->name()));
  auto leaf = c.create();
  leaf->setName(std::string(name));
  return at->add(std::move(leaf));
}

const std::uint64_t& Kernel::structureVersion() const { return parts_->tree.version(); }
void Kernel::updateOrder() { parts_->tree.updateOrder(); }
std::uint64_t Kernel::lastId() const { return parts_->tree.lastId(); }

void Kernel::markChanged(Leaf& leaf) {
  if (leaf.isLinked()) parts_->tree.markChanged(leaf.parent());
}

void Kernel::setSeed(std::uint64_t seed) { parts_->seed = seed; }
std::uint64_t Kernel::seed() const { return parts_->seed; }

std::uint64_t Kernel::streamSeed(const Leaf& owner, std::string_view purpose) {
  const std::string key =
      fmt::format("{}\n{}\n{}", owner.path(), owner.classObject() ? owner.classObject()->name() : "", purpose);
  const std::uint64_t h = hashBytes(key);
  const std::lock_guard lock(parts_->streamMutex);
  const std::uint32_t ordinal = parts_->streamOrdinals[h]++;  // different streams of one key get different seeds
  return hashBytes(key, parts_->seed ^ (static_cast<std::uint64_t>(ordinal) << 32));
}

Sources& Kernel::sources() { return parts_->sources; }

void Sources::add(std::string_view kind, std::string_view name, std::string_view text) {
  const std::uint64_t hash = hashBytes(text);
  all_.insert({std::string(kind), std::string(name), hash});
  texts_.try_emplace(hash, text);
}

const std::string* Sources::text(std::uint64_t hash) const {
  const auto found = texts_.find(hash);
  return found == texts_.end() ? nullptr : &found->second;
}

void Kernel::saveState(StateWriter& out) const {
  const std::lock_guard lock(parts_->streamMutex);
  out.write(static_cast<std::int64_t>(parts_->streamOrdinals.size()));
  for (const auto& [key, count] : parts_->streamOrdinals) {
    out.write(key);
    out.write(static_cast<std::int64_t>(count));
  }
}

void Kernel::loadState(StateReader& in) {
  std::map<std::uint64_t, std::uint32_t> ordinals;
  for (std::size_t n = in.readCount(); n > 0; --n) {
    const auto key = static_cast<std::uint64_t>(in.readInteger());
    ordinals[key] = static_cast<std::uint32_t>(in.readInteger());
  }
  const std::lock_guard lock(parts_->streamMutex);
  parts_->streamOrdinals = std::move(ordinals);
}

void Kernel::requestStop() { parts_->stop.store(true); }
bool Kernel::stopRequested() const { return parts_->stop.load(); }
bool Kernel::isEnding() const { return parts_->ending.load(); }
void Kernel::countFault() { parts_->faults.fetch_add(1, std::memory_order_relaxed); }
std::int64_t Kernel::faults() const { return parts_->faults.load(std::memory_order_relaxed); }

}  // namespace spark
