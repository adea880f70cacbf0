#pragma once
/// \file
/// The shape of a tree: which objects it has and how they came there, and their settings.

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "spark/kernel.h"
#include "spark/state_stream.h"

namespace spark {

/// The shape of a kernel's tree, without /classes, /plugins and /sys/host. When a config has run its objects are there;
/// those with a greater id were made by the run, one by one or by the import of a file. Simulation thread, but for
/// the const functions without a kernel, which any thread may call: nothing in it refers to an object.
class TreeShape {
 public:
  /// The shape of now. `mark`: the greatest id of the objects that the config made.
  TreeShape(Kernel& kernel, std::uint64_t mark);
  /// One that write() wrote. Throws Error for anything else.
  explicit TreeShape(StateReader& in);
  void write(StateWriter& out) const;

  /// True if the tree has exactly the objects of which it was taken.
  bool isHere(Kernel& kernel) const;
  /// The memory of its objects and their settings [bytes], without that of long texts.
  std::size_t memory() const;
  /// configurationHash() of then.
  std::uint64_t configuration() const { return configuration_; }
  /// Makes the tree the same. Throws Error where that cannot be done.
  void restore(Kernel& kernel, std::uint64_t mark) const;

 private:
  /// An object that the run made, or a file that it imported.
  struct Made {
    std::uint64_t id = 0;
    bool imported = false;
    std::string what;     ///< class or file
    std::string where;    ///< path of the parent
    std::string name;     ///< as Node::child() finds it
    List arguments = {};  ///< of an import
    int number = 0;       ///< of an agent's aspect
  };
  /// An object of the tree. `children` -1: it has none and cannot have any.
  struct Object {
    std::string name, type;
    std::int64_t children = -1;
    std::vector<std::pair<std::string, Value>> settings;
  };
  void list(const Leaf& leaf);
  void listMade(Kernel& kernel, const std::vector<const Leaf*>& made);
  void make(Kernel& kernel) const;
  void prune(Leaf& leaf, std::size_t& at) const;

  std::uint64_t configuration_ = 0;
  std::vector<Made> made_;          ///< in the order in which they were made
  std::vector<Object> objects_;     ///< in tree order
  std::vector<std::uint64_t> ids_;  ///< of objects_; empty if it was read
};

}  // namespace spark
