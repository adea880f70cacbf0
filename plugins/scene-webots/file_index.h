#pragma once
/// \file
/// Finds files by their own names.

#include <map>
#include <string>
#include <vector>

#include "api/files.h"

namespace spark::webots {

/// PROTO and mesh files in and below the folder that has a main file as a resource, by their own names. It is listed
/// when it is first needed; hidden folders and links are left out.
class FileIndex {
 public:
  /// `of`: the resource name of the main file. `files` must outlive this.
  FileIndex(IFileServer& files, std::string of) : files_(files), of_(std::move(of)) {}
  /// Resource names of the files that are called so, those with the most folders in common with `of` first.
  const std::vector<std::string>& called(const std::string& name);

 private:
  void list();

  static constexpr std::size_t kMaxListed = 50'000;
  IFileServer& files_;
  const std::string of_;
  bool isListed_ = false;
  std::map<std::string, std::vector<std::string>> names_;
};

}  // namespace spark::webots
