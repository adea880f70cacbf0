#pragma once
/// \file
/// What an import that fails has to undo.

#include <cstdint>
#include <string>
#include <vector>

#include "spark/class_object.h"
#include "spark/ref.h"
#include "spark/value.h"

namespace spark {

/// Takes an import back. Nodes that it created are known by their ids: all objects are numbered by age. Nodes that are
/// older are remembered with name, properties and pose when an importer says that it will change them.
///
/// Not undone: what a method of an older node does beside its name, properties and pose; what scripts do that a file
/// attaches; random streams that were seeded.
class ImportUndo {
 public:
  /// A place in the course of imports, to which undo() leads back.
  struct Mark {
    std::uint64_t lastId;  ///< of the newest object
    std::size_t changes;   ///< number of remembered nodes
  };
  /// This moment, in the tree of that kernel.
  Mark mark(const Kernel& kernel) const;
  /// Remembers an older node as it is. A node that is remembered since `since` is not remembered again.
  void remember(Leaf& node, const Mark& since);
  /// Removes all nodes that were created since the mark, and gives older ones back what they had. Logs what cannot be
  /// undone.
  void undo(Kernel& kernel, const Mark& mark);
  /// Forgets all nodes; after the outermost import.
  void clear() { changes_.clear(); }

 private:
  /// An older node before it was changed.
  struct Change {
    Ref<Leaf> node;
    std::string name;
    std::vector<std::pair<const Property*, Value>> values;  ///< of properties that can be set
    bool moved = false;                                     ///< of a transform: movedSincePlace()
  };
  static void restore(const Change& change);
  std::vector<Change> changes_;
};

}  // namespace spark
