#pragma once
/// \file
/// A folder for a test.

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

namespace spark::test {

/// A new empty folder, removed with the object.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    // mkdtemp replaces the X.
    std::string name = (std::filesystem::temp_directory_path() / "spark-test-XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }
  /// Path of a file in it.
  std::string file(const std::string& name) const { return (path_ / name).string(); }
  /// Writes a file in the folder, creates its parent folders, and returns its path.
  std::string write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name) << text;
    return file(name);
  }

 private:
  std::filesystem::path path_;
};

}  // namespace spark::test
