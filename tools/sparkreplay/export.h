#pragma once
/// \file
/// Parts and contents of recordings as other files.

#include <cmath>
#include <string>
#include <vector>

namespace sparkreplay {

struct Export {
  std::string file;                     ///< the recording
  std::string out;                      ///< what is written: .mcap, .csv, or a monitor log
  std::vector<std::string> properties;  ///< columns of a table: "/path.property" each
  double from = 0, to = HUGE_VAL;       ///< simulated time [s]
  std::string logLevel = "warning";
  std::vector<std::string> pluginPaths, scenePaths;  ///< absolute, existing folders of the user
  bool force = false;                                ///< a file that exists may be replaced
};

/// Writes the file: .mcap: the part of the recording from the newest state up to `from`; .csv: a row for each cycle
/// with the properties; otherwise a monitor log, as the run would have written it. Returns the number of messages, rows
/// or records. Throws Error if that cannot be done.
std::int64_t write(const Export& what);

}  // namespace sparkreplay
