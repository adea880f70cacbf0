#pragma once
/// \file
/// Reads the node Physics of a solid.

#include "reading.h"

namespace spark::webots {

/// The density that a Physics node gives the parts of the bounding object [kg/m^3]; nullopt: their masses do not
/// matter.
std::optional<double> densityOf(const Node* physics, mjcf::Unsupported& unsupported);

/// Mass, centre and inertia of a solid, from its Physics node and from the masses of the geoms of its body, which have
/// densityOf(). nullptr: the solid has none. Throws Error.
engine::Mass massOf(const Node* physics, const mjcf::Body& body, mjcf::Unsupported& unsupported);

}  // namespace spark::webots
