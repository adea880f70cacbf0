#pragma once
/// \file
/// Changes of the scene that monitors and caches must see.

#include "api/scene.h"

namespace spark {

/// Counts a change of the scene (ISceneServer::markModified), unless `leaf` is not linked yet.
inline void markModified(const Leaf& leaf) {
  if (!leaf.isLinked()) return;
  if (auto* server = leaf.kernel().root().find<ISceneServer>()) server->markModified();
}

/// Sets `kept`, a member of `leaf` that viewers show. Another value than before counts as a change of the scene.
template <class T>
void setShown(const Leaf& leaf, T& kept, const T& value) {
  const bool same = Convert<T>::to(kept) == Convert<T>::to(value);
  kept = value;
  if (!same) markModified(leaf);
}

}  // namespace spark
