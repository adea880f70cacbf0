#pragma once
/// \file
/// Prefetching of memory.

#include <cstddef>

#include "spark/abi/spark/prefetch.h"

namespace spark {

/// Loads `bytes` of memory from `begin` into the processor's caches. The address need not be valid. For loops over
/// nodes in the step whose memory a solver has displaced from the caches: the next nodes are fetched while one is
/// processed.
inline void prefetch(const void* begin, std::size_t bytes) {
  constexpr std::size_t kLine = 64;
  for (std::size_t at = 0; at < bytes; at += kLine) __builtin_prefetch(static_cast<const char*>(begin) + at);
}

}  // namespace spark
