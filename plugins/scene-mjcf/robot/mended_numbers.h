#pragma once
/// \file
/// Numbers of a model with which no engine computes.

#include "model.h"

namespace spark::mjcf {

/// The ranges of numbers that a model may have.
struct Range {
  double least, most;
};
inline constexpr Range kMasses{1e-15, 1e15};     ///< kg; a gnat has 1e-6, a cruise ship 1e8
inline constexpr Range kMoments{1e-30, 1e30};    ///< kg m^2
inline constexpr Range kPlaces{-1e6, 1e6};       ///< m, in the frame around
inline constexpr Range kCoordinates{-1e6, 1e6};  ///< of joints [rad or m]
inline constexpr Range kCoefficients{0, 1e12};   ///< damping, stiffness, friction and rotors of joints, SI units
inline constexpr Range kBodyDamping{0, 1e9};     ///< of a body that moves freely, SI units
inline constexpr Range kGains{-1e12, 1e12};      ///< of actuators

/// True for a mass and an inertia that a body may have, and a centre in its range.
bool isUsable(const engine::Mass& mass);

/// Brings a mass above 0 into its range; an inertia that no body can have becomes that of a sphere of water. Both are
/// named in `unsupported`.
void mendMass(engine::Mass& mass, const Element& from, Unsupported& unsupported);

/// The same of a geom, whose mass and inertia are scaled to their most; it has none where that makes no number. Named.
void mendMass(Geom& geom, Unsupported& unsupported);

/// Brings all numbers of a model into their ranges and names those that were not, for any language: poses and masses of
/// bodies, joints, actuators.
void mendNumbers(Model& model, Unsupported& unsupported);

}  // namespace spark::mjcf
