#pragma once
/// \file
/// Whether real time holds.

#include "measure.h"

namespace spark::bench {

/// Plays a world over TCP in real time for so long. One row: percentiles [us] of how late cycles began (`late`), how
/// long they took (`long`), and when they were done after they were due (`done`); `withinStep`: cycles done within a
/// step. `print`: a table with the histogram for people.
Json realtime(const Setup& setup, double seconds, bool print);

}  // namespace spark::bench
