#pragma once

#include <vector>

#include "api/monitor.h"
#include "spark/event.h"

namespace spark {

/// Child of the monitor server: makes its frames instead of the active scene and the items, e.g. from a recorded game.
class IFrameSource {
 public:
  SPARK_INTERFACE(IFrameSource, 1);
  virtual ~IFrameSource() = default;
  /// Publish phase, in cycles that are due. `watched`: a monitor is connected. Writes nodes and environment of the
  /// frame (`once` entries are told once) and the nodes' numbers. True when clients need a full message: nodes, meshes
  /// or materials are others.
  virtual bool fill(MonitorFrame& frame, std::vector<std::uint64_t>& ids, const Event& event, bool watched) = 0;
};

}  // namespace spark
