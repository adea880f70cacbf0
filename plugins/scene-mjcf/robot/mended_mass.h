#pragma once
/// \file
/// Masses that files of robots often get wrong.

#include <string>

#include "model.h"

namespace spark::mjcf {

/// A sphere of water of that mass [kg].
engine::Mass sphereOfWater(double mass);

/// Moments of inertia that are not above 0, but for rounding, become those of a sphere of water of that mass; those
/// that no body can have become their mean about each axis. Both are named in `unsupported`. `what`: the element, "an
/// <inertial>". `mass`: above 0.
void mendInertia(engine::Mass& mass, const Element& from, const std::string& what, Unsupported& unsupported);

/// The second of these alone, for any mass.
void balanceInertia(engine::Mass& mass, const Element& from, const std::string& what, Unsupported& unsupported);

/// Bodies that move and have no mass, or less than 0.1 mg, together with what is fixed to them, get 10 g, which is
/// named in `unsupported`. `what`: "a <link>". `flawedOnly`: only where a part lacks a mass that the file would give
/// it.
void weighLightBodies(Model& model, const std::string& what, Unsupported& unsupported, bool flawedOnly = false);

}  // namespace spark::mjcf
