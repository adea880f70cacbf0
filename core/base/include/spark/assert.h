#pragma once
/// \file
/// Checks of preconditions, in Debug and sanitizer builds.

#include "spark/abi/spark/assert.h"

namespace spark::detail {
/// Prints the condition and its place, and aborts.
[[noreturn]] void assertionFailed(const char* condition, const char* file, int line);
}  // namespace spark::detail

/// Ends the program where `condition` is false: the caller has broken a precondition. Release builds do not look at it.
/// For mistakes of code only; what comes from outside is answered with an Error.
#ifdef NDEBUG
#define SPARK_ASSERT(condition) static_cast<void>(0)
#else
#define SPARK_ASSERT(condition) \
  ((condition) ? static_cast<void>(0) : ::spark::detail::assertionFailed(#condition, __FILE__, __LINE__))
#endif
