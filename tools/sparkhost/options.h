#pragma once
/// \file
/// The command line of sparkhost.

#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "spark/value.h"

namespace sparkhost {

inline constexpr int kUsageError = 2;  ///< exit code: the command line is wrong

/// The command line options.
struct Options {
  std::string config;
  /// A flag that sets a property of a node which not every config creates.
  struct Switch {
    std::string flag;  ///< as given: "--rate max"
    const char *path, *property;
    spark::Value value;
    const char* missing;  ///< what a config without that node lacks, and how to add it
  };
  /// --set: keys and values in order; the last value of a key wins.
  std::vector<std::pair<std::string, spark::Value>> overrides;
  /// Applied after the config ran, so they win over --set.
  std::vector<Switch> switches;
  std::optional<std::uint64_t> seed;
  std::vector<std::string> pluginPaths, scenePaths;  ///< absolute, existing folders
  std::string logLevel = "info";
  std::string describe;              ///< --describe: name of a class; "": not given
  std::vector<std::string> convert;  ///< --convert: the file to convert and the file to write; empty: not given
  bool check = false, listPlugins = false, histogram = false;
  std::string hashes;          ///< --hashes: file for the hashes of every `hashEvery`-th cycle; "": none
  std::int64_t hashEvery = 1;  ///< --hash-every
  std::string record;          ///< --record: file of the recording; "": none
  std::string from;            ///< --from: snapshot or recording to go on from; "": none
  std::size_t fromSwitches = 0, fromOverrides = 0;  ///< with --from: number of those that are of the first run
  std::optional<std::uint64_t> branch;              ///< with --from: another seed from there on
  double at = HUGE_VAL;                             ///< --at: not from a later state than at this simulated time [s]
  std::vector<std::string> arguments;  ///< the command line that builds the same, for recordings and snapshots
  std::string share;                   ///< folder with lua/ and scenes/ instead of the program's; "": the program's
  bool replay = false;                 ///< a recording is played: Host::play()
  bool alone = false;  ///< without servers for other programs, such as the control socket; for worlds of a batch
};

/// Parses the command line. If the program is to end at once (help, version, an error), prints that and returns the
/// exit code: 0, or kUsageError.
std::optional<int> readOptions(int argc, char** argv, Options& out);
}  // namespace sparkhost
