#pragma once
/// \file
/// PROTOs that many worlds and robots have, and that come with Webots: grounds, backdrops, joints with backlash. Their
/// files are not needed.

#include "reading.h"

namespace spark::webots {

/// True for what viewers alone need: TexturedBackground, TexturedBackgroundLight.
bool isBackdrop(std::string_view type);
/// True for Floor, RectangleArena and CircleArena.
bool isGround(std::string_view type);
/// The text of a file with the PROTO of a box or a wall; nullptr for another type, or where the node does not say
/// enough.
const char* knownProto(const Node& node);
/// A joint with backlash as the joint that it is without, with the mass of its gear; nullptr for another type.
NodePtr jointWithoutBacklash(const Node& node, mjcf::Unsupported& unsupported);
/// The mass of the gears of such a joint, a point at the place where it holds its solid [kg].
double gearMass(const Node& joint, mjcf::Unsupported& unsupported);
/// A node that viewers alone need: its unknown fields are named.
void readScenery(const Node& node, Reading& reading);
/// Adds the ground to a body of the world: a plane, and the walls of an arena. Throws Error.
void readGround(const Node& node, const Frame& frame, mjcf::Body& body, Reading& reading);

}  // namespace spark::webots
