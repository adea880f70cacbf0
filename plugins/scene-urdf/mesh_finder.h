#pragma once
/// \file
/// Finds the mesh files of a robot.

#include <map>

#include "api/files.h"
#include "urdf_reader.h"

namespace spark::urdf {

/// Reads the mesh files that one robot names. They are looked for in the folders around the robot's own file. As makers
/// keep packages where they like, a file that is not where its name says is looked for by its base name, small and
/// large letters alike: the one with the most folders in common counts, then the nearest. One with none in common
/// counts in the robot's folder and the one around it alone: farther away it may be a part of another robot.
class MeshFinder {
 public:
  /// `of`: the resource name of the robot's file. `files` must outlive this.
  MeshFinder(IFileServer& files, std::string of) : files_(files), of_(std::move(of)) {}
  /// Throws Error.
  FoundMesh read(const std::string& name);

 private:
  FoundMesh read(const std::string& resource, const std::string& insteadOf);
  std::string similar(const std::string& name);
  void list();
  void list(const std::filesystem::path& folder, const std::filesystem::path& without, const std::string& prefix);

  static constexpr std::size_t kMaxListed = 50'000;  ///< names
  IFileServer& files_;
  const std::string of_;
  bool isListed_ = false;
  std::size_t listed_ = 0;
  struct Listed {
    std::string name;  ///< of the resource
    bool near;         ///< in the robot's folder or the one around it
  };
  int level_ = 0;                                          ///< folders above the robot's that list() is in
  std::map<std::string, std::vector<Listed>> byBaseName_;  ///< the nearest first
};

}  // namespace spark::urdf
