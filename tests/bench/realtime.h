#pragma once
/// \file
/// Measures whether the host runs in real time.

#include "measure.h"

namespace spark::bench {

/// Runs a world over TCP in real time for `seconds`. Returns one row: percentiles [us] of the delay with which cycles
/// began (`late`), their duration (`long`), and the time from when they were due until they were done (`done`);
/// `withinStep`: number of cycles done within a step. `print`: also prints a table with the histogram.
Json realtime(const Setup& setup, double seconds, bool print);

}  // namespace spark::bench
