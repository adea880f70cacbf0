#pragma once
/// \file
/// Copies of the scene for the I/O thread. Simulation thread, publish phase.

#include "snapshot.h"

namespace spark::web {

/// Describes the nodes of a frame: paths, meshes, shapes of colliders; and their materials. Allocates.
std::shared_ptr<const SceneDescription> describeScene(const MonitorFrame& frame);

/// Copies matrices, visibilities and the environment of a frame, all but its events. Allocates only if there are more
/// of them than ever before. `time`: simulated [s].
void copyFrame(const NewestFrame& newest, double time, Snapshot& out);

}  // namespace spark::web
