#include "mirror.h"

#include <fmt/format.h>

#include "messages.h"
#include "wire.h"

namespace spark::remote {

namespace {
constexpr std::size_t kMostNodes = 200'000;
constexpr std::size_t kMostWaiting = 100'000, kMostWaitingBytes = 64 << 20;

/// Throws BadMessage for a name that no node can have.
const std::string& nameAt(const List& message, std::size_t index) {
  const std::string& name = textAt(message, index);
  if (name.empty() || name == "." || name == ".." || name.find_first_of("/\\") != std::string::npos)
    throw BadMessage(fmt::format("the other host names a node '{}'", name));
  return name;
}
}  // namespace

bool Mirror::follow(const List& message, std::size_t bytes) {
  const std::string& kind = message[0].toString();
  if (kind == kClass) {
    classes_.define(mount_.kernel(), mount_.name(), message, bytes);
    return true;
  }
  if (kind != kAdd && kind != kMove && kind != kRename && kind != kRemove) return false;
  if (waiting_.empty() && kind == kAdd)
    change(message);  // adding is always possible
  else
    wait(message, bytes);
  catchUp();
  return true;
}

void Mirror::wait(const List& message, std::size_t bytes) {
  if (waiting_.empty()) waitingBytes_ = 0;
  waiting_.push_back(message);
  waitingBytes_ += bytes;
  if (waiting_.size() > kMostWaiting || waitingBytes_ > kMostWaitingBytes)
    throw BadMessage("the other host changes its tree faster than this one can follow");
}

void Mirror::catchUp() {
  while (!waiting_.empty()) {
    try {
      change(waiting_.front());
    } catch (const BadMessage&) {
      throw;
    } catch (const Error&) {
      // What is never possible is a BadMessage. A handler or a request works with the node: later, in the same order.
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
    Leaf& made = nodeOf(numberAt(message, 2)).create(classes_.of(textAt(message, 4)), nameAt(message, 3));
    nodes_.insert_or_assign(id, Ref<Leaf>(&made));
    return;
  }
  Leaf* const leaf = find(id);
  if (!leaf) return;  // it went with its parent
  if (kind == kMove) {
    Node& parent = nodeOf(numberAt(message, 2));
    for (const Leaf* up = &parent; up; up = up->parent())
      if (up == leaf) throw BadMessage("the other host moves a node below itself");
    leaf->parent()->reparent(*leaf, parent);
  }
  if (kind == kRename) leaf->setName(nameAt(message, 2));
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
