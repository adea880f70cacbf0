#pragma once
/// \file
/// How long a test waits for what must come. Tests wait for events, never for time: this is for what hangs, and ctest's
/// TIMEOUT, which is longer, for what hangs without a word.

#include <chrono>

namespace spark::test {

/// For one wait, which may be for a whole match. Beside a busy neighbour, a program of low priority gets a hundredth of
/// a processor.
inline constexpr std::chrono::seconds kPatience{1800};

}  // namespace spark::test
