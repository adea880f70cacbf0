#pragma once
/// \file
/// Copies of the scene for the I/O thread. Simulation thread, publish phase.

#include "snapshot.h"

namespace spark::web {

/// Describes the nodes of a frame: paths, meshes, shapes of colliders; and their materials. Allocates.
std::shared_ptr<const SceneDescription> describeScene(const MonitorFrame& frame);

/// The mounts of transforms: the later one of two that a joint links is on the earlier one. nullptr: it has none.
std::vector<Mount> mountsOf(const std::vector<const Transform*>& transforms);

/// Copies matrices, visibilities and the environment of a frame, all but its events. Allocates only if there are more
/// of them than ever before. `time`: simulated [s].
void copyFrame(const NewestFrame& newest, double time, Snapshot& out);

}  // namespace spark::web
