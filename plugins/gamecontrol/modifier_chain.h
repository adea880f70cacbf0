#pragma once
/// \file
/// The modifiers of one perceptor or effector.

#include <memory>
#include <vector>

#include "api/modifier.h"
#include "spark/running.h"

namespace spark::gamecontrol {

/// Modifiers that are children of one node, in their order. What they remember, such as delayed percepts, is in the
/// nodes: a new chain of the same modifiers continues where the old one ended.
class ModifierChain {
 public:
  /// The chain of a perceptor or effector; nullptr if it has no modifiers.
  static std::unique_ptr<ModifierChain> of(const Node& owner);
  /// Applies the modifiers one after the other. `now` records which one runs. Throws Error that names a modifier which
  /// threw.
  void apply(Signal signal, const Event& event, NowRunning& now) const;

 private:
  std::vector<Ref<Modifier>> modifiers_;
};

}  // namespace spark::gamecontrol
