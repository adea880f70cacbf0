#pragma once
/// \file
/// Reads the shapes of a `(draw ...)` action:
///
///     (circle (at x y) (radius r))                 (sphere (at x y z) (radius r))
///     (line (from x y z) (to x y z))               (polygon (at x y z) (at x y z) (at x y z) ...)
///     (point (at x y z) (size pixels))             (text (at x y z) (say "what is written"))
///     (agent (side left) (unum 3) (say "..."))     without (say ...): removes the agent's text
///
/// all with `(color red green blue alpha)`, 0 to 255, alpha for polygons only; circles and lines with `(thickness
/// pixels)`.

#include <string>

#include "api/drawing.h"
#include "spark/predicates.h"

namespace spark::drawing {

/// Reads a shape. Returns "" or what was expected and found.
std::string readShape(const Element& list, Drawing& out);

}  // namespace spark::drawing
