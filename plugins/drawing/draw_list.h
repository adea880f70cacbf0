#pragma once
/// \file
/// Shapes as agents write them in their effector's language:
///
///     (circle (at x y) (radius r))                 (sphere (at x y z) (radius r))
///     (line (from x y z) (to x y z))               (polygon (at x y z) (at x y z) (at x y z) ...)
///     (point (at x y z) (size pixels))             (text (at x y z) (say "what is written"))
///     (agent (side left) (unum 3) (say "..."))     without (say ...) the agent's text goes
///
/// each with `(color red green blue alpha)`, 0 to 255, alpha only of polygons; circles and lines with `(thickness
/// pixels)`.

#include <string>

#include "api/drawing.h"
#include "spark/predicates.h"

namespace spark::drawing {

/// Reads one shape. Returns "" or what is wrong with it: expected, found.
std::string readShape(const Element& list, Drawing& out);

}  // namespace spark::drawing
