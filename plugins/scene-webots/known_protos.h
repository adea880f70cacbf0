#pragma once
/// \file
/// PROTOs that almost every world has, and that come with Webots: grounds and backdrops. Their files are not needed.

#include "reading.h"

namespace spark::webots {

/// True for what viewers alone need: TexturedBackground, TexturedBackgroundLight.
bool isBackdrop(std::string_view type);
/// True for Floor, RectangleArena and CircleArena.
bool isGround(std::string_view type);
/// Adds the ground to a body of the world: a plane, and the walls of an arena. Throws Error.
void readGround(const Node& node, const Frame& frame, mjcf::Body& body, Reading& reading);

}  // namespace spark::webots
