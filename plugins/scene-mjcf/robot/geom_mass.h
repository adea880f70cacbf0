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

/// How the mass of a mesh follows from its triangles (MuJoCo's documentation, "compiler/exactmeshinertia" and
/// "mesh/inertia").
enum class MeshInertia {
  exact,      ///< that of a closed surface
  legacy,     ///< each triangle adds to the volume, on whichever side of the centre it is
  estimated,  ///< as legacy, but the volume is that of the box with that inertia: what MuJoCo 2.2.2 does by default
  shell,      ///< the triangles themselves have mass, their density is one of an area [kg/m^2]
};

// Mass, centre and inertia of a solid of uniform density in its own frame, inertia about its centre.

bool hasVolume(const engine::Mesh& mesh, MeshInertia inertia);
/// Of a mesh. Throws Error, with the place of `geom`, for one without volume.
engine::Mass meshMass(const engine::Mesh& mesh, const Weight& weight, const Element& geom,
                      MeshInertia inertia = MeshInertia::exact);
/// Of a shape other than a plane; meshes are closed, or flat: then they have no mass.
engine::Mass shapeMass(const engine::ShapeDescription& shape, const Weight& weight, const Element& geom);
/// Of an ellipsoid with these half axes [m].
engine::Mass ellipsoidMass(const Vec3& halfAxes, const Weight& weight);

/// The mass as seen from outside its frame; its inertia stays about its centre.
engine::Mass moved(const engine::Mass& mass, const Pose& at);

}  // namespace spark::mjcf
