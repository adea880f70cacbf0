#pragma once
/// \file
/// A run that was recorded, or of which there is a snapshot, to be built again.

#include <filesystem>
#include <string>
#include <vector>

#include "mcap.h"
#include "options.h"
#include "recorded_files.h"

namespace sparkhost {

/// The file of such a run. As long as it lives its scripts and scenes are in a folder.
class RecordedRun {
 public:
  /// Throws Error if the file is none of sparkhost.
  explicit RecordedRun(const std::string& file);

  /// The options of the host that builds it. `own`: of this program, which add to them or replace them. From then on
  /// this process writes, and starts, only what `own` names.
  Options options(const Options& own) const;
  /// The command line of the recorded host.
  const std::vector<std::string>& arguments() const { return arguments_; }
  const std::string& file() const { return file_; }
  const spark::mcap::Reader& recording() const { return recording_; }
  const RecordedFiles& files() const { return files_; }

 private:
  std::string file_;
  spark::mcap::Reader recording_;
  std::vector<std::string> arguments_;
  RecordedFiles files_;
};

/// The command line of the host of a recording. Throws Error if it does not say.
std::vector<std::string> recordedArguments(const std::string& file, const spark::mcap::Reader& recording);

}  // namespace sparkhost
