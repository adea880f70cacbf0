#pragma once
/// \file
/// Rays and distances of height fields, in the frame of the field.

#include <array>

#include "api/shape.h"
#include "shape_ray.h"

namespace spark::physics {

/// The corners of a triangle of a cell, counter-clockwise seen from above. `second`: the one with the corner of least x
/// and most y.
std::array<Vec3, 3> triangleOf(const engine::HeightField& field, int column, int row, bool second);
/// Takes the nearest hit. Visits the cells below the ray alone.
void castHeightField(ShapeRay& ray, const engine::HeightField& field);
/// Distance from a point to the surface [m].
double distanceTo(const engine::HeightField& field, const Vec3& point);

}  // namespace spark::physics
