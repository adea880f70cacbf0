#pragma once
/// \file
/// Makes scene nodes of this host what those of another one are.

#include <set>
#include <string>

#include "api/scene.h"
#include "spark/value.h"

namespace spark::remote {

/// Applies what the other host's SceneFeed tells to the nodes below a mount. Simulation thread.
class SceneCopy {
 public:
  explicit SceneCopy(Node& mount) : mount_(mount) {}
  /// Sets pose, calls and properties of a new node. Throws Error if this host cannot have such a node; it must not stay
  /// then.
  void make(Leaf& leaf, const List& state);
  /// Sets the pose of a transform. What is none is left out, with one line in the log.
  void place(Leaf& leaf, const List& numbers);
  /// Sets calls and properties of a node. What cannot be set is left out, with one line in the log for each class.
  void change(Leaf& leaf, const List& calls, const List& properties);
  /// Logs, once for each class of the other host, that a node cannot be in the scene.
  void warn(const std::string& className, const std::string& node, const std::exception& why);

 private:
  Node& mount_;
  std::set<std::string> warned_;  ///< classes
};

}  // namespace spark::remote
