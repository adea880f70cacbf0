#pragma once
/// \file
/// Measuring changes nothing, and neither do threads.

#include "measure.h"

namespace spark::bench {

/// Plays a world for `cycles` cycles while it is measured (its blocks alternate between one and several threads), and
/// three times unmeasured: twice with one thread, once with several (at least two). One row; `same`: all four ended in
/// the same state. `print`: a line for people.
Json validate(const Setup& setup, int cycles, bool print);

}  // namespace spark::bench
