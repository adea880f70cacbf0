#pragma once
/// \file
/// Searches downwards: a robot's torso, the sensor that a collision handler feeds.

#include "spark/node.h"

namespace spark {

/// The first T (a class or an interface) below `node`, depth first; nullptr when there is none. It belongs to the tree:
/// keep it no longer than the tree's shape stays (CachedLookup), or as a Ref. Linear in the number of nodes: for set-up
/// and look-ups that are remembered.
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
