#pragma once

#include "api/status.h"
#include "variables.h"

namespace spark {

/// A group whose variables are the status of a game (IStatus): a game in Lua reports its score by
/// `Status.score = {2, 1}`.
class StatusVariables : public Variables, public IStatus {
  SPARK_CLASS(StatusVariables, Variables)
 public:
  static void describe(Description<StatusVariables>& d);
  /// Reports the names that IStatus knows first, then all other variables, sorted by name.
  void report(std::vector<StatusEntry>& out) const override;
};

}  // namespace spark
