#pragma once
/// \file
/// The files of a recording, in a folder in which a host finds them.

#include <filesystem>
#include <string>
#include <vector>

#include "mcap.h"

namespace sparkhost {

/// A folder that exists as long as this object: a share with lua/ and scenes/, and files/ with the resources that were
/// read. Configs and scripts are in lua/ by the names by which they were asked for, without the folder where a name was
/// absolute.
class RecordedFiles {
 public:
  /// Writes the attachments of the recording, and copies of the files of `installed`, a share, which it has not. Those
  /// that are damaged, or whose names lead out of the folder, are left out. Throws Error if there is no room for them.
  RecordedFiles(const spark::mcap::Reader& recording, const std::filesystem::path& installed);

  const std::filesystem::path& share() const { return folder_.path; }
  std::filesystem::path scripts() const { return share() / "lua"; }
  /// The resources, by their names.
  std::filesystem::path files() const { return share() / "files"; }
  /// What could not be written, a sentence each.
  const std::vector<std::string>& lacks() const { return lacks_; }

 private:
  /// Removed with all in it at the end, also that of a constructor which throws.
  struct Folder {
    std::filesystem::path path;
    ~Folder();
  };
  Folder folder_;
  std::vector<std::string> lacks_;
};

}  // namespace sparkhost
