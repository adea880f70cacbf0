#pragma once
/// \file
/// How long a test waits for what must come. Tests wait for events, never for time: this is for what hangs, and ctest's
/// TIMEOUT, which is longer, for what hangs without a word.

#include <chrono>

namespace spark::test {

/// For one wait; a machine may be slow and busy.
inline constexpr std::chrono::seconds kPatience{3600};

}  // namespace spark::test
