#pragma once
/// \file
/// Frames that do not come from the scene.

#include <vector>

#include "api/monitor.h"
#include "spark/event.h"

namespace spark {

/// A child of the monitor server that makes its frames instead of the active scene and the items, e.g. from a log.
class IFrameSource {
 public:
  SPARK_INTERFACE(IFrameSource, 1);
  virtual ~IFrameSource() = default;
  /// Writes nodes and environment of `frame`, and the nodes' `ids` (NewestFrame::ids); a `once` entry is written in one
  /// frame only. `watched`: a monitor is connected. True if clients need a full message: nodes, meshes or materials
  /// have changed. Publish phase, in cycles in which a frame is due.
  virtual bool fill(MonitorFrame& frame, std::vector<std::uint64_t>& ids, const Event& event, bool watched) = 0;
};

}  // namespace spark
