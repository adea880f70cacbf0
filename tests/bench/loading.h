#pragma once
/// \file
/// The cost of a robot that joins or leaves a running match, for each cycle, relative to a quiet cycle with the same
/// number of robots.

#include <string>
#include <vector>

#include "report.h"

namespace spark::bench {

/// The cost of one cycle.
struct CycleCost {
  double total = 0;            ///< CPU time [µs]
  std::vector<double> phases;  ///< wall time [µs], in the order of Loading::phases
};

/// The cost of a robot that joined or left, cycle by cycle.
struct Change {
  int robots = 0;                 ///< afterwards
  CycleCost quiet;                ///< a cycle with the same number of robots, all at rest
  std::vector<CycleCost> excess;  ///< over such a cycle, from the cycle in which the robot connects or leaves
};

/// The costs of a match in which all robots join and leave.
struct Loading {
  std::vector<std::string> phases;
  std::vector<Change> joins;   ///< the 1st robot, the 2nd, ...
  std::vector<Change> leaves;  ///< the last, the one before, ...
  double kBPerRobot = 0;       ///< heap memory of each robot whose type was loaded before
};

/// Lets `robots` humanoids of types 0 to 4 join one by one and leave again, with one thread. Every time is the minimum
/// over `repeats` equal matches, in which the same cycle does the same work. Throws Error.
Loading measureLoading(int robots, int repeats);

/// Measures a match of 22 robots. Prints a table of all changes, and the phases of some of them. With `json`, prints an
/// array of one row with the excess of the longest cycle [µs]: maximum and median over the joins of types that were
/// loaded before, maximum over the leaves, and the very first join.
void runLoading(bool json);

}  // namespace spark::bench
