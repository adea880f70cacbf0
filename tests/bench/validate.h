#pragma once
/// \file
/// Checks that neither measuring nor threads change the result.

#include "measure.h"

namespace spark::bench {

/// Runs a world for `cycles` cycles while it is measured (its blocks alternate between one and several threads), and
/// three times unmeasured: twice with one thread, once with several (at least two). Returns one row; `same`: all four
/// ended in the same state. `print`: also prints a line.
Json validate(const Setup& setup, int cycles, bool print);

}  // namespace spark::bench
