#pragma once
/// \file
/// A look-up that is repeated only when the shape of the tree has changed.
///
///     IRigidBody* body = body_.get(kernel(), [this] { return transform() ? transform()->childOf<IRigidBody>() :
///     nullptr; });

#include "spark/abi/api/cached_lookup.h"
#include "spark/kernel.h"

namespace spark {

/// Remembers what a search found until the tree's shape changes. A member of the node that searches. It owns nothing:
/// what it remembers lives as long as the shape stays. Not thread safe: one object for each node.
template <class T>
class CachedLookup {
 public:
  /// The remembered object, or what `find()` (returns T*, nullptr for none) finds now. In a phase that costs one
  /// comparison. Fails only as `find` does.
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
