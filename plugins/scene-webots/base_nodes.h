#pragma once
/// \file
/// The node types of Webots itself.

#include <string_view>

namespace spark::webots {

/// True for a type that needs no PROTO.
bool isBaseNode(std::string_view type);
/// True for Solid, and for what is one: robots and devices.
bool isSolid(std::string_view type);
/// True for Robot, and for what old versions had beside it: Supervisor, DifferentialWheels.
bool isRobot(std::string_view type);
/// True for a device that looks ahead along x, and did along -z before R2022a.
bool looksAhead(std::string_view type);
/// True for a geometry, or a ground, that stands along z, and did along y before R2022a.
bool standsUp(std::string_view type);
/// True for what only places or gathers other nodes: Group, Pose, Transform.
bool isGroup(std::string_view type);
/// True for what connects solids: HingeJoint, Hinge2Joint, SliderJoint, BallJoint.
bool isJoint(std::string_view type);
/// True for what viewers alone need: Viewpoint, Background.
bool isScenery(std::string_view type);

}  // namespace spark::webots
