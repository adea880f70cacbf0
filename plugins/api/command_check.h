#pragma once
/// \file
/// Trainer commands are executed later than they are sent. A trainer that can check them before lets programs that wait
/// for an answer have one: sparkctl, the page for browsers, scripts.

#include <string>

#include "spark/abi/api/command_check.h"
#include "spark/node.h"
#include "spark/predicates.h"

namespace spark {

/// Checks trainer commands when they are sent. Offered by trainers (ITrainer).
class ICommandCheck {
 public:
  SPARK_INTERFACE(ICommandCheck, 1);
  virtual ~ICommandCheck() = default;
  /// Returns "" if all of `command`, which is one of this trainer's, would have an effect now; otherwise one line that
  /// says what was expected and found. Changes nothing. Simulation thread, between cycles.
  virtual std::string check(const Element& command) = 0;
};

}  // namespace spark
