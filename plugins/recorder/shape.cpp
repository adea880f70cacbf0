#include "shape.h"

#include <fmt/format.h>

#include <algorithm>

#include "api/agents.h"
#include "api/scene.h"
#include "spark/class_object.h"
#include "spark/error.h"
#include "spark/node.h"
#include "spark/state.h"

namespace spark {

namespace {
/// True for what shows or holds a run and is no part of it.
bool isOutside(const Leaf& leaf) {
  const Node* const parent = leaf.parent();
  if (!parent) return false;
  if (!parent->parent()) return leaf.name() == "classes" || leaf.name() == "plugins";
  return leaf.name() == "host" && parent->name() == "sys" && !parent->parent()->parent();
}

/// Calls `f` for all objects of the tree, parents first.
template <class F>
void forEach(Leaf& leaf, F&& f) {
  if (isOutside(leaf)) return;
  f(leaf);
  if (Node* const node = leaf.asNode())
    for (const auto& child : node->children()) forEach(*child, f);
}

void removeMade(Node& node, std::uint64_t mark) {
  for (std::size_t i = node.children().size(); i-- > 0;) {
    if (i >= node.children().size()) continue;  // one may take others with it
    Leaf& child = *node.children()[i];
    if (isOutside(child)) continue;
    if (child.id() > mark)
      node.remove(child);
    else if (Node* const inner = child.asNode())
      removeMade(*inner, mark);
  }
}

/// The number of an agent; 0: it is none.
int numberOf(const Leaf& leaf) {
  const auto aspect = leaf.as<AgentAspect>();
  return aspect ? aspect->number() : 0;
}

/// `name` as it is found among the children of that name.
std::string numbered(const Leaf& leaf) {
  const std::size_t k = leaf.parent()->ordinalOf(leaf);
  return k > 1 ? fmt::format("{}[{}]", leaf.name(), k) : leaf.name();
}
}  // namespace

TreeShape::TreeShape(Kernel& kernel, std::uint64_t mark) : configuration_(configurationHash(kernel.root())) {
  std::vector<const Leaf*> made;
  forEach(kernel.root(), [&](const Leaf& leaf) {
    list(leaf);
    if (leaf.id() > mark || numberOf(leaf) > 0) made.push_back(&leaf);
  });
  std::sort(made.begin(), made.end(), [](const Leaf* a, const Leaf* b) { return a->id() < b->id(); });
  listMade(kernel, made);
}

void TreeShape::list(const Leaf& leaf) {
  Object& o = objects_.emplace_back();
  o.name = leaf.name();
  o.type = leaf.classObject()->name();
  if (const Node* const node = leaf.asNode())
    o.children = std::count_if(node->children().begin(), node->children().end(),
                               [](const auto& child) { return !isOutside(*child); });
  for (const Property* p : leaf.classObject()->properties())
    if (p->isConfiguration()) o.settings.emplace_back(p->name, p->get(leaf));
  ids_.push_back(leaf.id());
}

std::size_t TreeShape::memory() const {
  std::size_t bytes = 0;
  for (const Object& o : objects_) bytes += sizeof o + o.settings.capacity() * sizeof o.settings.front();
  return bytes;
}

void TreeShape::listMade(Kernel& kernel, const std::vector<const Leaf*>& made) {
  using Import = ISceneServer::Import;
  auto* const server = kernel.root().find<ISceneServer>();
  const std::vector<Import> none;
  const std::vector<Import>& imports = server ? server->imports() : none;
  auto import = imports.begin();
  std::uint64_t listed = 0;  // last id of the import that was listed last
  for (const Leaf* const leaf : made) {
    if (leaf->id() <= listed) continue;
    while (import != imports.end() && import->last < leaf->id()) ++import;
    if (import != imports.end() && import->first <= leaf->id() && import->root) {
      made_.push_back({import->first, true, import->file, import->root->path(), {}, import->arguments});
      listed = import->last;
    } else {
      made_.push_back({leaf->id(),
                       false,
                       leaf->classObject()->name(),
                       leaf->parent()->path(),
                       numbered(*leaf),
                       {},
                       numberOf(*leaf)});
    }
  }
}

bool TreeShape::isHere(Kernel& kernel) const {
  std::size_t at = 0;
  bool same = !ids_.empty();
  forEach(kernel.root(), [&](const Leaf& leaf) {
    same = same && at < ids_.size() && ids_[at] == leaf.id();
    ++at;
  });
  return same && at == ids_.size();
}

void TreeShape::restore(Kernel& kernel, std::uint64_t mark) const {
  if (auto* const control = kernel.root().find<IGameControl>()) control->withdrawAgents();
  removeMade(kernel.root(), mark);
  make(kernel);
  std::size_t at = 0;
  prune(kernel.root(), at);
  if (auto* const server = kernel.root().find<ISceneServer>()) server->markModified();
}

void TreeShape::make(Kernel& kernel) const {
  Node& root = kernel.root();
  for (const Made& m : made_) {
    Node& parent = root.require<Node>(m.where);
    if (m.imported) {
      try {
        root.require<ISceneServer>().importScene(m.what, parent, m.arguments);
      } catch (const Error& e) {
        // As it may have been then. What lacks is missed below.
        kernel.log().warning("{}: {}", m.where, e.what());
      }
    } else if (m.number > 0) {
      root.require<IGameControl>().restoreAgent(parent, m.name, m.number);
    } else if (!parent.child(m.name)) {  // else it came with another
      parent.create(m.what, m.name.substr(0, m.name.find('[')));
    }
  }
}

namespace {
/// Removes an object that the shape has not. Without what every tree has nothing could be restored.
void drop(Leaf& child) {
  if (!child.parent()->parent())
    throw Error(fmt::format("expected {} in the shape of the snapshot, found none: it is damaged", child.path()));
  child.parent()->remove(child);
}
}  // namespace

/// Removes what is too much below `leaf`, which is objects_[at], and sets what differs.
void TreeShape::prune(Leaf& leaf, std::size_t& at) const {
  if (at >= objects_.size()) throw Error("expected a shape that lists all objects, found one that ends early");
  const Object& o = objects_[at++];
  for (const auto& [name, value] : o.settings) {
    const Property* const p = leaf.classObject()->property(name);
    if (p && p->set && p->get(leaf) != value) setProperty(leaf, name, value);
  }
  Node* const node = leaf.asNode();
  if (!node) return;
  const auto isIt = [&](const Leaf& child) {
    return child.name() == objects_[at].name && child.classObject()->name() == objects_[at].type;
  };
  std::size_t here = 0;
  for (std::int64_t i = 0; i < o.children; ++i) {
    if (at >= objects_.size()) throw Error("expected a shape that lists all objects, found one that ends early");
    while (here < node->children().size()) {
      Leaf& child = *node->children()[here];
      if (isIt(child)) break;
      if (isOutside(child))
        ++here;
      else
        drop(child);
    }
    if (here >= node->children().size())
      throw Error(fmt::format("{}: the snapshot has a {} '{}' here, which the config and the files do not make",
                              node->path(), objects_[at].type, objects_[at].name));
    prune(*node->children()[here++], at);
  }
  for (std::size_t k = node->children().size(); k-- > here;)
    if (!isOutside(*node->children()[k])) drop(*node->children()[k]);
}

void TreeShape::write(StateWriter& out) const {
  out.write(configuration_);
  out.write(static_cast<std::int64_t>(made_.size()));
  for (const Made& m : made_) {
    out.write(m.imported);
    out.write(m.what);
    out.write(m.where);
    out.write(m.name);
    out.write(Value(m.arguments));
    out.write(m.number);
  }
  out.write(static_cast<std::int64_t>(objects_.size()));
  for (const Object& o : objects_) {
    out.write(o.name);
    out.write(o.type);
    out.write(o.children);
    out.write(static_cast<std::int64_t>(o.settings.size()));
    for (const auto& [name, value] : o.settings) {
      out.write(name);
      out.write(value);
    }
  }
}

TreeShape::TreeShape(StateReader& in) : configuration_(static_cast<std::uint64_t>(in.readInteger())) {
  for (std::size_t n = in.readCount(); n > 0; --n) {
    Made& m = made_.emplace_back();
    m.imported = in.readBool();
    m.what = in.readString();
    m.where = in.readString();
    m.name = in.readString();
    m.arguments = in.readValue().toList();
    m.number = static_cast<int>(in.readInteger());
  }
  for (std::size_t n = in.readCount(); n > 0; --n) {
    Object& o = objects_.emplace_back();
    o.name = in.readString();
    o.type = in.readString();
    o.children = in.readInteger();
    for (std::size_t s = in.readCount(); s > 0; --s) {
      std::string name = in.readString();
      o.settings.emplace_back(std::move(name), in.readValue());
    }
  }
}

}  // namespace spark
