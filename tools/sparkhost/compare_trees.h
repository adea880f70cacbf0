#pragma once
/// \file
/// The comparison of a converted scene with the original.

#include <string>

#include "spark/node.h"

namespace sparkhost {

/// "" if below both nodes there are the same nodes: names, classes, order, and all properties that can be read, numbers
/// to 1e-6. Otherwise the first difference, with node and property.
/// Of nodes without calls of their own (ISceneCalls) the saved state is compared as well.
std::string differenceOf(const spark::Node& original, const spark::Node& converted);

}  // namespace sparkhost
