#include "mirror.h"

#include <fmt/format.h>

#include "messages.h"
#include "wire.h"

namespace spark::remote {

namespace {
constexpr std::size_t kMostNodes = 1'000'000;

}  // namespace

bool Mirror::follow(const List& message) {
  const std::string& kind = message[0].toString();
  if (kind == kClass) {
    classes_.define(mount_.kernel(), mount_.name(), message);
    return true;
  }
  if (kind != kAdd && kind != kMove && kind != kRename && kind != kRemove) return false;
  if (waiting_.empty() && kind == kAdd)
    change(message);  // adding is always possible
  else
    waiting_.push_back(message);
  catchUp();
  return true;
}

void Mirror::catchUp() {
  while (!waiting_.empty()) {
    try {
      change(waiting_.front());
    } catch (const BadMessage&) {
      throw;
    } catch (const Error&) {
      // A handler or a request works with the node: later, in the same order.
      return;
    }
    waiting_.pop_front();
  }
}

void Mirror::change(const List& message) {
  const std::string& kind = message[0].toString();
  const std::uint64_t id = numberAt(message, 1);
  if (kind == kAdd) {
    if (nodes_.size() >= kMostNodes) throw BadMessage(fmt::format("the other host has more than {} nodes", kMostNodes));
    Leaf& made = nodeOf(numberAt(message, 2)).create(classes_.of(textAt(message, 4)), textAt(message, 3));
    nodes_.insert_or_assign(id, Ref<Leaf>(&made));
    return;
  }
  Leaf* const leaf = find(id);
  if (!leaf) return;  // it went with its parent
  if (kind == kMove) leaf->parent()->reparent(*leaf, nodeOf(numberAt(message, 2)));
  if (kind == kRename) leaf->setName(textAt(message, 2));
  if (kind == kRemove) {
    leaf->parent()->remove(*leaf);
    nodes_.erase(id);
  }
}

Leaf* Mirror::find(std::uint64_t id) const {
  const auto at = nodes_.find(id);
  return at == nodes_.end() ? nullptr : at->second.get();
}

Node& Mirror::nodeOf(std::uint64_t id) const {
  if (id == 0) return mount_;
  Leaf* const leaf = find(id);
  if (!leaf || !leaf->asNode()) throw BadMessage("the other host speaks of a node that it has not named");
  return *leaf->asNode();
}

void Mirror::clear() {
  waiting_.clear();
  nodes_.clear();
  mount_.removeChildren();
}

}  // namespace spark::remote
