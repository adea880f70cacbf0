#pragma once
/// \file
/// The command line of sparkbatch.

#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sweep.h"

namespace sparkhost {
class RecordedRun;
struct ForkState;
}  // namespace sparkhost

namespace sparkbatch {

/// A property that becomes a column: its value at the end of a run.
struct Report {
  std::string column, path, property;
};

/// The command line options.
struct Options {
  std::string config, results;
  std::string from;      ///< snapshot or recording from which all runs branch, instead of a config; "": none
  double at = HUGE_VAL;  ///< from the end of the last cycle up to this simulated time [s]
  const sparkhost::RecordedRun* origin = nullptr;     ///< that of `from`, while the batch runs
  std::shared_ptr<const sparkhost::ForkState> state;  ///< that of `at`; nullptr: it is in `from`
  double begin = 0;                                   ///< simulated time at which runs begin [s]
  /// --set, for all runs: keys and texts in order.
  std::vector<std::pair<std::string, std::string>> settings;
  std::vector<Parameter> sweep;
  std::vector<Report> reports;
  std::int64_t seeds = 1;  ///< runs of each combination of the sweep
  std::uint64_t seed = 1;  ///< of the first of these runs; the others count up
  double duration = 0;     ///< s, simulated, of a run; 0: until the config ends it
  int threads = 0;         ///< number of worlds at a time in this process; 0: number of its processors
  std::vector<std::string> pluginPaths, scenePaths;  ///< absolute, existing folders
  std::string logLevel = "error";
  bool resume = false, retry = false, force = false;
};

/// Parses the command line. If the program is to end at once (help, version, an error), prints that and returns the
/// exit code: 0, or 2 for an error. `print` false: prints nothing, since another process prints the same.
std::optional<int> readOptions(int argc, char** argv, bool print, Options& out);

}  // namespace sparkbatch
