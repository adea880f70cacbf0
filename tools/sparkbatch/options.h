#pragma once
/// \file
/// The command line of sparkbatch.

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sweep.h"

namespace sparkbatch {

/// A property of the finished world that becomes a column.
struct Report {
  std::string column, path, property;
};

/// What the user asked for.
struct Options {
  std::string config, results;
  /// From --set, the same for every run: key and text, in order.
  std::vector<std::pair<std::string, std::string>> settings;
  std::vector<Parameter> sweep;
  std::vector<Report> reports;
  std::int64_t seeds = 1;  ///< runs of each combination of the sweep
  std::uint64_t seed = 1;  ///< of the first of them
  double duration = 0;     ///< simulated seconds of a run; 0: until the config ends it
  int threads = 0;         ///< worlds at a time in this process; 0: as many as there are processors for it
  std::vector<std::string> pluginPaths, scenePaths;  ///< absolute, existing folders
  std::string logLevel = "error";
  bool resume = false, retry = false;
};

/// Reads the command line. When the program is to end at once (help, version, an error, which it has printed) returns
/// the exit code instead: 0, or 2 for an error. `speaks`: false keeps this process silent, because another one says the
/// same.
std::optional<int> readOptions(int argc, char** argv, bool speaks, Options& out);

}  // namespace sparkbatch
