#pragma once
/// \file
/// Finds the sensor that a collision handler feeds.

#include "api/scene.h"

namespace spark {

/// The first T below a node, depth first; nullptr when there is none.
template <class T>
T* firstBelow(const Node& node) {
  for (const auto& child : node.children()) {
    if (T* match = child->as<T>()) return match;
    if (child->asNode())
      if (T* match = firstBelow<T>(*child->asNode())) return match;
  }
  return nullptr;
}

}  // namespace spark
