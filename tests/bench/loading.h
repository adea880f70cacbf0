#pragma once
/// \file
/// What it costs a running match when a robot comes or goes: each cycle by itself, against a quiet cycle of as many
/// robots.

#include <string>
#include <vector>

#include "report.h"

namespace spark::bench {

/// One cycle.
struct CycleCost {
  double total = 0;            ///< CPU time [µs]
  std::vector<double> phases;  ///< wall time [µs], in the order of Loading::phases
};

/// What a robot's coming or going cost, cycle by cycle.
struct Change {
  int robots = 0;                 ///< afterwards
  CycleCost quiet;                ///< a cycle with as many robots, all at rest
  std::vector<CycleCost> excess;  ///< above such cycles, from the one in which it connects, or leaves
};

/// A match that filled up and emptied again.
struct Loading {
  std::vector<std::string> phases;
  std::vector<Change> joins;   ///< the 1st robot, the 2nd, ...
  std::vector<Change> leaves;  ///< the last, the one before, ...
  double kBPerRobot = 0;       ///< heap in use for each robot of a kind that was there before
};

/// Lets `robots` humanoids of Spark's own kinds 0 to 4 join one by one, and leave again, on one thread. Every time is
/// the least of `repeats` equal matches: the same cycle does the same work in each. Throws Error.
Loading measureLoading(int robots, int repeats);

/// Measures a match of 22. A table of all changes and where the time of the dearest ones goes; with `json` an array of
/// one row: the excess of the longest cycle, the worst and the median over the joins of kinds that were there before,
/// the worst leave, the very first join [µs].
void runLoading(bool json);

}  // namespace spark::bench
