#pragma once
/// \file
/// The effectors of one agent by predicate.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "api/agents.h"
#include "gamecontrol/modifier_chain.h"
#include "spark/prefetch.h"

namespace spark::gamecontrol {

/// Finds the effector for an action. Agents usually send the same actions in the same order, so each entry remembers
/// which entry was used after it: a lookup first tries that one.
class EffectorTable {
 public:
  /// An effector with modifiers, and its actions of this cycle.
  struct Modified {
    Ref<Effector> effector;
    std::unique_ptr<ModifierChain> modifiers;
    Predicates actions;
  };
  /// Where an action goes.
  struct Target {
    Effector* effector = nullptr;  ///< nullptr: there is none, or it was removed
    Modified* modified = nullptr;  ///< nullptr: the effector has no modifiers
  };

  /// Rebuilds the table from the effectors below `root`. If several have the same predicate the last in tree order
  /// counts. Returns the number of effectors.
  std::size_t rebuild(AgentAspect& root);
  /// Removes all effectors.
  void clear();
  /// Predicate of the sync effector (ISyncEffector); "" if there is none.
  const std::string& syncPredicate() const { return syncPredicate_; }
  /// All predicates, sorted.
  std::vector<std::string> predicates() const;
  /// The effectors with modifiers, in order of their predicates.
  const std::vector<std::unique_ptr<Modified>>& modified() const { return modified_; }
  /// True while a SceneEffector waits to load the robot, or has loaded it in the last prepare phase after a wait.
  bool loading() const;

  /// Looks up the effectors for the actions of one cycle, in order. Actions may change the tree.
  class Lookup {
   public:
    explicit Lookup(EffectorTable& table) : table_(table), guess_(&table.first_) {
      prefetch(table.entries_.data(), table.entries_.size() * sizeof(Entry));
    }
    /// The effector for `predicate`.
    Target find(std::string_view predicate) {
      auto& entries = table_.entries_;
      if (entries.empty()) return {};
      if (table_.calledAt_ != *table_.structure_) table_.dropRemoved();
      if (*guess_ >= entries.size() || entries[*guess_].predicate != predicate) {
        const std::size_t index = table_.indexOf(predicate);
        if (index == entries.size()) return {};
        *guess_ = index;
      }
      Entry& entry = entries[*guess_];
      guess_ = &entry.next;
      // The solver has displaced effectors, and the joints above them, from the CPU caches.
      const Entry& next = entries[entry.next];
      prefetch(entries[next.next].called, kEffectorBytes);
      if (const Effector* e = next.called) prefetch(e->parent(), kParentBytes);
      return {entry.called, entry.modified};
    }

   private:
    static constexpr std::size_t kEffectorBytes = 256, kParentBytes = 320;  // that most actions read
    EffectorTable& table_;
    std::size_t* guess_;  ///< index of the entry that is tried first
  };

 private:
  struct Entry {
    std::string predicate;
    Ref<Effector> effector;
    /// The same, nullptr if it was removed; valid while the tree is that of `calledAt_`. A Ref costs a cache line.
    Effector* called = nullptr;
    std::size_t next = 0;          ///< index of the entry that was used after this one the last time
    Modified* modified = nullptr;  ///< of modified_
  };
  /// Empties the pointers to effectors that are no longer in the tree.
  void dropRemoved();
  /// Binary search; the number of entries if there is none.
  std::size_t indexOf(std::string_view predicate) const;

  std::vector<Entry> entries_;  ///< sorted by predicate
  std::vector<std::unique_ptr<Modified>> modified_;
  std::size_t first_ = 0;                     ///< index of the entry that was used first the last time
  const std::uint64_t* structure_ = nullptr;  ///< Kernel::structureVersion(); nullptr: there are no entries
  std::uint64_t calledAt_ = 0;                ///< that of the pointers in the entries
  std::string syncPredicate_;
};

}  // namespace spark::gamecontrol
