#pragma once
/// \file
/// Copies of what a frame refers to, made in the publish phase.

#include "snapshot.h"

namespace spark::web {

/// The nodes with their paths, meshes and the shapes of their colliders. Publish phase, simulation's thread; allocates.
std::shared_ptr<const SceneDescription> describeScene(const MonitorFrame& frame);

/// Matrices and visibility; allocates only when there are more nodes than ever before.
void copyNodes(const MonitorFrame& frame, Snapshot& out);

}  // namespace spark::web
