#pragma once
/// \file
/// A look-up that is repeated only when the shape of the tree has changed.

#include "spark/kernel.h"

namespace spark {

/// Remembers what `find` found until the tree's shape changes. Holds no reference: what it remembers lives as long as the shape stays.
template <class T>
class CachedLookup {
 public:
  /// The remembered object, or what `find()` (returning T*) gives now.
  template <class Find>
  T* get(Kernel& kernel, Find find) {
    if (version_ != kernel.structureVersion()) {
      found_ = find();
      version_ = kernel.structureVersion();
    }
    return found_;
  }

 private:
  T* found_ = nullptr;
  std::uint64_t version_ = 0;
};

}  // namespace spark
