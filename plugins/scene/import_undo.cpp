#include "import_undo.h"

#include <algorithm>

#include "api/scene.h"
#include "spark/error.h"
#include "spark/plugin_object.h"

namespace spark {

namespace {
/// The topmost objects below `node` that are newer than `lastId`, the last one first.
void collectNewer(Node& node, std::uint64_t lastId, std::vector<Ref<Leaf>>& out) {
  for (auto child = node.children().rbegin(); child != node.children().rend(); ++child) {
    // Classes and plugins came with a plugin that is used from now on, as it would be after any other failure.
    if ((*child)->as<ClassObject>() || (*child)->as<Plugin>()) continue;
    if ((*child)->id() > lastId)
      out.emplace_back(child->get());
    else if (Node* inner = (*child)->asNode())
      collectNewer(*inner, lastId, out);
  }
}
}  // namespace

ImportUndo::Mark ImportUndo::mark(const Kernel& kernel) const { return {kernel.lastId(), changes_.size()}; }

void ImportUndo::remember(Leaf& node, const Mark& since) {
  const auto first = changes_.begin() + static_cast<std::ptrdiff_t>(since.changes);
  if (std::any_of(first, changes_.end(), [&](const Change& c) { return c.node.get() == &node; })) return;
  Change change{Ref<Leaf>(&node), node.name(), {}, false};
  for (const Property* p : node.classObject()->properties())
    if (!p->readOnly && p->name != "name") change.values.emplace_back(p, p->get(node));
  if (const auto transform = node.as<Transform>()) change.moved = transform->movedSincePlace();
  changes_.push_back(std::move(change));
}

void ImportUndo::undo(Kernel& kernel, const Mark& mark) {
  std::vector<Ref<Leaf>> newer;
  collectNewer(kernel.root(), mark.lastId, newer);
  for (const Ref<Leaf>& leaf : newer) {
    if (!leaf) continue;  // it was removed with another one
    try {
      leaf->parent()->remove(*leaf);
    } catch (const std::exception& e) {
      kernel.log().error("{} stays although its import failed: {}", leaf->path(), e.what());
    }
  }
  for (; changes_.size() > mark.changes; changes_.pop_back()) {
    try {
      if (changes_.back().node) restore(changes_.back());
    } catch (const std::exception& e) {
      kernel.log().error("{} stays changed although the import failed: {}", changes_.back().node->path(), e.what());
    }
  }
}

void ImportUndo::restore(const Change& change) {
  Leaf& node = *change.node;
  if (node.name() != change.name) node.setName(change.name);
  for (const auto& [property, value] : change.values) {
    if (property->get(node) == value) continue;
    Args args{std::span(&value, 1)};
    property->set(node, args);
  }
  // A transform that was not waiting for the place phase does not wait for it now.
  if (const auto transform = node.as<Transform>()) transform->setMovedSincePlace(change.moved);
}

}  // namespace spark
