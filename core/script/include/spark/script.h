#pragma once
/// \file
/// Scripts at nodes: what plugins see of the script server.

#include <string_view>

#include "spark/abi/spark/script.h"
#include "spark/interface.h"
#include "spark/value.h"

namespace spark {

class Leaf;

/// Runs scripts, at /sys/server/script. Nodes with scripts of their own ask for it: `require<IScriptServer>()`.
class IScriptServer {
 public:
  SPARK_INTERFACE(IScriptServer, 1);
  static constexpr const char* kPath = "/sys/server/script";
  virtual ~IScriptServer() = default;
  /// Attaches a script file to a node: it runs at once with `self` set to the node, in an environment of its own, and
  /// may subscribe to events with on(). It goes with the node. `arguments`: what the script reads with `local args =
  /// ...`; a list of pairs whose keys are words is a table there ({{"limit", 3}} is {limit = 3}). Throws Error.
  virtual void attach(Leaf& node, std::string_view file, const Value& arguments = {}) = 0;
};

}  // namespace spark
