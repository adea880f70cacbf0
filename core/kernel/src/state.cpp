#include "spark/state.h"

#include <set>

#include "spark/class_object.h"
#include "spark/kernel.h"
#include "spark/node.h"
#include "spark/random.h"
#include "tree.h"

namespace spark {

namespace {
/// True for the root of a kernel's tree, with which the kernel saves its own state.
bool isRoot(const Leaf& leaf) { return !leaf.parent() && leaf.isLinked(); }

/// Writes the state of `leaf` alone.
void save(const Leaf& leaf, StateWriter& out) {
  if (isRoot(leaf)) leaf.kernel().saveState(out);
  if (leaf.classObject())
    for (const Property* p : leaf.classObject()->stateProperties()) out.write(p->get(leaf));
  detail::Tree::saveState(leaf, out);
}

void writeConfiguration(const Leaf& leaf, StateWriter& out) {
  out.write(leaf.name());
  if (ClassObject* type = leaf.classObject()) {
    out.write(type->name());
    for (const Property* p : type->properties()) {
      if (!p->isConfiguration()) continue;
      out.write(p->name);
      out.write(p->get(leaf));
    }
  }
  const Node* const node = leaf.asNode();
  out.write(node ? static_cast<std::int64_t>(node->children().size()) : -1);
  if (!node) return;
  const bool top = isRoot(leaf);
  for (const auto& c : node->children()) {
    const std::string path =
        top || (leaf.name() == "sys" && leaf.parent() && isRoot(*leaf.parent())) ? c->path() : std::string();
    if (path != "/classes" && path != "/plugins" && path != "/sys/host") writeConfiguration(*c, out);
  }
}
}  // namespace

void saveTree(const Leaf& leaf, StateWriter& out) {
  save(leaf, out);
  const auto saveBelow = [](void* to, void*, Leaf& below) { save(below, *static_cast<StateWriter*>(to)); };
  if (const Node* node = leaf.asNode()) node->collectAs(Leaf::kInterface, true, saveBelow, &out);
}

void loadTree(Leaf& leaf, StateReader& in) {
  if (isRoot(leaf)) leaf.kernel().loadState(in);
  if (leaf.classObject())
    for (const Property* p : leaf.classObject()->stateProperties()) {
      Value v = in.readValue();
      if (in.branch() != 0 && p->type == Convert<RandomStream>::typeName()) v = branched(v, in.branch());
      Args args{std::span(&v, 1)};
      if (p->set) p->set(leaf, args);  // a read-only property restores itself by loadState()
    }
  detail::Tree::loadState(leaf, in);
  if (Node* node = leaf.asNode())
    for (std::size_t i = 0; i < node->children().size(); ++i) loadTree(*node->children()[i], in);
}

std::uint64_t stateHash(const Leaf& root) {
  StateWriter out(false);
  saveTree(root, out);
  return out.hash();
}

std::uint64_t configurationHash(const Leaf& root) {
  StateWriter out(false);
  out.write(root.kernel().seed());
  std::set<Sources::Source> texts;
  for (Sources::Source s : root.kernel().sources().all()) {
    if (s.name.starts_with('/')) s.name.erase(0, s.name.rfind('/'));  // the folder decides nothing
    texts.insert(std::move(s));
  }
  for (const Sources::Source& s : texts) {
    out.write(s.kind);
    out.write(s.name);
    out.write(s.hash);
  }
  writeConfiguration(root, out);
  return out.hash();
}

}  // namespace spark
