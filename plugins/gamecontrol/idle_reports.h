#pragma once
/// \file
/// Says which minds and effectors were accepted and have no effect.

#include <cstdint>
#include <string_view>
#include <vector>

#include "api/agents.h"

namespace spark::gamecontrol {

/// Logs once for each node that it has no effect.
class IdleReports {
 public:
  /// `why`: the end of the sentence that begins with the node.
  void report(Leaf& node, std::string_view why);
  /// The effectors of rules below `node` that have no mind: rules ask their perceptors when they want to know, and
  /// effectors act for a mind only.
  void reportEffectors(Node& node);

 private:
  std::vector<std::uint64_t> reported_;  ///< Leaf::id
};

}  // namespace spark::gamecontrol
