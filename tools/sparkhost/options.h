#pragma once
/// \file
/// The command line of sparkhost.

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "spark/value.h"

namespace sparkhost {

inline constexpr int kUsageError = 2;  ///< exit code: the command line is wrong

/// A state of a recorded run, from which another one goes on.
struct ForkState {
  double time = 0;    ///< s, simulated
  std::string bytes;  ///< as ISnapshots::write() makes them
  struct Text {
    std::string kind, name, text;
  };
  std::vector<Text> texts;  ///< that were read up to then: Sources
};

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
  bool force = false;          ///< files that exist may be replaced
  std::string hashes;          ///< --hashes: file for the hashes of every `hashEvery`-th cycle; "": none
  std::int64_t hashEvery = 1;  ///< --hash-every
  std::string record;          ///< --record: file of the recording; "": none
  std::string from;            ///< --from: snapshot or recording to go on from; "": none
  std::size_t fromSwitches = 0, fromOverrides = 0;  ///< with --from: number of those that are of the first run
  std::optional<std::uint64_t> branch;              ///< with --from: another seed from there on
  double at = HUGE_VAL;                             ///< --at: from the end of the last cycle up to this time [s]
  std::shared_ptr<const ForkState> state;           ///< of --at, where it had to be simulated; else it is in `from`
  std::vector<std::string> arguments;  ///< the command line that builds the same, for recordings and snapshots
  std::string share;                   ///< folder with lua/ and scenes/ instead of the program's; "": the program's
  std::string files;  ///< folder of files that come before those of all file systems: of a recording; "": none
  std::vector<std::string> moreScenePaths;  ///< folders that come next, as in scenePaths
  std::vector<std::string> notes;           ///< warnings about what was left out
  bool replay = false;                      ///< a recording is played: Host::play()
  bool alone = false;  ///< without servers for other programs, such as the control socket; for worlds of a batch
};

/// Parses the command line. If the program is to end at once (help, version, an error), prints that and returns the
/// exit code: 0, or kUsageError. `problem`: the words are those of a recording, so that nothing is printed, and folders
/// need not exist; it gets what is wrong.
std::optional<int> readOptions(int argc, char** argv, Options& out, std::string* problem = nullptr);
/// The words without the values of `--set` whose keys are among `secrets`.
std::vector<std::string> withoutSecrets(std::vector<std::string> words, const std::vector<std::string>& secrets);
}  // namespace sparkhost
