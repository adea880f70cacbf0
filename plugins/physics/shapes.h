#pragma once
/// \file
/// Collision shapes: which can be.

#include "api/model.h"

namespace spark::physics {

/// Throws Error for a shape that no engine can represent.
void checkShape(const engine::ShapeDescription& shape);

}  // namespace spark::physics
