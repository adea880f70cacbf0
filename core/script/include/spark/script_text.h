#pragma once
/// \file
/// How scripts that are no files are attached, for servers whose clients send them.

#include <string_view>

#include "spark/abi/spark/script_text.h"
#include "spark/interface.h"
#include "spark/value.h"

namespace spark {

class Leaf;

/// Offered by the script server, at IScriptServer::kPath.
class IScriptText {
 public:
  SPARK_INTERFACE(IScriptText, 3);
  virtual ~IScriptText() = default;
  /// As IScriptServer::attach(), for a chunk of text and its `arguments`; returns its results. `trusted` false: the
  /// script can only compute and use `self` and its descendants, with limits on instructions and memory.
  virtual List attachText(Leaf& node, std::string_view text, std::string_view chunkName, bool trusted,
                          const Value& arguments = {}) = 0;
};

}  // namespace spark
