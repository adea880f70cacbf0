#pragma once
/// \file
/// Copies of the scene for the I/O thread. Simulation thread, publish phase.

#include "snapshot.h"

namespace spark::web {

/// Describes the nodes of a frame: paths, meshes, shapes of colliders. Allocates.
std::shared_ptr<const SceneDescription> describeScene(const MonitorFrame& frame);

/// Copies the matrices and visibilities of a frame. Allocates only if there are more nodes than ever before.
void copyNodes(const MonitorFrame& frame, Snapshot& out);

}  // namespace spark::web
