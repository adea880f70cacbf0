#pragma once
/// \file
/// The interface of the script server, for plugins that run scripts at nodes.

#include <string_view>

#include "spark/abi/spark/script.h"
#include "spark/interface.h"
#include "spark/value.h"

namespace spark {

class Leaf;

/// The script server, at /sys/server/script. A node gets it by `require<IScriptServer>()`.
class IScriptServer {
 public:
  SPARK_INTERFACE(IScriptServer, 1);
  /// The well-known path.
  static constexpr const char* kPath = "/sys/server/script";
  virtual ~IScriptServer() = default;
  /// Attaches a script file to a node. The script runs at once, in an environment of its own with `self` set to the
  /// node, and may add event handlers by on(), which are removed with the node. In the script, `...` is `arguments`; a
  /// list of pairs whose keys are strings becomes a table ({{"limit", 3}} is {limit = 3}). Throws Error if the file is
  /// missing or the script fails; its handlers are then removed.
  virtual void attach(Leaf& node, std::string_view file, const Value& arguments = {}) = 0;
};

}  // namespace spark
