#pragma once
/// \file
/// The command line of sparkhost.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "spark/value.h"

namespace sparkhost {

inline constexpr int kUsageError = 2;  ///< exit code: the command line is wrong

/// What the user asked for.
struct Options {
  std::string config;
  /// A flag that stands for a property of a node that not every house has.
  struct Switch {
    std::string flag;  ///< as it was written
    const char *path, *property;
    spark::Value value;
    const char* missing;  ///< what a house without that node lacks, and how it gets it
  };
  /// From --set: key and value, in order; the last of a key wins.
  std::vector<std::pair<std::string, spark::Value>> overrides;
  /// Set when the house is built; they win over --set.
  std::vector<Switch> switches;
  std::optional<std::uint64_t> seed;
  std::vector<std::string> pluginPaths, scenePaths;  ///< absolute, existing folders
  std::string logLevel = "info";
  std::string describe;  ///< class name, "" for none
  bool check = false, listPlugins = false, histogram = false;
  bool alone = false;  ///< nobody looks in: no control socket
};

/// Reads the command line. When the program is to end at once (help, version, an error, which it has printed) returns
/// the exit code instead: 0, or 2 for an error.
std::optional<int> readOptions(int argc, char** argv, Options& out);

}  // namespace sparkhost
