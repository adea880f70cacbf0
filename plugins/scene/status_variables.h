#pragma once

#include "api/status.h"
#include "variables.h"

namespace spark {

/// A group whose variables are what a game reports: a game in Lua shows its score with `Status.score = {2, 1}`. They
/// are state.
class StatusVariables : public Variables, public IStatus {
  SPARK_CLASS(StatusVariables, Variables)
 public:
  static void describe(Description<StatusVariables>& d);
  /// The words that are understood first, then all others, sorted by name.
  void report(std::vector<StatusEntry>& out) const override;

 protected:
  void saveState(StateWriter& out) const override;
  void loadState(StateReader& in) override;
};

}  // namespace spark
