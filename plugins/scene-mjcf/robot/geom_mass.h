#pragma once
/// \file
/// Masses of geoms.

#include <optional>

#include "api/model.h"
#include "document.h"

namespace spark::mjcf {

/// How heavy a geom is: its mass, or else that of its volume.
struct Weight {
  double density = 1000;       ///< kg/m^3
  std::optional<double> mass;  ///< kg
  double of(double volume) const { return mass ? *mass : density * volume; }
};

// Mass, centre and inertia of a solid of uniform density in its own frame, inertia about its centre.

/// Of a shape other than a plane; meshes are closed. Throws Error, with the place of `geom`, for a mesh without volume.
/// Of a closed surface.
engine::Mass meshMass(const engine::Mesh& mesh, const Weight& weight, const Element& geom);
engine::Mass shapeMass(const engine::ShapeDescription& shape, const Weight& weight, const Element& geom);
/// Of an ellipsoid with these half axes [m].
engine::Mass ellipsoidMass(const Vec3& halfAxes, const Weight& weight);

/// The mass as seen from outside its frame; its inertia stays about its centre.
engine::Mass moved(const engine::Mass& mass, const Pose& at);

}  // namespace spark::mjcf
