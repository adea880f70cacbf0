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
    classes_.define(mount_, message, bytes);
    return true;
  }
  if (kind != kAdd && kind != kMove && kind != kRename && kind != kRemove && kind != kScene) return false;
  if (waiting_.empty() && (kind == kAdd || kind == kScene))
    change(message);  // that is always possible
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
  if (kind == kAdd) return add(message);
  if (kind == kScene) return apply(message);
  Leaf* const leaf = find(id);
  if (!leaf) {  // it went with its parent
    if (kind == kRemove) nodes_.erase(id);
    return;
  }
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
    std::erase_if(values_, [](const auto& known) { return !known.second.node; });
  }
}

void Mirror::add(const List& message) {
  if (nodes_.size() >= kMostNodes) throw BadMessage(fmt::format("the other host has more than {} nodes", kMostNodes));
  Node& parent = nodeOf(numberAt(message, 2));
  const std::string &name = nameAt(message, 3), &remote = textAt(message, 4);
  const Ref<Leaf> made(&create(parent, name, remote, message.size() > 5 ? message[5] : Value()));
  nodes_.insert_or_assign(numberAt(message, 1), made);
}

/// A new node. One that this host cannot have in its scene is a node of the other host as any other one.
Leaf& Mirror::create(Node& parent, const std::string& name, const std::string& remote, const Value& state) {
  if (!classes_.isOfScene(remote)) return parent.create(classes_.of(remote), name);
  if (!state.isList()) return parent.create(classes_.plain(mount_, remote), name);
  Ref<Leaf> made;
  try {
    made = Ref<Leaf>(&parent.create(classes_.of(remote), name));
    scene_.make(*made, state.toList());
    return *made;
  } catch (const std::exception& e) {
    scene_.warn(remote, parent.path() + '/' + name, e);
  }
  if (made) parent.remove(*made);
  return parent.create(classes_.plain(mount_, remote), name);
}

/// Follows what has changed: poses, looks and shapes, values. Nodes that are not here yet, or no more, are left out.
void Mirror::apply(const List& message) {
  const auto each = [&](std::size_t index, const auto& use) {
    for (const Value& entry : at(message, index, Value::Type::list).toList()) {
      if (!entry.isList()) throw BadMessage("the other host tells of a change that is none");
      if (Leaf* const leaf = find(numberAt(entry.toList(), 0))) use(*leaf, entry.toList());
    }
  };
  each(2, [&](Leaf& leaf, const List& e) { scene_.place(leaf, at(e, 1, Value::Type::list).toList()); });
  each(3, [&](Leaf& leaf, const List& e) {
    scene_.change(leaf, at(e, 1, Value::Type::list).toList(), at(e, 2, Value::Type::list).toList());
  });
  each(4, [&](Leaf& leaf, const List& e) {
    const auto known = values_.find(leaf.id());
    if (e.size() < 3 || known == values_.end()) return;
    if (const auto at = known->second.of.find(textAt(e, 1)); at != known->second.of.end()) at->second = e[2];
  });
  applied_ = numberAt(message, 1);
}

const Value* Mirror::value(const Leaf& node, const std::string& property) const {
  const auto known = values_.find(node.id());
  if (known == values_.end()) return nullptr;
  const auto at = known->second.of.find(property);
  return at == known->second.of.end() ? nullptr : &at->second;
}

void Mirror::keep(const Leaf& node, const std::string& property, const Value& value) {
  Values& known = values_[node.id()];
  known.node = Ref<const Leaf>(&node);
  known.of.insert_or_assign(property, value);
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
  values_.clear();
  applied_ = 0;
  mount_.removeChildren();
}

}  // namespace spark::remote
