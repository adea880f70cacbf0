#pragma once
/// \file
/// The copy of a subtree of another host: names, classes and shape, scene nodes and values that are read.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>

#include "proxy_classes.h"
#include "scene_copy.h"
#include "spark/kernel.h"
#include "spark/value.h"

namespace spark::remote {

/// The nodes below a mount, as the other host's TreeFeed tells. Simulation thread.
class Mirror {
 public:
  explicit Mirror(Node& mount) : mount_(mount) {}
  /// Follows a message of TreeFeed; false if it is none. What cannot be done now, because a node is in use, is done by
  /// a later call. `bytes`: the length of the message. Throws Error for a message that makes no sense, and where too
  /// much waits.
  bool follow(const List& message, std::size_t bytes);
  /// Does what could not be done before.
  void catchUp();
  /// Removes all nodes.
  void clear();
  /// The last value of a property that came; nullptr: none came.
  const Value* value(const Leaf& node, const std::string& property) const;
  /// Keeps a value that was read.
  void keep(const Leaf& node, const std::string& property, const Value& value);
  /// The number of the last message of values that was applied.
  std::uint64_t applied() const { return applied_; }

 private:
  void change(const List& message);
  void add(const List& message);
  Leaf& create(Node& parent, const std::string& name, const std::string& remote, const Value& state);
  void apply(const List& message);
  void wait(const List& message, std::size_t bytes);
  Node& nodeOf(std::uint64_t id) const;
  Leaf* find(std::uint64_t id) const;

  struct Values {
    Ref<const Leaf> node;
    std::map<std::string, Value, std::less<>> of;  ///< by property
  };
  Node& mount_;
  ProxyClasses classes_;
  SceneCopy scene_{mount_};
  std::map<std::uint64_t, Values> values_;  ///< of properties that were read, by Leaf::id
  std::uint64_t applied_ = 0;
  std::map<std::uint64_t, Ref<Leaf>> nodes_;  ///< by the other host's id
  std::deque<List> waiting_;
  std::size_t waitingBytes_ = 0;  ///< what came since nothing waited
};

}  // namespace spark::remote
