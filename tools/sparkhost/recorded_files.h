#pragma once
/// \file
/// The files of a recording, as a share in which a host finds them.

#include <filesystem>
#include <string>
#include <vector>

#include "mcap.h"

namespace sparkhost {

/// A folder with lua/ and scenes/ that exists as long as this object. Configs and scripts are in lua/ by the names by
/// which they were asked for, without the folder where a name was absolute.
class RecordedFiles {
 public:
  /// Writes the attachments of the recording, and copies of the files of `installed`, a share, which it has not. Those
  /// that are damaged, or whose names lead out of the folder, are left out. Throws Error if there is no room for them.
  RecordedFiles(const spark::mcap::Reader& recording, const std::filesystem::path& installed);
  ~RecordedFiles();
  RecordedFiles(const RecordedFiles&) = delete;
  RecordedFiles& operator=(const RecordedFiles&) = delete;

  const std::filesystem::path& share() const { return folder_; }
  std::filesystem::path scripts() const { return folder_ / "lua"; }
  /// What could not be written, a sentence each.
  const std::vector<std::string>& lacks() const { return lacks_; }

 private:
  std::filesystem::path folder_;
  std::vector<std::string> lacks_;
};

}  // namespace sparkhost
