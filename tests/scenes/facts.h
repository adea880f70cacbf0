#pragma once
/// \file
/// A scene as lines of text, for comparing scenes and for showing differences. The text is equal exactly when the
/// scenes are.

#include <string>
#include <vector>

#include "api/physics.h"
#include "api/scene.h"

namespace spark::test {

/// All nodes below `root` in tree order, one line each: path, class, every property, the visual data for monitors, and
/// the engine's data of bodies, joints and colliders. Numbers are exact.
std::vector<std::string> nodeFacts(Node& root);

/// Paths of the bodies, joints and colliders below `root` in order of creation, which is the order in which an engine
/// processes them.
std::vector<std::string> creationOrder(Node& root);

/// Position, rotation and velocities of every body below `root`, one line each. Numbers are exact.
std::vector<std::string> motion(Node& root);

}  // namespace spark::test
