#pragma once
/// \file
/// What perceptors sense when a mind, a rule or a script asks, beside what they sense in each cycle.

#include <cstdint>
#include <functional>

#include "api/agents.h"

namespace spark::gamecontrol {

/// Asks perceptors. What they and their modifiers remember is afterwards what it was before, also after an error.
class Questions {
 public:
  /// What `node`, if it is a perceptor, and all perceptors below it sense now, as Perceptor::senseNow(). `round`: for
  /// ISharedView::share(), another number than before. `isSensed`: true for perceptors of agents; of these, scripts
  /// answer with what they perceived last: what a script does cannot be undone. Throws Error if a perceptor does, and
  /// within another question.
  List ask(Node& node, std::uint64_t round, const std::function<bool(const Perceptor&)>& isSensed);

 private:
  bool asking_ = false;
};

}  // namespace spark::gamecontrol
