#pragma once
/// \file
/// Protects objects that are in use from being removed, moved or renamed.

#include <string_view>

#include "spark/abi/spark/in_use.h"
#include "spark/leaf.h"

namespace spark {

/// A guard: while it lives, its leaf is in use, for example because its code runs. Removing, moving or renaming the
/// leaf or one of its ancestors then throws Error. The simulation's thread only.
class InUse {
 public:
  /// Also protects the names of all descendants, for servers, which are found by their paths.
  static constexpr int kAllBelow = 1 << 20;
  /// `why` completes the sentence "it is in use: ..." and must outlive the guard. Descendants down to `namesBelow`
  /// levels below the leaf cannot be renamed either.
  InUse(const Leaf& leaf, std::string_view why, int namesBelow = 0);
  ~InUse();
  InUse(const InUse&) = delete;
  InUse& operator=(const InUse&) = delete;

 private:
  friend class detail::Tree;
  Ref<Leaf> leaf_;
  std::string_view why_;
  int namesBelow_;
  InUse** link_;  ///< the pointer to this guard in the kernel's list
  InUse* next_;
};

}  // namespace spark
