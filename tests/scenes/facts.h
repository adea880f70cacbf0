#pragma once
/// \file
/// A scene as lines of text that are equal exactly when the scenes are: for comparing scenes, and for reading what
/// differs.

#include <string>
#include <vector>

#include "api/physics.h"
#include "api/scene.h"

namespace spark::test {

/// All nodes below `root` in tree order, a line each: path, class, every property, what monitors see of it, and what
/// the engine has of bodies, joints and colliders. Numbers are exact.
std::vector<std::string> nodeFacts(Node& root);

/// Paths of the bodies, joints and colliders below `root` in the order in which they were made, which decides the order
/// in which an engine treats them.
std::vector<std::string> creationOrder(Node& root);

/// Position, rotation and velocities of every body below `root`, a line each. Numbers are exact.
std::vector<std::string> motion(Node& root);

}  // namespace spark::test
