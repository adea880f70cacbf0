#pragma once
/// \file
/// Keeps what is at work where it is.

#include <string_view>

#include "spark/abi/spark/in_use.h"
#include "spark/leaf.h"

namespace spark {

/// Says that a leaf is in use: code of it is at work, or others live in it. While one of these lives, the leaf and what
/// is above it can neither be removed nor moved nor renamed: that throws Error with `why`. The simulation's thread
/// only.
class InUse {
 public:
  /// What is below keeps its name, too: for servers, which are found by their paths.
  static constexpr int kAllBelow = 1 << 20;
  /// `why` finishes the sentence "it is in use: ..." and outlives this object. `namesBelow`: how many levels below keep
  /// their names.
  InUse(const Leaf& leaf, std::string_view why, int namesBelow = 0);
  ~InUse();
  InUse(const InUse&) = delete;
  InUse& operator=(const InUse&) = delete;

 private:
  friend class detail::Tree;
  Ref<Leaf> leaf_;
  std::string_view why_;
  int namesBelow_;
  InUse** link_;  ///< what points at this one in the kernel's list
  InUse* next_;
};

}  // namespace spark
