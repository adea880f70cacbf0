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

/// A mass that is as good as none, in files whose own programs compute with it [kg].
inline constexpr double kNextToNoMass = 1e-7;

/// Bodies that move and have, together with what is fixed to them, a mass of `least` or below get 10 g, which is named
/// in `unsupported`. `what`: "a <link>".
void weighLightBodies(Model& model, const std::string& what, double least, Unsupported& unsupported);

}  // namespace spark::mjcf
