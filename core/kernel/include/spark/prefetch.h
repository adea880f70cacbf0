#pragma once
/// \file
/// A hint to the processor.

#include <cstddef>

#include "spark/abi/spark/prefetch.h"

namespace spark {

/// Asks for memory that will be read soon, whatever it holds and whether it is valid or not. For loops over nodes in
/// the step: a solver leaves nothing of them in the caches, and the next ones can be fetched while one is worked on.
inline void prefetch(const void* begin, std::size_t bytes) {
  constexpr std::size_t kLine = 64;
  for (std::size_t at = 0; at < bytes; at += kLine) __builtin_prefetch(static_cast<const char*>(begin) + at);
}

}  // namespace spark
