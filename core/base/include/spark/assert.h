#pragma once
/// \file
/// Checks of preconditions, active in Debug and sanitizer builds.

#include "spark/abi/spark/assert.h"

namespace spark::detail {
/// Prints the condition and its source location to stderr, then aborts.
[[noreturn]] void assertionFailed(const char* condition, const char* file, int line);
}  // namespace spark::detail

/// Aborts the program if `condition` is false, that is, if the caller has broken a precondition. Release builds
/// (NDEBUG) do not evaluate the condition. Use it for programming errors only: bad input is reported with an Error.
#ifdef NDEBUG
#define SPARK_ASSERT(condition) static_cast<void>(0)
#else
#define SPARK_ASSERT(condition) \
  ((condition) ? static_cast<void>(0) : ::spark::detail::assertionFailed(#condition, __FILE__, __LINE__))
#endif
